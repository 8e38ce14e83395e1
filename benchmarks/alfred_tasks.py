"""Trajectories of ALFRED: how many are read, become programs that run, and reach their goal.

Each trajectory of an archive is read as `build` reads it. An environment is sampled for its program by action set 3.
Its goal must not hold at the start, and must hold at the end.

Example:
  python benchmarks/alfred_tasks.py alfred-sample.zip --only valid_unseen --home maple
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
from hearth.pipelines.readers.alfred_steps import UnreadableStepError, steps_of
from hearth.schemas.failures import Failure
from hearth.simulation.goal_trace import Trace
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.world.home import Home


def main() -> None:
    """Print the counts, and each trajectory that misses its goal."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("archive", type=Path)
    options.add_argument("--only", default="", help="files whose path has this text")
    options.add_argument("--home", default="maple")
    options.add_argument("--seed", type=int, default=0)
    given = options.parse_args()
    known = default().of_set(3)
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
