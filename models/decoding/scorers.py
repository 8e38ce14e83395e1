"""A model's scores for the next step, part by part: one interface for all models and all search methods."""

from collections.abc import Sequence
from enum import StrEnum
from typing import Any, NamedTuple, Protocol

import numpy as np

from hearth.models.decoding.next_step_options import Options, Partial
from hearth.schemas.program import Step
from hearth.simulation.world.world import World


class Part(StrEnum):
    """A part of a step that is chosen at once."""

    ACTION = "action"
    FIRST = "first"
    SECOND = "second"
    STEP = "step"


class Asked(NamedTuple):
    """A program that is being written, of which the next part is asked.

    Attributes:
        state: the scorer's own, of the steps so far.
        chosen: the parts of the next step chosen before.
        world: after the steps so far; as at the start where decoding is free.
        options: the allowed next steps; None where decoding is free.
        steps: so far.
    """

    state: Any
    chosen: Partial
    world: World
    options: Options | None
    steps: tuple[Step, ...]


class Scores(NamedTuple):
    """Scores of the choices of one part, greater for better ones; logarithms of probabilities if samples are drawn.

    Attributes:
        values: of an action, in the order of `Scorer.actions`; of a node, in the order of the home's indices. Where the
            first part of a step is a node, one more for a step without objects. Where it is the first part, a last one
            for the end of the program. -inf for choices that are never made.
        steps: of whole steps, those proposed, in the order of `values`; each bound to nodes.
    """

    values: np.ndarray
    steps: Sequence[Step] = ()


class Scorer(Protocol):
    """A model as the search sees it. It never sees the reference.

    Attributes:
        order: of the parts of a step. ACTION, FIRST, SECOND; or FIRST, ACTION, SECOND as in eq. 5.7; or STEP alone.
        actions: names of actions, in the order of their scores.
    """

    @property
    def order(self) -> tuple[Part, ...]:
        """See above."""

    @property
    def actions(self) -> Sequence[str]:
        """See above."""

    def begin(self, worlds: Sequence[World], inputs: Sequence[Any]) -> Sequence[Any]:
        """Return the state of each program before its first step, from the world at its start and the model's own
        input.
        """

    def score(self, asked: Sequence[Asked], part: Part) -> Sequence[Scores]:
        """Return the scores of the next part of each program."""

    def advance(self, asked: Sequence[Asked], steps: Sequence[Step]) -> Sequence[Any]:
        """Return the state of each program after a step; `asked` has the world after it."""
