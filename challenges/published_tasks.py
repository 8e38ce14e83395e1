"""The published tasks of a challenge, and others of the same kind (thesis 6.5.1, B.2.2).

Goals are held out once for all: whatever the seed, no goal of test-1 is among those of training and demonstrations.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import combinations
from random import Random

from hearth.challenges.challenge_definition import Challenge, Split, challenge
from hearth.challenges.household import household_tasks
from hearth.challenges.household_as_challenge import as_task
from hearth.challenges.household_definition import NAME as HOUSEHOLD
from hearth.challenges.tasks import Task, drawn
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.rng import rng

PUBLISHED = -1
"""Stands for the seed of the published tasks."""

DEMONSTRATIONS = "demonstrations"
"""The split of the demonstrations that belong to no task."""


def tasks(name: str, split: str, seed: int = PUBLISHED, limit: int | None = None) -> tuple[Task, ...]:
    """Return the tasks of a split; goal sets come in turn, and so do the goals of a set where all are equally probable.

    Args:
        name: of the challenge; tasks of `household` are made, a second or two each.
        split: one of the challenge's, or `demonstrations`.
        seed: draws other tasks of the same kind; the published ones by default.
        limit: the first of them only.

    Raises:
        HearthError: BAD_ARGUMENT: there is no such challenge or split.
    """
    if name == HOUSEHOLD:
        return tuple(map(as_task, household_tasks(split, limit, max(seed, 0))))
    which = challenge(name)
    found = split_of(which, split)
    number = found.tasks if limit is None else min(limit, found.tasks)
    chosen = list(combinations(which.grammar.sets, found.sets))
    orders = [_order(which, found, sets, rng(seed, "goals", name, split, *sets)) for sets in chosen]
    label = split if seed == PUBLISHED else f"{split}-{seed}"
    made = []
    for i in range(number):
        turn, sets = divmod(i, len(chosen))
        chooser = rng(seed, "task", name, split, i)
        order = orders[sets]
        goal = order[turn % len(order)] if order else which.grammar.sample_of(chosen[sets], chooser)
        made.append(drawn(which, split, f"{name}-{label}-{i + 1:04d}", goal, chosen[sets], chooser))
    return tuple(made)


def split_of(which: Challenge, split: str) -> Split:
    """Return a split by name.

    Raises:
        HearthError: BAD_ARGUMENT: there is none of that name.
    """
    if split == DEMONSTRATIONS and which.demonstrations:
        return Split(which.demonstrations, 1, which.train, which.splits["train"].goals)
    if split not in which.splits:
        remedy = ", ".join((*which.splits, DEMONSTRATIONS))
        raise HearthError.of(Code.BAD_ARGUMENT, f"there is no split `{split[:40]}`", suggestion=remedy)
    return which.splits[split]


def _order(which: Challenge, split: Split, sets: Sequence[str], chooser: Random) -> list[Goal]:
    """Return the goals of a set in the order of their turns; none where goals are drawn by their probability."""
    if split.goals == "all":
        return []
    held_out = _held_out(which.name, sets[0])
    goals = which.grammar.sets[sets[0]].goals
    found = [goal for goal in goals if (goal in held_out) == (split.goals == "held_out")]
    chooser.shuffle(found)
    return found


@lru_cache(maxsize=16)
def _held_out(name: str, goal_set: str) -> frozenset[Goal]:
    which = challenge(name)
    goals = list(which.grammar.sets[goal_set].goals)
    return frozenset(rng(0, "held out", name, goal_set).sample(goals, which.held_out))


def held_out(name: str) -> frozenset[Goal]:
    """Return the goals of single sets that are for testing only."""
    return frozenset(goal for goal_set in challenge(name).grammar.sets for goal in _held_out(name, goal_set))
