"""The text environment in figures: characters of an observation, steps a second and core, memory of many worlds.

    python benchmarks/text_env_speed.py                 all figures, about a minute
    python benchmarks/text_env_speed.py --ticks 2000 --generated 20    more commands in each home, and more homes
    python benchmarks/text_env_speed.py --beside ../main --ticks 1000  this checkout and another by turns: ratios

Commands are drawn from those that are legal, half of them walks. With `--beside` both checkouts give the same commands,
some dozen at a time by turns, so that other load slows both: for the first time in a home, then the same ones again.
Before, a hundred others are given, which load modules and measure floors.
"""

from __future__ import annotations

import argparse
import os
import random
import resource
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median

import hearth
from hearth.envs.session import opening
from hearth.envs.text_homes import TextHome, TextHomes
from hearth.homes import library
from hearth.homes.procedural.home_generator import generate
from hearth.homes.scene_graph import scene
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.simulation.world.home import Home

GOALS = ("ON(milk, table)", "INSIDE(apple, fridge)", "HOLDS(agent, book)", "ON(plate, table): 2", "HOLDS(agent, cup)")
"""Goals of the homes: those whose things a home lacks are left out there."""


def homes(generated: int) -> dict[str, str | Home]:
    """Return our homes, and a number of generated ones, by name."""
    known = default()
    found: dict[str, str | Home] = {name: name for name in library.names()}
    for number in range(generated):
        rooms = 3 + number % 5
        name = f"home_{rooms}_{number}"
        found[name] = Home.from_graph(scene(generate(rooms, number, known), known), name, known)
    return found


def world_of(home: str | Home) -> TextHome:
    """Return a world of a home with the first goal that it can have."""
    for goal in GOALS:
        try:
            world = TextHome(opening(home, goal, agents=1), limit=100)
            world.reset(0)
        except HearthError:
            continue
        return world
    raise SystemExit(f"no goal for {home}")


def command(chooser: random.Random, admissible: list[str]) -> str:
    """Return a command: walks and others equally often."""
    walks = [each for each in admissible if each.startswith("Walk ")]
    rest = [each for each in admissible if not each.startswith(("Walk", "Turn"))]
    return chooser.choice(chooser.choice([walks, rest]) or admissible)


def lengths(home: str | Home, ticks: int) -> tuple[list[int], float]:
    """Return the characters of the observations of a home, and the seconds of a core that its steps take."""
    world, chooser = world_of(home), random.Random(0)
    text, info = world.reset(0)
    found, seconds, seed = [len(text)], 0.0, 0
    while len(found) < ticks:
        chosen = command(chooser, list(info["admissible"]))
        begin = time.process_time()
        text, _, terminated, truncated, info = world.step(chosen)
        seconds += time.process_time() - begin
        found.append(len(text))
        if terminated or truncated:
            seed += 1
            text, info = world.reset(seed)
    return found, seconds


CHUNK = 25
"""Commands between two turns."""


def chunks(home: str, ticks: int, seed: int) -> Iterator[float]:
    """Yield the seconds of a core that each some dozen commands in a home take."""
    world, chooser = world_of(home), random.Random(seed)
    _, info = world.reset(seed)
    seconds = 0.0
    for number in range(1, ticks + 1):
        chosen = command(chooser, list(info["admissible"]))
        begin = time.process_time()
        _, _, terminated, truncated, info = world.step(chosen)
        seconds += time.process_time() - begin
        if terminated or truncated:
            _, info = world.reset(1000 * seed + number)
        if number % CHUNK == 0:
            yield seconds
            seconds = 0.0


def take_turns(ticks: int) -> None:
    """Measure some commands for each line of standard input, and print their seconds."""
    for home in library.names():
        for _ in chunks(home, 100, 9):
            pass
        for _ in range(2):
            for seconds in chunks(home, ticks, 1):
                sys.stdin.readline()
                print(seconds, flush=True)


def compare(other: Path, ticks: int) -> None:
    """Print the steps a second and core of two checkouts, and the ratio."""
    ours = Path(__file__).resolve().parents[1]
    turns = []
    for folder in (other.resolve(), ours):
        environment = {**os.environ, "PYTHONPATH": str(folder / ".types")}
        line = [sys.executable, __file__, "--turns", "--ticks", str(ticks)]
        pipe = subprocess.PIPE
        turns.append(subprocess.Popen(line, env=environment, cwd=folder, stdin=pipe, stdout=pipe, text=True))
    each = ticks // CHUNK
    for home in library.names():
        for name in ("first time", "once more"):
            pairs = [tuple(turn(process) for process in turns) for _ in range(each)]
            before, after = (each * CHUNK / sum(pair[n] for pair in pairs) for n in (0, 1))
            ratio = median(pair[0] / pair[1] for pair in pairs)
            print(
                f"{home:8} {name}: {before:6,.0f} and {after:6,.0f} steps/s, {after / before:.2f} (median {ratio:.2f})"
            )
    for process in turns:
        process.communicate()


def turn(process: subprocess.Popen[str]) -> float:
    """Return the seconds of a process's next commands."""
    assert process.stdin is not None and process.stdout is not None
    process.stdin.write("\n")
    process.stdin.flush()
    return float(process.stdout.readline())


def memory(worlds: int) -> float:
    """Return the megabytes that a number of worlds adds, after three commands each."""
    from hearth.challenges.published_tasks import tasks

    chosen = tasks("wah", "train", limit=64)
    for task in chosen:  # the homes themselves are shared, and not counted
        TextHome(task).reset()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    homes = TextHomes(chosen, worlds=worlds)
    homes.reset()
    for answer in ("Walk kitchen", "wait", "Walk table"):
        homes.step([answer] * worlds)
    return (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024


def main() -> None:
    """Print the figures."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--ticks", type=int, default=300, help="commands in each home")
    options.add_argument("--generated", type=int, default=0, help="generated homes next to ours")
    options.add_argument("--worlds", type=int, default=1024, help="worlds whose memory is measured; 0 for none")
    options.add_argument("--beside", type=Path, metavar="FOLDER", help="another checkout, measured by turns with this")
    options.add_argument("--turns", action="store_true", help=argparse.SUPPRESS)
    given = options.parse_args()
    if given.turns:
        take_turns(given.ticks)
    elif given.beside:
        compare(given.beside, given.ticks)
    else:
        figures(given.generated, given.ticks, given.worlds)


def figures(generated: int, ticks: int, worlds: int) -> None:
    """Print lengths and speed by home, and the memory of many worlds."""
    every: list[int] = []
    total = 0.0
    for name, home in homes(generated).items():
        found, seconds = lengths(home, ticks)
        every, total = every + found, total + seconds
        print(
            f"{name:10} mean {sum(found) / len(found):6.0f}  most {max(found):5,}  {len(found) / seconds:7,.0f} steps/s"
        )
    mean = sum(every) / len(every)
    print(f"{'all':10} mean {mean:6.0f}  most {max(every):5,}  {len(every) / total:7,.0f} steps/s")
    if worlds:
        print(f"{worlds:,} worlds: {memory(worlds):,.0f} MB")
    print(f"hearth {hearth.__version__}, protocol {TextHome('maple', GOALS[0]).fingerprint}")


if __name__ == "__main__":
    main()
