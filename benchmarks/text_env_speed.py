"""The text environment in figures: characters of an observation, steps a second and core, memory of many worlds.

    python benchmarks/text_env_speed.py                 all figures, about a minute
    python benchmarks/text_env_speed.py --ticks 2000 --generated 20    more commands in each home, and more homes

Commands are drawn from those that are legal, half of them walks, half about what the goal names.
"""

from __future__ import annotations

import argparse
import random
import resource
import time

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
    given = options.parse_args()
    every: list[int] = []
    total = 0.0
    for name, home in homes(given.generated).items():
        found, seconds = lengths(home, given.ticks)
        every, total = every + found, total + seconds
        print(
            f"{name:10} mean {sum(found) / len(found):6.0f}  most {max(found):5,}  {len(found) / seconds:7,.0f} steps/s"
        )
    mean = sum(every) / len(every)
    print(f"{'all':10} mean {mean:6.0f}  most {max(every):5,}  {len(every) / total:7,.0f} steps/s")
    if given.worlds:
        print(f"{given.worlds:,} worlds: {memory(given.worlds):,.0f} MB")
    print(f"hearth {hearth.__version__}, protocol {TextHome('maple', GOALS[0]).fingerprint}")


if __name__ == "__main__":
    main()
