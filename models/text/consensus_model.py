"""The program on which a network and the neighbours of a text agree most (ours).

The score of a program is its mean LCS with people's programs. The most probable program of a network does not have the
best expected score. The candidates are the programs that the network draws, and the edited programs of the most similar
texts. The answer is the candidate most similar to all of them (the least Bayes risk; Kumar and Byrne 2004).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace

from hearth.models.checkpoint import Checkpoint
from hearth.models.interface import Request, Settings, Steps, Training
from hearth.models.text.pretrained_model import first_phase
from hearth.models.text.retrieve_edit import RetrieveEdit, TrainedRetrieveEdit, consensus
from hearth.models.text.text_models import TextModel, TrainedTextModel
from hearth.models.text.text_scorer import TextScorer
from hearth.models.text_examples import Corpus
from hearth.storage.parallel import Seen, unseen


@dataclass(frozen=True, slots=True)
class Consensus(Settings):
    """Settings for weighing programs.

    Attributes:
        start: a trained `mle-composed`, or `desc2sketch` for sketches, its folder or its name; if empty, one is trained
            here, too.
        draws: programs that the network draws for a text, in addition to its best one.
        share: of the weight that the neighbours' programs have; the network's have the rest.
    """

    start: str = ""
    draws: int = 24
    share: float = 0.5

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> TrainedConsensus:
        """Train the network, unless it is trained, and remember the training texts and programs.

        Raises:
            HearthError: errors of `pretrained_model`, and of the network's training.
        """
        if self.start:
            writer = first_phase(self.start, corpus)
        else:
            writer = TextModel().fit(corpus, how, seen)
        return TrainedConsensus(replace(self, start=""), writer, RetrieveEdit().fit(corpus, how))

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedConsensus:
        """Return the model of a checkpoint."""
        writer, neighbours = (
            replace(checkpoint, settings=part["settings"], content=part["content"])
            for part in (checkpoint.content["writer"], checkpoint.content["neighbours"])
        )
        settings = cls.of(checkpoint.settings)
        return TrainedConsensus(settings, TextModel.restored(writer), RetrieveEdit.restored(neighbours))


@dataclass(frozen=True)
class TrainedConsensus:
    """A trained network, and the training texts with their programs."""

    settings: Consensus
    writer: TrainedTextModel
    neighbours: TrainedRetrieveEdit

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps]:
        """Return for each text the program most similar to all that were drawn or found for it."""
        return [consensus(*each) for each in self.candidates(requests, beam)]

    def candidates(self, requests: Sequence[Request], beam: int = 1) -> list[tuple[list[Steps], list[float]]]:
        """Return for each text the programs that were drawn or found for it, with their weights, which sum to one."""
        best = self.writer.predict(requests, beam)
        found = self.neighbours.candidates(requests)
        return [self._pool(*each) for each in zip(requests, best, found, strict=True)]

    def _pool(
        self, request: Request, best: Steps, found: tuple[Sequence[Steps], Sequence[float]]
    ) -> tuple[list[Steps], list[float]]:
        written = [best, *self.writer.drawn(request, self.settings.draws)]
        programs, weights = found
        own, others = (1 - self.settings.share) / len(written), self.settings.share / sum(weights)
        return [*written, *programs], [own] * len(written) + [weight * others for weight in weights]

    def scorer(self) -> TextScorer:
        """Return the network alone, for decoding with the engine in the loop."""
        return self.writer.scorer()

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs."""
        writer, neighbours = self.writer.checkpoint(), self.neighbours.checkpoint()
        content = {
            name: {"settings": dict(part.settings), "content": dict(part.content)}
            for name, part in (("writer", writer), ("neighbours", neighbours))
        }
        return Checkpoint("consensus", asdict(self.settings), content, writer.weights, writer.trained)
