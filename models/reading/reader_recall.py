"""The reader with a memory: of similar texts' programs and the reader's own, the one most like the others (ours).

The reader says what a text asks for, and similar texts' programs say how people do such things. The reader's program
counts as much as the share of the text that it understands.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING

from hearth.kb.action_sets import LATEST
from hearth.kb.loading.load import default
from hearth.models.interface import Request, Settings, Steps, Training
from hearth.models.reading.instruction_reading import read_text
from hearth.models.reading.narration import narrated
from hearth.models.reading.program_writing import repeats
from hearth.models.text.retrieve_edit import RetrieveEdit, TrainedRetrieveEdit, consensus
from hearth.storage.parallel import Seen, unseen

if TYPE_CHECKING:
    from hearth.models.checkpoint import Checkpoint
    from hearth.models.text_examples import Corpus


@dataclass(frozen=True, slots=True)
class ReaderRecall(Settings):
    """The reader with a memory.

    Attributes:
        neighbours, sharpness: as of `retrieve-edit`.
        trust: how much the reader's program counts, next to all that is found together.
    """

    neighbours: int = 20
    sharpness: float = 2.0
    trust: float = 0.25

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> TrainedReaderRecall:
        """Remember the training texts and programs."""
        return TrainedReaderRecall(self, self._memory().fit(corpus, how, seen))

    def _memory(self) -> RetrieveEdit:
        return RetrieveEdit(self.neighbours, self.sharpness)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedReaderRecall:
        """Return the model of a checkpoint."""
        settings = cls.of(checkpoint.settings)
        memory = replace(checkpoint, settings=asdict(settings._memory()))
        return TrainedReaderRecall(settings, RetrieveEdit.restored(memory))


@dataclass(frozen=True)
class TrainedReaderRecall:
    """The reader, and the training texts with their programs."""

    settings: ReaderRecall
    memory: TrainedRetrieveEdit

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps]:
        """Return for each text the program most like the others."""
        found = zip(requests, self.memory.candidates(requests), strict=True)
        return [self._chosen(request, *candidates) for request, candidates in found]

    def _chosen(self, request: Request, programs: list[Steps], weights: list[float]) -> Steps:
        """Return the choice among the reader's program and those that were found, without those that repeat."""
        own, share = read_program(request)
        kept = [(one, weight) for one, weight in zip(programs, weights, strict=True) if not repeats(one)]
        kept = kept or list(zip(programs, weights, strict=True))
        if own and share:
            total = sum(weight for _, weight in kept) or 1.0
            kept.append((own, total * share * self.settings.trust))
        return consensus([one for one, _ in kept], [weight for _, weight in kept])

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs."""
        return replace(self.memory.checkpoint(), model="reader-recall", settings=asdict(self.settings))


def read_program(request: Request) -> tuple[Steps, float]:
    """Return the acts of a text as people write programs, and the share of its clauses that are read."""
    known = default().of_set(LATEST)
    reading = read_text(request.description or request.title, known)
    if not reading.acts and request.description:
        reading = read_text(request.title, known)
    clauses = len({act.words for act in reading.acts})
    share = clauses / (clauses + len(reading.unread)) if clauses else 0.0
    return narrated(reading.acts, known), share
