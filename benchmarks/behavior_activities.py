"""The oldest activities of BEHAVIOR: how many are read as environment and goal, and how many our planner solves.

The folder is `bddl` of the package `bddl`. Activities are taken in the order of `activity_manifest.txt`, the oldest
first, as far as the package defines them. An activity is solved if the whole goal holds after the planner's episode
and did not hold before.

Example:
  python benchmarks/behavior_activities.py site-packages/bddl --most 100
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from pathlib import Path

import hearth
from hearth.agents.human_like import Habits, HumanLike
from hearth.challenges.episode_loop import Player, play
from hearth.challenges.household_definition import RULES
from hearth.challenges.household_starts import settled
from hearth.interop.bddl.environment import Activity, environment_of
from hearth.interop.bddl.goal_reading import goal_of, way_of
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
    names = (given.folder / "activity_manifest.txt").read_text().split()
    paths = [given.folder / "activity_definitions" / name / "problem0.bddl" for name in names]
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
    """Return whether the environment and the goal, written as BDDL and read, are the same again."""
    text = problem_text(activity.graph, goal, known, activity.problem.name)
    again = environment_of(read_problem(text), known)
    home = Home.from_graph(again.graph, "", known)
    return Progress.start(goal, World.start(home)).goal == goal and len(again.nodes) >= len(activity.nodes) - 1


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
        way = way_of(activity, known)
        actions = known.group("played") | CLEANING
        played = play(world, way, [Player(HumanLike(Habits(sees_all=True)), way)], 0, actions=actions, partial=False,
                      limit=ticks, rules=RULES)  # fmt: skip
    except HearthError as error:
        return f"refused: {error.diagnostics[0].code}"
    return "solved" if Progress.start(goal, played.env.world).satisfied else "not solved"


if __name__ == "__main__":
    main()
