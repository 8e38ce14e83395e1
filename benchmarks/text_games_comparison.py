"""Text steps a second beside TextWorldExpress: `python benchmarks/text_games_comparison.py --python OTHER/bin/python`.

OTHER is an environment of its own with the package `textworld-express` (pip), which needs Java 17. Both give random
valid commands, some dozen at a time by turns, so that other load slows both: our homes through `TextHome`, and its
games through its own Python. Wall seconds of steps are counted, as its games run in a Java process. ALFWorld is not
compared: its games are files that its own command downloads.
"""

from __future__ import annotations

import argparse
import random
import subprocess
import sys
import time
from collections.abc import Iterator

CHUNK = 25
"""Commands between two turns."""

GAMES = ("cookingworld", "twc", "coin", "mapreader")
HOMES = ("maple", "willow", "birch", "home of 5 rooms")


def ours(name: str, ticks: int) -> Iterator[float]:
    """Yield the seconds that each some dozen commands in a home take."""
    from text_env_speed import command, homes, world_of

    found = list(homes(3).values())[-1] if name == HOMES[-1] else name
    world, chooser = world_of(found), random.Random(0)
    _, info = world.reset(0)
    seconds = 0.0
    for number in range(1, ticks + 1):
        chosen = command(chooser, list(info["admissible"]))
        begin = time.perf_counter()
        _, _, terminated, truncated, info = world.step(chosen)
        seconds += time.perf_counter() - begin
        if terminated or truncated:
            _, info = world.reset(number)
        if number % CHUNK == 0:
            yield seconds
            seconds = 0.0


def theirs(name: str, ticks: int) -> Iterator[float]:
    """Yield the same of a game of TextWorldExpress."""
    from textworld_express import TextWorldExpressEnv

    env = TextWorldExpressEnv(envStepLimit=100)
    env.load(gameName=name, gameParams="")
    chooser = random.Random(0)
    _, info = env.reset(seed=0, gameFold="train")
    seconds = 0.0
    for number in range(1, ticks + 1):
        chosen = chooser.choice(sorted(info["validActions"]))
        begin = time.perf_counter()
        _, _, over, info = env.step(chosen)
        seconds += time.perf_counter() - begin
        if over:
            _, info = env.reset(seed=number, gameFold="train")
        if number % CHUNK == 0:
            yield seconds
            seconds = 0.0


def take_turns(which: str, name: str, ticks: int) -> None:
    """Measure some commands for each line of standard input, and print their seconds; the first hundred don't count."""
    play = ours if which == "ours" else theirs
    for number, seconds in enumerate(play(name, ticks + 4 * CHUNK)):
        if number >= 4:
            sys.stdin.readline()
            print(seconds, flush=True)


def main() -> None:
    """Print the steps a second of homes and games, pair by pair."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--python", help="of the environment with textworld-express")
    parser.add_argument("--ticks", type=int, default=1000, help="commands in each home and game")
    parser.add_argument("--turns", nargs=2, metavar=("WHICH", "NAME"), help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.turns:
        take_turns(*asked.turns, asked.ticks)
        return
    from text_env_speed import turn  # the other environment, which takes turns, has no Hearth

    for home, game in zip(HOMES, GAMES, strict=True):
        turns = []
        for python, which, name in ((sys.executable, "ours", home), (asked.python, "theirs", game)):
            line = [python, __file__, "--ticks", str(asked.ticks), "--turns", which, name]
            turns.append(subprocess.Popen(line, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True))
        sums = [0.0, 0.0]
        for _ in range(asked.ticks // CHUNK):
            for number, process in enumerate(turns):
                sums[number] += turn(process)
        for process in turns:
            process.communicate()
        here, there = (asked.ticks / seconds for seconds in sums)
        print(f"{home:16} {here:6,.0f} steps/s   {game:13} {there:6,.0f} steps/s   {here / there:.2f}")


if __name__ == "__main__":
    main()
