"""The batched engine beside the plain one: random episodes in ten homes, and everything that differs.

    python benchmarks/array_exactness.py                               1,000 episodes of 250 ticks, half an hour
    python benchmarks/array_exactness.py --episodes 60 --ticks 100     a minute

Homes are our seven and three generated ones. Five kinds of episodes come in turn: `wah` with one agent and with two,
`owah` with two, and an open goal in a generated home with one agent and with two. After each tick
states, edges, agents, poses, goal counts, rewards, ends, sight and legal numbers are compared. Exits with 1 where
anything differs.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from collections.abc import Iterator

import benchmark_cases  # noqa: F401 - puts `oracles` into the path
import numpy as np
from oracles.array_engine import Pair, chosen, paired, step

from hearth.challenges.array_homes import begins_of
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.tasks import task
from hearth.envs.rewards import Rewards
from hearth.envs.session import opening
from hearth.homes.procedural.home_generator import generate
from hearth.homes.scene_graph import scene
from hearth.kb.loading.load import default
from hearth.simulation.arrays.batch import Batch, Payment
from hearth.simulation.arrays.record_types import BUCKETS
from hearth.simulation.arrays.task_records import Begin
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.home import Home

REWARDS = Rewards(1.0, -0.004, 0.5)
GENERATED = ((3, 1), (4, 3), (6, 5))
"""Rooms and seeds of generated homes."""

OPEN_GOAL = (
    "CLOSED(fridge) and ON(agent, chair): 2 and HOLDS(agent, cup) and not ON(light) and ON(cup, kitchen_counter)"
)

AT_ONCE = 25
"""Episodes that are played together."""


def begins(kind: str, agents: int, first: int, count: int) -> tuple[list[Begin], Rules, bool]:
    """Return starts of tasks of a kind, the rules, and whether sight is partial."""
    known = default()
    if kind == "generated":
        found = []
        for number in range(first, first + count):
            rooms, seed = GENERATED[number % len(GENERATED)]
            home = _generated(rooms, seed)
            found.append(Begin(f"{home.name}-{number}", *opening([home], OPEN_GOAL, agents)(number)))
        return found, DEFAULT, True
    which = challenge(kind)
    splits = ("train", "test-1" if kind == "wah" else "test")
    some = [task(kind, splits[number % 7 > 4], number) for number in range(first, first + count)]
    return list(begins_of(some, which, known, agents)), which.rules, which.partial


def _generated(rooms: int, seed: int, made: dict[tuple[int, int], Home] = {}) -> Home:  # noqa: B006 - a memory
    if (rooms, seed) not in made:
        known = default()
        name = f"home_{rooms}_{seed}"
        made[rooms, seed] = Home.from_graph(scene(generate(rooms, seed, known), known), name, known)
    return made[rooms, seed]


def batches(episodes: int) -> Iterator[tuple[str, Batch]]:
    """Yield batches of all kinds until they have that number of episodes."""
    played = sorted(default().group("played"))
    kinds = (("wah", 1), ("owah", 2), ("generated", 1), ("wah", 2), ("generated", 2))
    for number, first in enumerate(range(0, episodes, AT_ONCE)):
        kind, agents = kinds[number % len(kinds)]
        count = min(AT_ONCE, episodes - first)
        found, rules, partial = begins(kind, agents, first, count)
        batch = Batch(found, count, played, rules, partial, payment=Payment(1.0, -0.004, 0.5), bucket=BUCKETS[-1])
        batch.begin_tasks(np.arange(count))
        yield f"{kind}, {agents} agents", batch


def compared(batch: Batch, ticks: int, seed: int) -> tuple[list[Pair], Counter[str]]:
    """Return the worlds of a batch after random actions, and how often each was tried."""
    pairs, rng, counts = paired(batch, REWARDS), np.random.default_rng(seed), Counter()
    for _ in range(ticks):
        step(pairs, chosen(batch, rng, 0.07), counts)
    return pairs, counts


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--episodes", type=int, default=1000)
    parser.add_argument("--ticks", type=int, default=250)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    begun, apart, tried, total = time.perf_counter(), 0, Counter(), 0
    homes: Counter[str] = Counter()
    for number, (kind, batch) in enumerate(batches(given.episodes)):
        pairs, counts = compared(batch, given.ticks, given.seed * 10_007 + number)
        tried += counts
        total += len(pairs)
        homes.update(batch.home_of(pair.number).name for pair in pairs)
        for pair in pairs:
            if pair.apart:
                apart += 1
                print(f"{batch.begins[batch.worlds['task'][pair.number]].name} ({kind}): {', '.join(pair.apart)}")
        print(f"{total:5,} episodes, {time.perf_counter() - begun:6.0f} s, {apart} differ ({kind})", flush=True)
    print(f"{total:,} episodes of {given.ticks} ticks in {len(homes)} homes; {apart} differ")
    print("instructions:", dict(sorted(tried.items())))
    return 1 if apart else 0


if __name__ == "__main__":
    sys.exit(main())
