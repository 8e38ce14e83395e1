"""A state as goal proposals see it: by how much the count of each predicate has grown since the start (C.3.2)."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from hearth.agents.goal_space import GoalSpace, Numbers, Places
from hearth.schemas.literals import HOLDS

ELSEWHERE = 3
"""Predicates of a class in addition to those of goals: held by the watched agent; on, or in, a node that no goal names.
"""


class StateChanges:
    """The predicates by which states are counted: those of goals in the order of the space, then `ELSEWHERE` of each
    class. In every home they are the same.

    The thesis has 136, ours have 31 + 3 * 11 = 64 of O-WAH: furniture that no goal names counts as one.

    Attributes:
        space: the goals, all that there are.
        watched: index of the agent that pursues one.
        first: the places of things at the start.
    """

    def __init__(self, space: GoalSpace, watched: int, first: Places) -> None:
        self.space, self.watched = space, watched
        self._start = self._counts(first)

    @cached_property
    def _class_of(self) -> list[int]:
        """Return (T) the number of each thing's class, by the first predicate for which it counts."""
        groups = list(dict.fromkeys(self.space.classes))
        return [groups.index(self.space.classes[rows[0]]) for rows in self.space.rows_of]

    @property
    def size(self) -> int:
        """Return how many predicates there are."""
        return len(self.space.targets) + ELSEWHERE * len(set(self.space.classes))

    def _counts(self, places: Places) -> Numbers:
        counted = self.space.counted(places)
        found = np.zeros(self.size, np.int64)
        found[: len(counted)] = counted.sum(axis=1)
        for number, (relation, node) in enumerate(places):
            kind = len(counted) + ELSEWHERE * self._class_of[number]
            if relation == HOLDS:
                found[kind] += node == self.watched
            elif not counted[:, number].any():
                found[kind + (1 if relation == "ON" else 2)] += 1
        return found

    def since(self, places: Places) -> tuple[int, ...]:
        """Return the increases; decreases are 0."""
        return tuple(np.maximum(0, self._counts(places) - self._start).tolist())
