"""Recorded answers in place of a language model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from hearth.llm.replies import Reply
from hearth.llm.turns import Turn
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


class RecordedAnswers:
    """The answers of an episode, given again in their order.

    Args:
        turns: the answers.
    """

    def __init__(self, turns: Sequence[Turn]) -> None:
        self._turns, self.given = turns, 0

    def __call__(self, messages: Sequence[Mapping[str, Any]], seed: int = 0, **more: Any) -> Reply:
        """Return the next answer.

        Raises:
            HearthError: NO_ANSWER: there is none left.
        """
        if self.given >= len(self._turns):
            raise HearthError.of(Code.NO_ANSWER, f"only {len(self._turns)} answers are recorded")
        self.given += 1
        return Reply(self._turns[self.given - 1].answer)

    @property
    def left(self) -> int:
        """Return how many answers were not asked for."""
        return len(self._turns) - self.given
