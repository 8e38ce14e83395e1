"""What every model is: settings that train on examples, and a trained model that answers requests."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol

from hearth.models.interface import Request, Steps, Training
from hearth.schemas.program import Step
from hearth.storage.parallel import Seen, unseen

if TYPE_CHECKING:
    from hearth.models.checkpoint import Checkpoint
    from hearth.models.data import Corpus


class Model(Protocol):
    """The settings of a model: a frozen dataclass."""

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> Trained:
        """The model trained on the corpus's training part; its validation part decides when to stop."""

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> Trained:
        """The trained model of a checkpoint."""


class Trained(Protocol):
    """A trained model."""

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps]:
        """A program for each request, in order; objects have numbers, and nodes if the model chooses them.

        Args:
            requests: any number; the answers do not depend on their order, or on one another.
            beam: how many programs are followed at once; 1 is greedy.
        """

    def checkpoint(self) -> Checkpoint:
        """All that `restored` needs."""


class StepScorer(Protocol):
    """A trained model as decoding sees it: it scores candidates for the next step, whoever chooses among them.

    A state is a value of the model's own that stands for the request and the steps so far.
    """

    def start(self, request: Request) -> Any:
        """The state before the first step."""

    def scores(self, state: Any, candidates: Sequence[Step | None]) -> list[float]:
        """The logarithm of the probability of each candidate as the next step; None stands for the program's end."""

    def advance(self, state: Any, step: Step) -> Any:
        """The state after a step."""


class Scoring(Protocol):
    """A trained model that decoding can step through."""

    def scorer(self) -> StepScorer:
        """The model as a scorer of steps."""
