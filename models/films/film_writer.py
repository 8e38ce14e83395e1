"""The encoder-decoder over clips: it reads a classifier's probabilities and writes a program (thesis 4.3.3).

It is the network of texts with clips in the place of words: the encoder, the attention, the decoder and the heads are
those of `models.text`. The network can copy the contents of a clip, as it copies words that a text mentions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import cached_property
from random import Random
from typing import Any, Literal

import numpy as np
import torch
from numpy.typing import NDArray

from hearth.datasets.dataset import Dataset
from hearth.models.checkpoint import Checkpoint
from hearth.models.checkpoint_weights import filled
from hearth.models.decoding.search import Search, Start, decode
from hearth.models.devices import device
from hearth.models.films.clip_batches import clip_batch, rows_of, traits_of
from hearth.models.films.clip_data import OfFilms
from hearth.models.films.clip_embedding import ClipReader
from hearth.models.films.clip_probabilities import ClipProbabilities
from hearth.models.films.clip_result_tables import classifier
from hearth.models.films.film_training_examples import FilmExample, film_examples
from hearth.models.films.mask_clip_model import SeenModel, TrainedSeenModel
from hearth.models.interface import Request, Settings, Steps, Training
from hearth.models.text.likelihood_training import likelihood, written
from hearth.models.text.program_writer import Numbers, Writer
from hearth.models.text.seq2seq import WAYS, Seq2SeqBody
from hearth.models.text.step_heads import ClosedHead, ComposedHead, StepEmbedding
from hearth.models.text.step_vocabulary import StepVocabulary
from hearth.models.text.text_batches import InputBatch, encoded
from hearth.models.text.text_models import listed, mean_lcs
from hearth.models.text.text_scorer import TextScorer
from hearth.models.training import train
from hearth.schemas.rng import derive
from hearth.simulation.world.world import World
from hearth.storage.parallel import Seen, unseen

NAME = "films-mle"
"""Name of the model's checkpoints."""

READER = "classifier."
"""Before the names of the classifier's weights in a checkpoint."""

AT_ONCE = 32
"""Programs that are decoded with the engine at once."""


@dataclass(frozen=True, slots=True)
class FilmWriter(Settings):
    """An encoder-decoder over clips and steps.

    Attributes:
        start: a checkpoint of a classifier of clips by masks: its folder, or the name of one that comes with Hearth.
        steps: `closed`: a list of the steps of training, as in the thesis; `composed`: an action and its objects.
        copy: whether composed steps score the objects that clips show apart.
        hidden: numbers in a hidden state.
        vector: numbers in the vector of a step, and in those of a clip's action and objects.
        dropout: share of numbers left out in training.
        unnamed: share of classes whose learned numbers are left out in training.
        batch: films in a batch.
        longest: steps of the longest program.
        films: of training, at most; 0 for all.
        passes: over the films in an epoch: they are few, and an epoch decides about the rate.
    """

    start: str = "clips-context"
    steps: Literal["closed", "composed"] = "composed"
    copy: bool = True
    hidden: int = 100
    vector: int = 48
    dropout: float = 0.3
    unnamed: float = 0.5
    batch: int = 16
    longest: int = 40
    films: int = 0
    passes: int = 4

    def fitting(self) -> None:
        """Check that the encoder has two directions."""
        self.multiple("hidden", *WAYS)

    def fit(self, dataset: Dataset, how: Training, seen: Seen = unseen) -> TrainedFilmWriter:
        """Train on the films of `train` by the likelihood of the true steps; those of `validation` decide when to stop.

        Raises:
            HearthError: the classifier is missing, or is another model; errors of `Clips.of`.
        """
        reader = classifier(self.start)[1]
        learned = film_examples(dataset, "train", reader, self.films)
        checked = film_examples(dataset, "validation", reader)
        pairs = [(Request(each.execution), each.steps) for each in learned]
        vocabulary = StepVocabulary.of(pairs, dataset.knowledge)
        closed = listed(pairs, vocabulary, self.longest) if self.steps == "closed" else ()
        torch.manual_seed(derive(how.seed, "weights"))
        writer = self.network(vocabulary, closed, reader).to(device())
        model = TrainedFilmWriter(self, reader, vocabulary, closed, writer)
        data = [(each.clips, encoded(each.steps, vocabulary, self.longest)) for each in learned] * self.passes
        facts = {"films": len(learned), "classifier": _recorded(reader.facts), "seed": how.seed}
        task = likelihood(writer, data, model.read, self.batch, self.longest, lambda: model.score(checked),
                          [asdict(self), facts])  # fmt: skip
        model.trained.update({**facts, **train(task, how, seen).record()})
        return model

    def network(
        self, vocabulary: StepVocabulary, closed: Sequence[tuple[int, int, int]], reader: TrainedSeenModel
    ) -> Writer:
        """Return the network, with random weights."""
        traits = torch.from_numpy(traits_of(vocabulary, reader.table))
        embedding = StepEmbedding(vocabulary, self.vector, traits[1:])
        clips = ClipReader(len(reader.table.actions), traits, self.vector, self.unnamed)
        body = Seq2SeqBody(clips, clips.width, self.hidden, self.vector, self.dropout)
        if self.steps == "closed":
            head: Any = ClosedHead(vocabulary, embedding, body.features, self.vector, closed)
        else:
            head = ComposedHead(vocabulary, embedding, body.features, self.vector, self.copy)
        return Writer(body, embedding, head, self.dropout)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedFilmWriter:
        """Return the model of a checkpoint, which has its classifier, too."""
        settings, content = cls.of(checkpoint.settings), checkpoint.content
        own = {name: value for name, value in checkpoint.weights.items() if not name.startswith(READER)}
        others = {name[len(READER) :]: value for name, value in checkpoint.weights.items() if name not in own}
        facts = dict(checkpoint.trained.get("classifier", {}))
        reader = SeenModel.restored(Checkpoint("", content["classifier"], content, others, facts))
        vocabulary = StepVocabulary.read(content["vocabulary"])
        closed = vocabulary.read_closed(content["closed"])
        writer = filled(lambda: settings.network(vocabulary, closed, reader), own).to(device())
        return TrainedFilmWriter(settings, reader, vocabulary, closed, writer, dict(checkpoint.trained))


