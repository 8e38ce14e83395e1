"""Goals proposed by the goal proposal network, as the thesis draws them: each predicate by itself (7.3.3, C.3.2)."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING

from hearth.agents.goal_space import Counts, GoalSpace, Places
from hearth.agents.predicate_count_changes import StateChanges
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

if TYPE_CHECKING:
    import numpy as np


class NetworkProposals:
    """The network's proposals in an episode; they need not be goals that there are."""

    def __init__(self, space: GoalSpace, model: str, watched: int, start: Places) -> None:
        """Begin an episode.

        Args:
            space: the goals, all that there are.
            model: a checkpoint's folder, or the name of one that comes with Hearth.
            watched: index of the agent that pursues a goal.
            start: where things are at the start, as far as is known.

        Raises:
            HearthError: MISSING_FILE: there is no network, or the extra `models` is not installed; BAD_ARGUMENT: it
                was trained for other goals.
        """
        from hearth.models.proposals.goal_proposals import restored

        self._network = restored(model)
        self._changes = StateChanges(space, watched, start)
        settings = self._network.settings
        if (settings.inputs, settings.outputs) != (self._changes.size, len(space.predicates)):
            raise HearthError.of(Code.BAD_ARGUMENT, "the goal proposal network was trained for other goals")
        self._known: dict[Counts, np.ndarray] = {}

    def probabilities(self, places: Places) -> np.ndarray:
        """Return (P, c): how probably each predicate is wanted 0, 1, ... times."""
        state = self._changes.since(places)
        if state not in self._known:
            self._known = {state: self._network.probabilities(state)}
        return self._known[state]

    def drawn(self, places: Places, number: int, chooser: Random) -> list[Counts]:
        """Goals, each predicate's count drawn by itself."""
        counts = range(self._network.settings.counts)
        columns = [chooser.choices(counts, row, k=number) for row in self.probabilities(places).tolist()]
        return list(zip(*columns, strict=True))

    def likeliest(self, places: Places) -> Counts:
        """Return the most probable goal."""
        found: Counts = tuple(self.probabilities(places).argmax(axis=1).tolist())
        return found
