"""Trajectories of ALFRED: how many are read, become programs that run, and reach their goal.

Each trajectory of an archive is read as `build` reads it. An environment is sampled for its program by action set 3.
Its goal must not hold at the start, and must hold at the end.

With `--classes` the table of classes is printed instead: each object type that the trajectories name, the class of
ours, and its source: a name of the knowledge, or `alfred_classes.csv`. Types without a class are refused by name.

Example:
  python benchmarks/alfred_tasks.py alfred-sample.zip --only valid_unseen --home maple
  python benchmarks/alfred_tasks.py alfred-sample.zip --classes
"""

from __future__ import annotations

import argparse
import json
import zipfile
from collections import Counter
from pathlib import Path
from typing import Any

import hearth
from hearth.interop.alfred_goals import alfred_goal
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default
from hearth.pipelines.readers.alfred_steps import UnreadableStepError, class_of, steps_of
from hearth.schemas.failures import Failure
from hearth.simulation.goal_trace import Trace
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.world.home import Home


def main() -> None:
    """Print the counts, and each trajectory that misses its goal; or the table of classes."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("archive", type=Path)
    options.add_argument("--only", default="", help="files whose path has this text")
    options.add_argument("--home", default="maple")
    options.add_argument("--seed", type=int, default=0)
    options.add_argument("--classes", action="store_true", help="print the table of classes")
    given = options.parse_args()
    known = default().of_set(3)
    if given.classes:
        print(table_of_classes(given.archive, given.only, known))
        return
    home = hearth.home(given.home, known)
    counts: Counter[str] = Counter()
    with zipfile.ZipFile(given.archive) as archive:
        for name in sorted(archive.namelist()):
            if name.endswith("traj_data.json") and given.only in name:
                found, why = outcome(json.loads(archive.read(name)), home, known, given.seed)
                counts["trajectories"] += 1
                counts[found] += 1
                if found != "goal reached":
                    print(f"{found}: {name}: {why}")
    print(json.dumps(counts))


def table_of_classes(path: Path, only: str, known: Knowledge) -> str:
    """Return a table of the object types of an archive, each with its class, its source and its trajectories."""
    counts: Counter[str] = Counter()
    with zipfile.ZipFile(path) as archive:
        for name in archive.namelist():
            if name.endswith("traj_data.json") and only in name:
                counts.update(types_of(json.loads(archive.read(name))))
    rows = []
    for kind, count in sorted(counts.items()):
        found = class_of(kind, known)
        by_name = known.object_class(kind)
        source = "a name of the knowledge" if found and by_name and by_name.name == found else "`alfred_classes.csv`"
        rows.append(f"| {kind} | {found or 'none'} | {source if found else 'refused by name'} | {count} |")
    return "\n".join(["| type of ALFRED | class | source | trajectories |", "|---|---|---|---|", *rows])


def types_of(trajectory: Any) -> set[str]:
    """Return the object types that a trajectory's plan and task name."""
    planned = (each.get("planner_action", {}) for each in trajectory["plan"]["high_pddl"])
    keys = ("objectId", "coordinateObjectId", "coordinateReceptacleObjectId")
    found = {str(value[0] if isinstance(value, list) else value).partition("|")[0]
             for each in planned for key in keys if (value := each.get(key))}  # fmt: skip
    wanted = ("object_target", "parent_target", "toggle_target", "mrecep_target")
    return {kind for kind in found | {str(trajectory["pddl_params"].get(key) or "") for key in wanted} if kind}


def outcome(trajectory: Any, home: Home, known: Knowledge, seed: int) -> tuple[str, str]:
    """Return what became of a trajectory, and why."""
    try:
        text = "\n".join(steps_of(trajectory["plan"], known))
        goal_text = alfred_goal(trajectory, known)
    except UnreadableStepError as error:
        return "refused", str(error)
    program = hearth.parse_program(text)
    sampled = hearth.sample(program, home, seed, rules=CONSEQUENCES)
    if isinstance(sampled, Failure):
        return "does not run", str(sampled)
    environment, execution = sampled
    goal = hearth.read_goal(goal_text, environment.world.home)
    trace = Trace.of(execution)
    if trace.reached(goal, 0, 0):
        return "goal held at the start", goal_text
    return ("goal reached", "") if trace.reached(goal) else ("goal missed", f"{goal_text}: {text}")


if __name__ == "__main__":
    main()
