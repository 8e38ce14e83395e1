"""The chooser of programs for a text: of those that are read, drawn and found, the one most like the others (ours).

The candidates are the program of the reader, those that a network draws, and the edited programs of similar texts. In a
home each is made to run first, and counts as much as it runs there. None that repeats itself is a candidate.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING

from hearth.models.interface import Request, Settings, Steps, Training
from hearth.models.reading.program_writing import repeats
from hearth.models.reading.reader_recall import read_program
from hearth.models.text.consensus_model import Consensus, TrainedConsensus
from hearth.models.text.retrieve_edit import consensus
from hearth.repair.runnable_predictions import complete
from hearth.storage.parallel import Seen, unseen

if TYPE_CHECKING:
    from hearth.models.checkpoint import Checkpoint
    from hearth.models.text_examples import Corpus

MOST_RUN = 12
"""Candidates that are run in a home: the reader's, and those that count most."""


@dataclass(frozen=True, slots=True)
class ReaderConsensus(Settings):
    """The chooser of programs for a text.

    Attributes:
        start, draws, share: as of `consensus`.
        trust: how much the reader's program counts, next to all others together.
    """

    start: str = ""
    draws: int = 24
    share: float = 0.65
    trust: float = 0.1

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> TrainedReaderConsensus:
        """Train the network, unless it is trained, and remember the training texts and programs.

        Raises:
            HearthError: errors of `consensus`.
        """
        pool = Consensus(self.start, self.draws, self.share).fit(corpus, how, seen)
        return TrainedReaderConsensus(replace(self, start=""), pool)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedReaderConsensus:
        """Return the model of a checkpoint."""
        settings = cls.of(checkpoint.settings)
        inner = Consensus("", settings.draws, settings.share)
        return TrainedReaderConsensus(settings, Consensus.restored(replace(checkpoint, settings=asdict(inner))))


@dataclass(frozen=True)
class TrainedReaderConsensus:
    """The reader, a trained network, and the training texts with their programs."""

    settings: ReaderConsensus
    pool: TrainedConsensus

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps]:
        """Return for each text the candidate most like all of them."""
        found = zip(requests, self.pool.candidates(requests, beam), strict=True)
        return [self._chosen(request, *candidates) for request, candidates in found]

    def _chosen(self, request: Request, programs: list[Steps], weights: list[float]) -> Steps:
        own, share = read_program(request)
        kept = [(one, weight) for one, weight in zip(programs, weights, strict=True) if one and not repeats(one)]
        if own and share:
            total = sum(weight for _, weight in kept) or 1.0
            kept.insert(0, (own, total * share * self.settings.trust))
        kept = runnable(kept, request) if request.world is not None else kept
        return consensus([one for one, _ in kept], [weight for _, weight in kept])

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs."""
        return replace(self.pool.checkpoint(), model="reader-consensus", settings=asdict(self.settings))


def runnable(candidates: Sequence[tuple[Steps, float]], request: Request) -> list[tuple[Steps, float]]:
    """Return the first candidate and those that count most, as they run in the home of a request.

    The weight of each is that before, times the share of its steps that can be done there.
    """
    assert request.world is not None
    world = request.world
    kept = [*candidates[:1], *sorted(candidates[1:], key=lambda each: -each[1])[: MOST_RUN - 1]]
    found = []
    for steps, weight in kept:
        done = complete(steps, world, world.home.knowledge, request.rules)
        found.append((done.execution.program.steps, weight * (1 - len(done.left_out) / len(steps))))
    return [(steps, weight) for steps, weight in found if steps]
