"""Activities of the corpus as goals: what a person's program brings about in a home in which it is not yet so."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from functools import lru_cache
from importlib.resources import files
from random import Random
from typing import NamedTuple

from hearth.challenges.household_definition import home_named, share_of
from hearth.challenges.household_starts import settled
from hearth.grounding.environments.sampling import sample
from hearth.kb.action_grammar import check
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Failure
from hearth.schemas.goals import Goal
from hearth.schemas.literals import AGENT, HOLDS
from hearth.schemas.program import Program
from hearth.schemas.syntax import parse_program
from hearth.scoring.metrics.goals import goal_of
from hearth.simulation.goals import Progress
from hearth.simulation.world.world import World

MOST_LITERALS = 6
"""Literals of the goal of an activity, at most."""


class Activity(NamedTuple):
    """A program of the corpus.

    Attributes:
        id: of the program.
        title: the activity.
        description: a person's words.
        program: as text.
    """

    id: str
    title: str
    description: str
    program: str


@lru_cache(maxsize=1)
def activities() -> Mapping[str, Activity]:
    """Return the written programs of the corpus, by id."""
    return {row["HITId"]: _activity(row) for row in _rows("programs.csv")}


def _activity(row: Mapping[str, str]) -> Activity:
    title, description = (" ".join(row[column].split()) for column in ("Input.title", "Input.description"))
    return Activity(row["HITId"], title, description, row["Answer.program"])


@lru_cache(maxsize=4)
def _titles(share: str) -> Mapping[str, tuple[str, ...]]:
    """Return the titles of a share, each with the ids of its programs; programs of other shares, too, are left out."""
    found: dict[str, list[str]] = {}
    for each in activities().values():
        if _shares()[_steps(each)] == {share}:
            found.setdefault(each.title, []).append(each.id)
    return {title: tuple(ids) for title, ids in sorted(found.items())}


@lru_cache(maxsize=1)
def _shares() -> Mapping[str, set[str]]:
    """Return the shares of the titles of each program, by its text."""
    found: dict[str, set[str]] = {}
    for each in activities().values():
        found.setdefault(_steps(each), set()).add(share_of(each.title.lower()))
    return found


def _steps(activity: Activity) -> str:
    """Return the text of a program, so that equal programs have equal texts."""
    return " ".join(activity.program.lower().split())


def _rows(file: str) -> list[dict[str, str]]:
    text = (files("hearth.data_raw") / "written" / file).read_text(encoding="utf-8")
    return list(csv.DictReader(text.splitlines(keepends=True)))


def drawn_activity(share: str, chooser: Random) -> Activity:
    """Return a program of an activity of a share; all activities are equally probable."""
    titles = _titles(share)
    return activities()[chooser.choice(titles[chooser.choice(list(titles))])]


def program_of(activity: Activity, knowledge: Knowledge) -> Program | None:
    """Return the program; None if it does not follow the grammar."""
    program, faults = parse_program(activity.program)
    checked, wrong = check(program, knowledge)
    return None if faults or wrong else checked


def start_of_activity(activity: Activity, home: str, seed: int, knowledge: Knowledge) -> tuple[World, Goal] | None:
    """Return a world in which a program runs, and the goal that it reaches; None where it does not run.

    What also held at the start, of another thing of the same class, is not counted. A program that only leaves things
    in hands ends before its activity does, and gives no goal.
    """
    program = program_of(activity, knowledge)
    if program is None:
        return None
    found = sample(program, home_named(home, knowledge), seed, activity.id)
    if isinstance(found, Failure):
        return None
    environment, execution = found
    goal = goal_of(environment.world, execution.final)
    counts = Progress.at(goal, environment.world).counts
    new = (pair for pair, count in zip(goal, counts, strict=True) if not count and pair[0].terms != (AGENT,))
    wanted = Goal(tuple(new))
    lasting = any(literal.name != HOLDS for literal, _ in wanted)
    if not lasting or len(wanted.counts) > MOST_LITERALS:
        return None
    return settled(environment.world, seed), wanted
