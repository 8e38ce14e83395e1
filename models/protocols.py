"""The protocols of every model: settings that train on examples, and a trained model that answers requests."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from hearth.models.interface import Request, Steps, Training
from hearth.storage.parallel import Seen, unseen

if TYPE_CHECKING:
    from hearth.models.checkpoint import Checkpoint
    from hearth.models.decoding.scorers import Scorer
    from hearth.models.text_examples import Corpus


class Model(Protocol):
    """The settings of a model: a frozen dataclass."""

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> Trained:
        """Return the model trained on the corpus's training part; its validation part decides when to stop."""

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> Trained:
        """Return the trained model of a checkpoint."""


class Trained(Protocol):
    """A trained model."""

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps]:
        """Return a program for each request, in order; objects have numbers, and nodes if the model chooses them.

        Args:
            requests: any number; the answers do not depend on their order, or on one another.
            beam: how many programs are followed at once; 1 is greedy.
        """

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs."""


@runtime_checkable
class Decoded(Protocol):
    """A trained model that decoding with the engine in the loop can step through."""

    def scorer(self) -> Scorer:
        """Return the model as a scorer of the parts of steps; its inputs are requests.

        Raises:
            HearthError: BAD_ARGUMENT, if its settings do not allow it.
        """