@dataclass(frozen=True)
class TrainedFilmWriter(OfFilms):
    """A network with its vocabulary, and the classifier whose answers it reads."""

    name = NAME

    settings: FilmWriter
    reader: TrainedSeenModel
    vocabulary: StepVocabulary
    closed: tuple[tuple[int, int, int], ...]
    writer: Writer
    trained: dict[str, Any] = field(default_factory=dict)

    def write(self, films: Sequence[ClipProbabilities], beam: int = 1) -> list[Steps]:
        """Return the most probable program of each film, by greedy or beam search: it need not run."""
        found = written(self.writer, films, self.read, len, beam, self.settings.longest)
        return [self.program(numbers) for numbers in found]

    def followed(self, films: Sequence[ClipProbabilities], worlds: Sequence[World], beam: int = 1) -> list[Steps]:
        """Return the program of each film with the engine in the loop: each runs in the world in which its film begins.

        Raises:
            HearthError: BAD_ARGUMENT, if the model chooses steps of a closed list.
        """
        starts, search = [Start(*each) for each in zip(worlds, films, strict=True)], Search(beam=beam)
        shares = (starts[first : first + AT_ONCE] for first in range(0, len(starts), AT_ONCE))
        return [steps for share in shares for steps in decode(self.scorer(), share, search)]

    def read(self, films: Sequence[ClipProbabilities], noise: Random | None = None) -> InputBatch:
        """Return the encoder's input for films; with noise, if a generator is given."""
        return clip_batch(films, self.rows, self.writer.device, noise)

    @cached_property
    def rows(self) -> NDArray[np.int64]:
        """See `rows_of`."""
        return rows_of(self.vocabulary, self.reader.table)

    def asked(self, examples: Sequence[FilmExample], random: Random) -> InputBatch:
        """Return the films of examples in the second phase of training, with noise: the classifier knows them."""
        return self.read([each.clips for each in examples], random)

    def program(self, numbers: Numbers) -> Steps:
        """Return the program of some numbers."""
        return tuple(self.vocabulary.step(*each) for each in numbers)

    def score(self, examples: Sequence[FilmExample]) -> float:
        """Return the mean LCS (of steps, actions and objects) of greedy programs for some films; 0 without any."""
        return mean_lcs(self.write([each.clips for each in examples]), [each.steps for each in examples])

    def scorer(self) -> TextScorer:
        """Return the model for decoding with the engine in the loop; its inputs are films."""
        return TextScorer(self.writer, self.vocabulary, self.read)

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs."""
        reader = self.reader.checkpoint()
        weights = {name: value.detach().cpu().numpy() for name, value in self.writer.state_dict().items()}
        weights |= {READER + name: value for name, value in reader.weights.items()}
        own = {"vocabulary": self.vocabulary.document(), "closed": [list(each) for each in self.closed]}
        content = {**own, **reader.content, "classifier": dict(reader.settings)}
        return Checkpoint(NAME, asdict(self.settings), content, weights, self.trained)


def _recorded(facts: Mapping[str, Any]) -> dict[str, Any]:
    """Return the recorded facts about a classifier: its training data and its seed."""
    return {name: facts[name] for name in ("digest", "clips", "seed") if name in facts}
