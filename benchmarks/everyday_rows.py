"""python benchmarks/everyday_rows.py FILE [--show HOME]: check the rows of a file of everyday instructions.

FILE has JSON lines as `benchmarks/everyday_instructions.py` reads, each with a `sketch`: lines of a program, such as
`[SwitchOn] <television> (1)`, that does what is asked; the planner walks, opens and takes what the lines leave out. A
row passes if its goal can be read in each of its homes, does not hold there at the start, and is reached by the sketch.
"""

import argparse
import json
from pathlib import Path

import hearth
from hearth.analysis.everyday_instructions import rows_of, start_without
from hearth.challenges.household_definition import home_named
from hearth.kb.action_sets import LATEST
from hearth.kb.loading.load import default
from hearth.repair.runnable_predictions import complete
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.program import Program, Step
from hearth.schemas.syntax import print_step
from hearth.simulation.engine import run
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.rules import CONSEQUENCES


def main() -> None:
    """Print the faults of each row."""
    options = argparse.ArgumentParser(description=__doc__.split(":")[0])
    options.add_argument("file", type=Path)
    options.add_argument("--show", default="", help="a home whose programs are printed")
    given = options.parse_args()
    lines = [json.loads(line) for line in given.file.read_text(encoding="utf-8").splitlines()]
    rows = rows_of(given.file)
    good = 0
    for row, line in zip(rows, lines, strict=True):
        faults = _faults(row, line, given.show) if row.goal else []
        faults += [] if len(set(row.wordings)) == len(row.wordings) else ["a wording comes twice"]
        good += not faults
        for fault in faults:
            print(f"{row.id} {row.instruction[:60]!r}: {fault}")
    ids = [row.id for row in rows]
    print(f"{good} of {len(rows)} rows pass" + ("" if len(set(ids)) == len(ids) else "; an id comes twice"))


def _faults(row, line, show: str) -> list[str]:
    faults = [] if len(row.homes) >= 3 else ["fewer than three homes"]
    for name in row.homes:
        try:
            faults += [f"{name}: {each}" for each in _in_home(row, line, name, name == show)]
        except HearthError as error:
            faults.append(f"{name}: {error}")
    return faults


def _in_home(row, line, name: str, shown: bool) -> list[str]:
    known = default().of_set(LATEST)
    goal = read_goal(row.goal, home_named(name, known))
    world = start_without(goal, name, row.id)
    if Progress.of(goal, run(world, Program(steps=()), CONSEQUENCES)).satisfied:
        return ["the goal holds at the start"]
    if not line.get("sketch"):
        return ["it has no sketch"]
    sketch = hearth.parse_program("\n".join(line["sketch"]), known)
    done = complete(tuple(Step(each.action, each.objects) for each in sketch.steps), world, known, CONSEQUENCES)
    if shown:
        print(row.id, " ".join(map(print_step, done.execution.program.steps)))
    left_out = [f"{print_step(step)} can't be done: {failure.message()}" for step, failure in done.left_out]
    reached = Progress.of(goal, run(world, done.execution.program, CONSEQUENCES)).satisfied
    return left_out + ([] if reached else ["the sketch does not reach the goal"])


if __name__ == "__main__":
    main()
