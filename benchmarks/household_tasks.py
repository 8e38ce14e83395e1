"""Every task of `household`, made and checked, by one process: `python benchmarks/household_tasks.py --out FILE`.

    python benchmarks/household_tasks.py --out /tmp/household.jsonl              all 12,500, about an hour
    python benchmarks/household_tasks.py --out /tmp/household.jsonl --limit 100  the first 100 of each split
    python benchmarks/household_tasks.py --out /tmp/household.jsonl --seed 1 --minutes 15   as many as 15 minutes allow
    python benchmarks/household_tasks.py --out /tmp/household.jsonl --leaks      only make them and compare splits
    python benchmarks/household_tasks.py --out /tmp/household.jsonl --summary    what is in the file

A line of the file is a task that was checked; what is in it is not done again, so that a run may be stopped. Checked
are: nothing of the goal holds at the start; the expert's instructions, given to the engine one by one, reach the goal
in the ticks that are said; the instruction read back gives the goal; and whether the human-like agent, which sees only
the room it is in, reaches the goal in time. The summary also looks for instructions, goals and programs of other splits
in train.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections import Counter, defaultdict
from collections.abc import Iterable
from hashlib import blake2b
from pathlib import Path
from typing import Any

from hearth.challenges.episodes import read_instruction as read_step
from hearth.challenges.household import HouseholdTask, household_ids, household_task, solve
from hearth.challenges.household_definition import RULES, settings
from hearth.challenges.instruction_reader import read_instruction
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.rng import rng
from hearth.simulation.env import Env
from hearth.simulation.goals import Progress
from hearth.simulation.world.world import World

CHECKS = ("nothing holds at the start", "the expert reaches the goal", "the instruction is read back", "human-like")
"""Names of the checks, in the order of a line's `checks`."""

MARKS = ("words", "goal", "program", "numbers")
"""Parts of tasks that are compared between splits; see `marks`."""


def checked(task_id: str, known: Knowledge, leaks: bool = False) -> dict[str, Any]:
    """Return a line of the file; without checks where only leaks are looked for."""
    rejected = Counter[str]()
    try:
        task = household_task(task_id, rejected, known)
    except HearthError as error:
        return {"id": task_id, "split": task_id.split("-")[1], "error": str(error)}
    start = task.start(known)
    about = {"split": task.split, "family": task.family, "ticks": task.min_ticks, "draws": sum(rejected.values())}
    line = {"id": task_id, **about, "words": task.instruction, "goal": str(task.goal), "marks": marks(task, start)}
    if leaks:
        return line
    begun = Progress.start(task.goal, start)
    empty = not any(begun.counts) and not begun.satisfied
    tests = (empty, solved(task, known), same(task, known), solve(start, task.goal, task.seed, known).success)
    return {**line, "checks": tests}


def marks(task: HouseholdTask, start: World) -> dict[str, str]:
    """Return digests of what no test may have in common with train.

    `numbers` is a program without classes; a thing that was added to a home has a number that others have elsewhere.
    """
    goal = sorted(map(str, [*task.goal, *task.goal.parts]))
    steps = [
        read_step(text, 0, start.home, start.home.knowledge.group(settings()["actions"]))
        for text in task.expert
        if text
    ]
    program = [f"{step.action} {' '.join(f'{each.name} {each.node}' for each in step.objects)}" for step in steps]
    parts = {"words": task.instruction, "goal": goal, "program": (task.home, *program),
             "numbers": (task.home, *task.expert)}  # fmt: skip
    return {name: blake2b(repr(part).encode(), digest_size=8).hexdigest() for name, part in parts.items()}


def solved(task: HouseholdTask, known: Knowledge) -> bool:
    """Return whether the expert's instructions reach the goal in the ticks that the task says, and not before."""
    allowed = known.group(settings()["actions"])
    env = Env(RULES, True)
    env.restore(task.start(known))
    progress = Progress.start(task.goal, env.world)
    for text in task.expert:
        if progress.satisfied:
            return False
        done = env.step({0: read_step(text, 0, env.world.home, allowed)} if text else {})
        progress = progress.then(done.before, done.world, [*done.instructions.values()])
    return progress.satisfied and len(task.expert) == task.min_ticks


def same(task: HouseholdTask, known: Knowledge) -> bool:
    """Return whether the instruction, read back, gives the goal."""
    try:
        return read_instruction(task.instruction, known) == task.goal
    except HearthError:
        return False


def summary(lines: Iterable[dict[str, Any]]) -> None:
    """Print how many tasks of each split passed each check, the tasks that failed, and what leaks into train."""
    by_split: dict[str, list[dict[str, Any]]] = defaultdict(list)
    for line in lines:
        by_split[line["split"]].append(line)
    train: dict[str, set[str]] = {name: {each["marks"][name] for each in by_split.get("train", ()) if "marks" in each}
                                  for name in MARKS}  # fmt: skip
    print(f"{'split':13} {'made':>6} {'checked':>7}  " + "  ".join(CHECKS))
    for split, found in by_split.items():
        made = [line for line in found if "marks" in line]
        tested = [line["checks"] for line in made if "checks" in line]
        counts = [sum(checks[n] for checks in tested) for n in range(len(CHECKS))]
        print(f"{split:13} {len(made):6,} {len(tested):7,}  " + "  ".join(
            f"{count:{len(name)},}" for count, name in zip(counts, CHECKS, strict=True)))  # fmt: skip
        leaks = {name: sum(line["marks"][name] in marks for line in made) for name, marks in train.items()}
        if split != "train" and train["words"]:
            print(f"  also in train: {', '.join(f'{count} {name}' for name, count in leaks.items())}")
        for line in found:
            missed = [name for name, held in zip(CHECKS, line.get("checks", ()), strict=False) if not held]
            if "error" in line or missed:
                print(f"  {line['id']} {line.get('family', '')}: {line.get('error') or 'not: ' + ', '.join(missed)}")


def main() -> None:
    """Check what is not in the file, then print its summary."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True, metavar="FILE")
    parser.add_argument("--limit", type=int, help="tasks of each split; all where it is left out")
    parser.add_argument("--split", choices=sorted(settings()["splits"]), help="tasks of this one alone")
    parser.add_argument("--seed", type=int, help="take tasks in an order drawn from it, over all splits and families")
    parser.add_argument("--minutes", type=float, help="stop after them; the file goes on in the next run")
    parser.add_argument("--leaks", action="store_true", help="make the tasks and compare splits, check nothing else")
    parser.add_argument("--summary", action="store_true", help="check nothing, print what is in the file")
    asked = parser.parse_args()
    before = [json.loads(line) for line in asked.out.read_text().splitlines()] if asked.out.exists() else []
    done, known, began = {line["id"] for line in before}, default(), time.perf_counter()
    every = [asked.split] if asked.split else settings()["splits"]
    splits = sorted(every, key="train".__eq__)  # the largest last
    left = [] if asked.summary else [
        each for split in splits for each in household_ids(split, asked.limit) if each not in done
    ]  # fmt: skip
    if asked.seed is not None:
        left = rng(asked.seed, "household tasks").sample(left, len(left))
    until = float("inf") if asked.minutes is None else began + 60 * asked.minutes
    with asked.out.open("a") as file:
        for task_id in left:
            if time.perf_counter() > until:
                break
            before.append(line := checked(task_id, known, asked.leaks))
            file.write(json.dumps(line) + os.linesep)
            file.flush()
    summary(before)
    if left:
        print(f"{len(before) - len(done):,} tasks checked in {time.perf_counter() - began:,.0f} s")


if __name__ == "__main__":
    main()
