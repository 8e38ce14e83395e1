"""demo2sketch: the sketch of a demonstration, from pictures of it from above (thesis 5.4.3, A.1)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field
from itertools import compress
from random import Random
from typing import TYPE_CHECKING, Any

import torch
from torch.nn import functional

from hearth.models.checkpoint import Checkpoint
from hearth.models.checkpoint_weights import filled
from hearth.models.demonstrations.demo_batches import Done, DoneBatch, done_batch, frame_batch
from hearth.models.demonstrations.demonstration_data import Demonstrations, Pictures, shown
from hearth.models.demonstrations.frame_network import FrameBatch, FrameBody, FrameMemory
from hearth.models.demonstrations.mask_classes import MaskClasses
from hearth.models.demonstrations.overhead_features import Above, above
from hearth.models.devices import device
from hearth.models.films.clip_data import OfFilms
from hearth.models.interface import Request, Settings, Steps, Training
from hearth.models.text.program_writer import Numbers, Writer, beam
from hearth.models.text.seq2seq import WAYS
from hearth.models.text.step_heads import ComposedHead, StepEmbedding
from hearth.models.text.step_vocabulary import StepVocabulary
from hearth.models.text.text_batches import StepBatch, encoded, step_batch
from hearth.models.training import Task, train
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import derive
from hearth.scoring.metrics.lcs import score_pairs
from hearth.storage.parallel import Seen, unseen

if TYPE_CHECKING:
    from hearth.models.text_examples import Corpus, Example

NAME = "demo2sketch"

AT_ONCE = 32
"""Demonstrations that are read at once in prediction."""

Batch = tuple[FrameBatch, StepBatch, DoneBatch]


@dataclass(frozen=True, slots=True)
class DemoModel(Settings):
    """A network over colors, one over masks, and the features of each class in the masks; then an encoder-decoder.

    Attributes:
        colours: whether it has the network over colours.
        masks: whether it has the network over masks.
        facts: whether it reads the features of each class relative to the person, and points at classes (ours).
        whole: its networks look at the whole picture, one of four pixels each way, not around the person.
        guided: the weight of naming each step of the program in training, whether the sketch keeps it or not; 0 for
            sketches alone, as in the thesis.
        hidden: numbers in a hidden state.
        vector: numbers in the vector of a step.
        dropout: share of numbers left out in training.
        batch: demonstrations in a batch.
        longest: steps of the longest sketch.
    """

    colours: bool = True
    masks: bool = True
    facts: bool = True
    whole: bool = False
    guided: float = 1.0
    hidden: int = 128
    vector: int = 64
    dropout: float = 0.3
    batch: int = 16
    longest: int = 12

    def fitting(self) -> None:
        """Check that the encoder has two directions, and something to read."""
        self.multiple("hidden", *WAYS)
        if not (self.colours or self.masks or self.facts):
            raise ValueError("the settings `colours`, `masks` and `facts` are false: one of them is true")

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> TrainedDemoModel:
        """Train on the demonstrations of training programs; those of validation decide when to stop.

        Raises:
            HearthError: UNKNOWN_ID, if no program with a sketch has a demonstration, of training or of validation;
                DAMAGED_FILE, a demonstration or a sketch does not fit its program.
        """
        there = Demonstrations.of(corpus.dataset)
        learned, checked = (
            [(each, name) for each, name in shown(there, part) if each.sketch]
            for part in (corpus.train, corpus.validation)
        )
        if not learned or not checked:
            message = f"no {'validation' if learned else 'training'} program with a sketch has a demonstration"
            raise HearthError.of(Code.UNKNOWN_ID, message, suggestion="`make demos` makes some")
        pairs = [(Request(each.program_id), each.steps) for each in corpus.train]
        vocabulary = StepVocabulary.of(pairs, corpus.dataset.knowledge)
        known = MaskClasses.of(corpus.dataset.knowledge, vocabulary)
        torch.manual_seed(derive(how.seed, "weights"))
        model = TrainedDemoModel(self, vocabulary, known, self.network(vocabulary, known).to(device()))
        task = model.task(
            [(model.see(there.pictures_of(each, name)), each) for each, name in learned],
            [(model.see(there.pictures_of(each, name)), each) for each, name in checked],
            [asdict(self), corpus.facts, len(learned)],
        )
        counts = {"demonstrations": len(learned), "validated": len(checked)}
        model.trained.update({**counts, **train(task, how, seen).record()})
        return model

    def network(self, vocabulary: StepVocabulary, known: MaskClasses) -> Writer:
        """Return the network, with random weights."""
        traits = torch.from_numpy(known.traits)
        embedding = StepEmbedding(vocabulary, self.vector, traits)
        body = FrameBody(
            functional.pad(traits, (0, 0, 1, 0)), torch.from_numpy(known.served), len(vocabulary.actions) + 1,
            self.hidden, self.vector, self.dropout, (self.colours, self.masks, self.facts),
        )  # fmt: skip
        head = ComposedHead(vocabulary, embedding, body.features, self.vector, self.facts)
        return Writer(body, embedding, head, self.dropout)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedDemoModel:
        """Return the model of a checkpoint."""
        settings, content = cls.of(checkpoint.settings), checkpoint.content
        vocabulary = StepVocabulary.read(content["vocabulary"])
        known = MaskClasses.read(content["masks"], len(vocabulary.classes))
        writer = filled(lambda: settings.network(vocabulary, known), checkpoint.weights).to(device())
        return TrainedDemoModel(settings, vocabulary, known, writer, dict(checkpoint.trained))


@dataclass(frozen=True)
class TrainedDemoModel(OfFilms):
    """A network with its vocabulary."""

    name = NAME

    settings: DemoModel
    vocabulary: StepVocabulary
    known: MaskClasses
    writer: Writer
    trained: dict[str, Any] = field(default_factory=dict)

    def see(self, pictures: Pictures) -> Above:
        """Return the features of pictures, as the network reads them."""
        return above(pictures.masks, pictures.colours, self.known.person, self.settings.whole)

    def sketches(self, demonstrations: Sequence[Above], width: int = 1) -> list[Steps]:
        """Return the most probable sketch of each demonstration, by greedy or beam search.

        No sketch depends on the others.
        """
        self.writer.eval()
        order = sorted(range(len(demonstrations)), key=lambda place: demonstrations[place].length)
        found: dict[int, Numbers] = {}
        with torch.no_grad():
            for start in range(0, len(order), AT_ONCE):
                places = order[start : start + AT_ONCE]
                given = frame_batch([demonstrations[place] for place in places], self.known, self.writer.device)
                written: Any = given
                found |= dict(zip(places, beam(self.writer, written, width, self.settings.longest), strict=True))
        return [tuple(self.vocabulary.step(*each) for each in found[place]) for place in range(len(demonstrations))]

    def task(
        self, learned: Sequence[tuple[Above, Example]], checked: Sequence[tuple[Above, Example]], identity: Any
    ) -> Task[Batch]:
        """Training by the likelihood of the true sketches, and of the steps before each picture (`guided`)."""
        longest, where = self.settings.longest, self.writer.device
        data = [(seen, encoded(each.sketch, self.vocabulary, longest), self.done(each)) for seen, each in learned]

        def batches(random: Random) -> Iterator[Batch]:
            order = random.sample(range(len(data)), len(data))
            for start in range(0, len(order), self.settings.batch):
                seen, sketches, done = zip(*(data[place] for place in order[start : start + self.settings.batch]),
                                           strict=True)  # fmt: skip
                given = frame_batch(seen, self.known, where, random)
                yield given, step_batch(sketches, where, longest), done_batch(done, where)

        def validate() -> float:
            return sketch_lcs(self.sketches([seen for seen, _ in checked]), [each.sketch for _, each in checked])

        return Task(self.writer, batches, self.loss, validate, identity)

    def loss(self, batch: Batch) -> torch.Tensor:
        """Return the loss of the steps of sketches, plus `guided` times that of the steps before each picture."""
        frames, sketches, done = batch
        memory: Any = self.writer.body.encode(frames)
        total = self.writer.loss(memory, sketches)
        if self.settings.guided:
            total = total + self.settings.guided * self.guidance(frames, memory, done)
        return total

    def guidance(self, frames: FrameBatch, memory: FrameMemory, done: DoneBatch) -> torch.Tensor:
        """Return the loss of naming the step before each picture: whether it is kept, its action, and its classes."""
        real = done.real
        kept = functional.binary_cross_entropy_with_logits(memory.kept[real], done.kept[real])
        action = functional.cross_entropy(memory.done[real], done.steps[..., 0][real])
        if not self.settings.facts:
            return kept + action
        served = torch.from_numpy(self.known.served).to(real.device)[frames.classes[real]]  # (N, K, S)
        wanted = done.steps[..., 1:][real]  # (N, 2)
        about = ((served[..., None] == wanted[:, None, None]) & (served[..., None] > 0)).any(-1).any(-1)  # (N, K)
        there = frames.classes[real] > 0
        return (
            kept
            + action
            + functional.binary_cross_entropy_with_logits(memory.about[real][there], about[there].to(kept.dtype))
        )

    def done(self, example: Example) -> Done:
        """Return the step before each picture of an example's demonstration: of several steps in a tick, the first."""
        first = [not place or not step.joins for place, step in enumerate(example.steps)]
        steps = [self.vocabulary.numbers(step) or (0, 0, 0) for step in compress(example.steps, first)]
        return Done((None, *compress(example.keep, first)), ((0, 0, 0), *steps))

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs."""
        weights = {name: value.detach().cpu().numpy() for name, value in self.writer.state_dict().items()}
        content = {"vocabulary": self.vocabulary.document(), "masks": self.known.document()}
        return Checkpoint(NAME, asdict(self.settings), content, weights, self.trained)


def sketch_lcs(predicted: Sequence[Steps], references: Sequence[Steps]) -> float:
    """Return the mean LCS of whole steps; 0 without sketches."""
    scores = score_pairs(zip(predicted, references, strict=True))
    return sum(score.step for score in scores) / len(scores) if scores else 0.0
