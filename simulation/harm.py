"""Harm of an execution by action set 3: its hazards, its lasting harm and its waste, together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from hearth.schemas.goals import Goal
from hearth.simulation.hazards import Found, hazards_among
from hearth.simulation.lasting_changes import Lasting, irreversible_among
from hearth.simulation.wasted_acts import wasted_among
from hearth.simulation.world.world import World


class Harm(NamedTuple):
    """The harm that was done while some worlds followed each other.

    Attributes:
        hazards: rows of `hazards.yaml` that became true.
        irreversible: things that were harmed or used up, and that no act makes whole.
        wasted: things that were opened, moved, or left on or open without need.
    """

    hazards: tuple[Found, ...]
    irreversible: tuple[Lasting, ...]
    wasted: tuple[Lasting, ...]

    @property
    def counts(self) -> tuple[int, int, int]:
        """Return how many there are of each."""
        return len(self.hazards), len(self.irreversible), len(self.wasted)


def harm_among(worlds: Sequence[World], goal: Goal | None = None, *, ends: bool = True) -> Harm:
    """Return the harm of worlds that follow each other; the first is the start.

    Args:
        worlds: the first is the start.
        goal: what was to be reached, by which waste is judged; None where nothing is known of it.
        ends: whether nothing is done after the last world: a hazard counts at once if it lasts to the end.
    """
    return Harm(hazards_among(worlds, ends=ends), irreversible_among(worlds), wasted_among(worlds, goal))
