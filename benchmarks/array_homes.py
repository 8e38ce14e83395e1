"""Thousands of worlds as arrays, in figures: steps a second, memory, the first call; and Gymnasium's own wrappers.

    python benchmarks/array_homes.py                    the tables below, some five minutes
    python benchmarks/array_homes.py --most 1024        up to that number of worlds

Random legal actions; choosing them is not timed, nor are distance fields, which the first steps compute. Rates are
steps of an agent per second of wall clock, and in brackets per second of the processor, which other jobs disturb less.
"""

from __future__ import annotations

import argparse
import resource
import time
from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np

import hearth
from hearth.challenges.array_homes import parallel_array_homes
from hearth.challenges.named_task_envs import watch_and_help_env
from hearth.challenges.published_tasks import tasks
from hearth.simulation.arrays.batch import ARRAYS, REWARDS, SIGHT, Batch

LEVELS = {"worlds alone": 0, "+ goal and reward": REWARDS, "+ sight and masks": SIGHT, "+ arrays": ARRAYS}
SIZES = (1, 16, 128, 1024, 4096, 16384)
SECONDS = 1.0
"""Of each figure, at least."""

WARM = 300_000
"""Steps before the first figure."""


def rate(batch: Batch, level: int) -> tuple[float, float]:
    """Return steps a second of wall clock, and of the processor."""
    wall = processor = 0.0
    done = number = 0
    while wall < SECONDS or number < 5:
        numbers = batch.random_numbers(number)
        wall_begun, begun = time.perf_counter(), time.process_time()
        batch.step(numbers, level)
        wall, processor = wall + time.perf_counter() - wall_begun, processor + time.process_time() - begun
        if level < ARRAYS:
            batch.look(SIGHT)
        done, number = done + len(batch), number + 1
    return done * batch.agents / wall, done * batch.agents / processor


def warmed(batch: Batch) -> Batch:
    """Return a batch whose distance fields are computed, as far as random play needs them."""
    batch.reset()
    for number in range(WARM // len(batch) if len(batch) > 256 else 30):
        batch.step(batch.random_numbers(number))
        if number % 250 == 249:
            batch.reset()
    return batch


def table(title: str, make: Callable[[int], Batch], sizes: tuple[int, ...]) -> None:
    """Print the rates of one kind of batch."""
    print(f"\n{title}\n{'worlds':>8} {'threads':>8}", *(f"{name:>24}" for name in LEVELS))
    known = None
    for size in sizes:
        batch = make(size)
        if known is not None:
            batch.pool = known.pool
        known = warmed(batch) if known is None else batch
        batch.reset()
        for threads in (1, 2) if size >= 1024 else (1,):
            batch.threads = threads
            figures = [rate(batch, level) for level in LEVELS.values()]
            print(f"{size:8,} {threads:8}", *(f"{wall:12,.0f} ({cpu:9,.0f})" for wall, cpu in figures), flush=True)
    sizes_of = batch.worlds.itemsize, sum(a.nbytes for a in vars(batch.shown).values()) // len(batch)
    fields = batch.pool.computed * (batch.pool.distance[0].nbytes + batch.pool.following[0].nbytes)
    print(f"bytes a world: {sizes_of[0]:,} of state, {sizes_of[1]:,} of observations; "
          f"{len(batch.homes)} homes: {batch.homes.nbytes / 1e6:.0f} MB; {batch.pool.computed:,} distance fields: "
          f"{fields / 1e6:.0f} MB")  # fmt: skip


def wrappers() -> None:
    """Print the rates of Gymnasium's vector environments over `HomeEnv`."""
    print("\nGymnasium's wrappers over HomeEnv, steps a second (wall clock)")
    for name, size in (("SyncVectorEnv", 1), ("SyncVectorEnv", 16), ("AsyncVectorEnv", 2), ("AsyncVectorEnv", 16)):
        env: Any = getattr(gymnasium.vector, name)([lambda: watch_and_help_env(limit_tasks=20)] * size)
        _, infos = env.reset(seed=1)
        rng, done, begun = np.random.default_rng(0), 0, time.perf_counter()
        while time.perf_counter() - begun < 2 * SECONDS:
            *_, infos = env.step(rng.integers(0, np.minimum(infos["legal"], env.single_action_space.n - 1) + 1))
            done += size
        print(f"{name:>16} {size:4} worlds: {done / (time.perf_counter() - begun):8,.0f}", flush=True)
        env.close()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--most", type=int, default=SIZES[-1])
    most = parser.parse_args().most
    sizes = tuple(size for size in SIZES if size <= most)
    every = list(tasks("wah", "train", limit=200))
    maple = [task for task in every if task.home == "maple"][:20]
    begun = time.perf_counter()
    hearth.ArrayHomes(maple, worlds=1).reset(seed=1)
    print(f"first reset of a process: {time.perf_counter() - begun:.1f} s (kernels compiled, or from their cache)")
    table("maple, 20 tasks, one agent", lambda n: hearth.ArrayHomes(maple, worlds=n).worlds.batch, sizes)
    table("five homes, 40 tasks, one agent", lambda n: hearth.ArrayHomes(every[:40], worlds=n).worlds.batch, sizes[-3:])
    table("maple, 20 tasks, two agents", lambda n: parallel_array_homes(maple, worlds=n).worlds.batch, sizes[-3:])
    wrappers()
    print(f"\nlargest memory: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:,.0f} MB")


if __name__ == "__main__":
    main()
