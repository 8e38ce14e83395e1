"""The oldest activities of BEHAVIOR: how many are read as environment and goal, and how many our planner solves.

The folder is `bddl` of the package `bddl`; that of version 1.0.1 has the 100 of BEHAVIOR-100. Activities are taken in
the order of `activity_manifest.txt`, the oldest first, as far as the package defines them, then by their names. An
activity is solved if the whole goal holds after the planner's episode and did not hold before.

Example:
  python benchmarks/behavior_activities.py site-packages/bddl --most 100
"""

from __future__ import annotations

import argparse
import json
import re
from collections import Counter
from pathlib import Path

import hearth
from hearth.agents.human_like import Habits, HumanLike
from hearth.challenges.episode_loop import Player, play
from hearth.challenges.household_definition import RULES
from hearth.challenges.household_starts import settled
from hearth.interop.bddl.environment import Activity, environment_of
from hearth.interop.bddl.goal_reading import CHOICES, goal_of, way_of
from hearth.interop.bddl.goal_writing import problem_text
from hearth.interop.bddl.problem import read_problem
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.goals import Goal
from hearth.schemas.vocabulary import FURTHER_STATES
from hearth.simulation.goals import Progress
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

CLEANING = frozenset({"Wash", "Wipe", "Scrub", "Rinse", "Sweep", "Vacuum"})
"""Actions that the planner may take besides those of the challenges."""


def main() -> None:
    """Print a line for each activity that is not solved, and the counts."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("folder", type=Path)
    options.add_argument("--most", type=int, default=100)
    options.add_argument("--ticks", type=int, default=500)
    given = options.parse_args()
    known = default().of_set(3)
    counts: Counter[str] = Counter()
    manifest = given.folder / "activity_manifest.txt"
    names = manifest.read_text().split() if manifest.exists() else []
    definitions = next(given.folder.glob("activity_*s/"))
    others = sorted({path.name for path in definitions.iterdir() if path.is_dir()} - set(names))
    paths = [definitions / name / "problem0.bddl" for name in (*names, *others)]
    for path in [path for path in paths if path.exists()][: given.most]:
        counts["activities"] += 1
        try:
            activity = environment_of(read_problem(path.read_text(), path.parent.name), known)
            goal = goal_of(activity, known)
        except HearthError as error:
            print(f"{path.parent.name}: not read: {error.diagnostics[0]}")
            continue
        counts["read"] += 1
        counts["read with every object"] += not activity.left_out
        counts["written and read back equal"] += written_back(activity, goal, known)
        found = outcome(activity, goal, known, given.ticks)
        counts[found] += 1
        if found != "solved":
            print(f"{path.parent.name}: {found}: {goal}")
    print(json.dumps(counts))


def written_back(activity: Activity, goal: Goal, known: Knowledge) -> bool:
    """Return whether the goal, written as BDDL with its home and read again, is the same about the same classes."""
    text = problem_text(activity.graph, goal, known, activity.problem.name)
    again = environment_of(read_problem(text), known)
    return by_classes(goal, activity) == by_classes(goal_of(again, known), again)


def by_classes(goal: Goal, activity: Activity) -> str:
    """Return a goal as text, with the class of each node instead of its number."""
    classes = {str(node.id): node.class_name for node in activity.graph.nodes}
    return re.sub(r"(?<=[(, ])[0-9]+(?=[,)])", lambda match: classes[match[0]], str(goal))


def outcome(activity: Activity, goal: Goal, known: Knowledge, ticks: int) -> str:
    """Return what becomes of an activity if the human-like agent, which sees everything, takes one way to its goal."""
    if any(name in FURTHER_STATES for name in (literal.name for literal, _ in goal.literals())):
        return "states that the planner does not know"
    home = Home.from_graph(activity.graph, activity.problem.name, default())
    world = settled(World.start(home), 0)
    try:
        hearth.read_goal(str(goal), home)
        if Progress.start(goal, world).satisfied:
            return "holds at the start"
        for choice in range(CHOICES):
            way = way_of(activity, known, choice)
            actions = known.group("played") | CLEANING
            played = play(world, way, [Player(HumanLike(Habits(sees_all=True)), way)], 0, actions=actions,
                          partial=False, limit=ticks, rules=RULES)  # fmt: skip
            if Progress.start(goal, played.env.world).satisfied:
                return "solved"
    except HearthError as error:
        return f"refused: {error.diagnostics[0].code}"
    return "not solved"


if __name__ == "__main__":
    main()
