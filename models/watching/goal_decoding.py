"""The most probable goal, of those that there are, given probabilities of the counts of predicates."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import combinations

import numpy as np

from hearth.models.watching.demonstration_batches import Counts
from hearth.schemas.goals import Goal

BEST = 40
"""Goals of each set that are tried together with those of another."""


@dataclass(frozen=True)
class PossibleGoals:
    """The goals that there are: these, and any two of different sets at once.

    Attributes:
        goals: of one goal set each.
    """

    goals: tuple[Counts, ...]

    @cached_property
    def set_of(self) -> tuple[int, ...]:
        """Return for each predicate the number of its goal set; predicates of one goal are of one set."""
        found = list(range(len(self.goals[0])))
        for goal in self.goals:
            joined = {found[i] for i, count in enumerate(goal) if count}
            found = [min(joined) if each in joined else each for each in found]
        return tuple(found)

    @cached_property
    def _arrays(self) -> tuple[np.ndarray, np.ndarray]:
        sets = [next(self.set_of[i] for i, count in enumerate(goal) if count) for goal in self.goals]
        return np.array(self.goals), np.array(sets)

    def best(self, logs: np.ndarray) -> Counts:
        """Return the most probable goal.

        Args:
            logs: (P, K), the logarithm of the probability of each count of each of P predicates.
        """
        goals, sets = self._arrays
        scores = _scores(goals, logs)
        tops = [
            goals[chosen[np.argsort(-scores[chosen], kind="stable")[:BEST]]]
            for chosen in (np.flatnonzero(sets == each) for each in np.unique(sets))
        ]
        pairs = [(one[:, None] + other[None]).reshape(-1, len(logs)) for one, other in combinations(tops, 2)]
        every = np.concatenate([goals, *pairs])
        found: Counts = tuple(every[int(_scores(every, logs).argmax())].tolist())
        return found


def _scores(goals: np.ndarray, logs: np.ndarray) -> np.ndarray:
    found: np.ndarray = logs[np.arange(goals.shape[1]), np.minimum(goals, logs.shape[1] - 1)].sum(1)
    return found


def counts_of(goal: Goal, predicates: Sequence[str]) -> Counts:
    """Return how often a goal wants each predicate."""
    wanted = {str(literal): number for literal, number in goal}
    return tuple(wanted.get(each, 0) for each in predicates)


@lru_cache(maxsize=4)
def possible_goals(goals: tuple[Goal, ...], predicates: tuple[str, ...]) -> PossibleGoals:
    """Return the goals that there are, as counts of predicates."""
    return PossibleGoals(tuple(counts_of(goal, predicates) for goal in goals))
