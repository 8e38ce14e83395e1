"""The cost of action set 3: a step beside the same step of set 2, with nothing running and with ten appliances on.

    python benchmarks/consequences_speed.py

Both sets do the same drawn programs in our homes, in turns, in one process; a figure is a ratio of their least times.
The first line is of programs in which no process goes on at any tick; the asked bound is 1.05. The second is of the
same homes with ten appliances on and closed; the asked bound is 2. The third is of sampling environments for programs
of our corpus and running them there; the asked bound is 1.1.
"""

from __future__ import annotations

import argparse
import random
import time
from collections.abc import Iterable

import benchmark_cases

import hearth
from hearth.commands.inputs import read_programs
from hearth.grounding.grounded_run import Trial, attempt
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.actions.legal import legal
from hearth.simulation.engine import act, final, run
from hearth.simulation.rules import CONSEQUENCES, DEFAULT, Rules
from hearth.simulation.world.action_set_3_states import WIDTH
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.storage.rejects import Reject

STEPS, PROGRAMS, ROUNDS = 30, 12, 15

IDLE = ("Walk", "Find", "TurnTo", "LookAt", "PointAt", "Grab", "PutBack", "Sit", "StandUp", "Open", "Close", "Touch")
"""Acts that start nothing by themselves."""

Case = tuple[World, Program]


def drawn(world: World, seed: int) -> Program:
    """Return a program of legal steps; the action is drawn first, so that not all of them are walks."""
    chooser, steps, now = random.Random(seed), [], world
    while len(steps) < STEPS:
        possible = legal(now)
        action = chooser.choice([name for name in IDLE if possible.count(name)])
        ids = [chooser.choice(possible.objects(action, k)) for k in range(len(possible.masks[action]))]
        refs = tuple(ObjectRef(now.home.node(now.home.index[i]).class_name, 1, i) for i in ids)
        after = act(now, Step(action, refs))
        if isinstance(after, World):  # each argument is possible for some other, not for every one
            steps.append(Step(action, refs))
            now = after
    return Program(steps=tuple(steps))


def starts(appliances: int) -> Iterable[World]:
    """Yield our homes with some appliances switched on, the rest off."""
    for name in library.names():
        world = World.start(Home.from_graph(library.load_graph(name, default()), name, default()))
        switched = [n for n in world.graph().nodes if "HAS_SWITCH" in n.properties]
        heating = sorted(switched, key=lambda n: (n.class_name not in PROCESSED, n.id))
        states = [(n.id, "ON" if k < appliances else "OFF") for k, n in enumerate(heating)]
        shut = [(n.id, "CLOSED") for n in heating[:appliances] if "CAN_OPEN" in n.properties]
        made = hearth.edit(world, set=[*states, *shut], check=False)
        assert isinstance(made, World)
        yield made


PROCESSED = sorted({"stove", "oven", "microwave", "fridge", "freezer", "dishwasher", "washing_machine", "kettle"})


def ratio(cases: list[Case]) -> tuple[float, float, float]:
    """Return microseconds a step of set 2 and of set 3, and their ratio."""
    least = [float("inf")] * 2
    for _ in range(ROUNDS):
        for k, rules in enumerate((DEFAULT, CONSEQUENCES)):
            begin = time.process_time()
            for world, program in cases:
                final(world, program, rules)
            least[k] = min(least[k], time.process_time() - begin)
    steps = sum(len(program.steps) for _, program in cases)
    two, three = (1e6 * seconds / steps for seconds in least)
    return two, three, three / two


def cases(appliances: int) -> list[Case]:
    """Return homes with programs; with nothing switched on only those in which nothing goes on at any tick."""
    every = [(world, drawn(world, seed)) for world in starts(appliances) for seed in range(PROGRAMS)]
    return every if appliances else [case for case in every if _is_still(*case)]


def _is_still(world: World, program: Program) -> bool:
    worlds = run(world, program, CONSEQUENCES).worlds
    return len(worlds) == len(program.steps) + 1 and not any(each.states[WIDTH].due for each in worlds)


def sampling(programs: int = 60) -> tuple[float, float, int]:
    """Return milliseconds of sampling a home for a program and running it, by both sets, and the programs."""
    home = Home.from_graph(library.load_graph("maple", default()), "maple", default())
    read = read_programs(benchmark_cases.CROWD, default(), "crowd")
    given = [each.program.unbound() for each in read if not isinstance(each, Reject) and not each.faults][:programs]
    ready = [each for each in given if all(_runs(each, home, rules) for rules in (DEFAULT, CONSEQUENCES))]
    least = [float("inf")] * 2
    for _ in range(5):
        for k, rules in enumerate((DEFAULT, CONSEQUENCES)):
            begin = time.process_time()
            for program in ready:
                attempt(program, home, 1, rules)
            least[k] = min(least[k], time.process_time() - begin)
    two, three = (1e3 * seconds / len(ready) for seconds in least)
    return two, three, len(ready)


def _runs(program: Program, home: Home, rules: Rules) -> bool:
    found = attempt(program, home, 0, rules)
    return isinstance(found, Trial) and found.execution.executable


def main() -> None:
    """Print the three ratios."""
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    for name, appliances, asked in (("nothing runs", 0, 1.05), ("ten appliances on", 10, 2.0)):
        drawn_cases = cases(appliances)
        two, three, times = ratio(drawn_cases)
        text = f"{len(drawn_cases)} programs, {two:.2f} and {three:.2f} us a step: {times:.2f} times set 2"
        print(f"{name:<18} {text} (asked {asked})")
    two, three, programs = sampling()
    text = f"{programs} programs, {two:.2f} and {three:.2f} ms: {three / two:.2f} times set 2"
    print(f"{'sampling':<18} {text} (asked 1.1)")


if __name__ == "__main__":
    main()
