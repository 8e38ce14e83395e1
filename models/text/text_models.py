"""Models that read a text and write a program step by step: their settings, training and predictions (thesis 4.3)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from random import Random
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import torch

from hearth.models.checkpoint import Checkpoint
from hearth.models.checkpoint_weights import filled
from hearth.models.devices import device
from hearth.models.interface import Request, Settings, Steps, Training
from hearth.models.text.likelihood_training import likelihood, written
from hearth.models.text.program_writer import Numbers, Writer, sample
from hearth.models.text.seq2seq import WAYS, Seq2SeqBody, word_embedding
from hearth.models.text.step_heads import ClosedHead, ComposedHead, StepEmbedding
from hearth.models.text.step_vocabulary import UNKNOWN, StepVocabulary
from hearth.models.text.text_batches import InputBatch, encoded, text_batch
from hearth.models.text.text_scorer import TextScorer
from hearth.models.text.text_words import words, words_of
from hearth.models.text.transformer import HEADS, TransformerBody
from hearth.models.text.word_vectors import word_vectors
from hearth.models.training import train
from hearth.schemas.rng import derive
from hearth.scoring.metrics.lcs import score_pairs
from hearth.storage.parallel import Seen, unseen

if TYPE_CHECKING:
    from hearth.models.text_examples import Corpus, Example


@dataclass(frozen=True, slots=True)
class TextModel(Settings):
    """An encoder-decoder over words and steps.

    Attributes:
        body: an LSTM with attention, or a transformer.
        layers: of the transformer.
        steps: `closed`: a list of the steps of training, as in the thesis; `composed`: an action and its objects.
        copy: whether composed steps score the objects that the text mentions apart.
        hidden: numbers in a hidden state.
        vector: numbers in the vector of a word, and of a step.
        dropout: share of numbers left out in training.
        batch: examples in a batch.
        longest: steps of the longest program.
    """

    body: Literal["lstm", "transformer"] = "lstm"
    layers: int = 1
    steps: Literal["closed", "composed"] = "composed"
    copy: bool = True
    hidden: int = 100
    vector: int = 100
    dropout: float = 0.4
    batch: int = 32
    longest: int = 40

    def fitting(self) -> None:
        """Check that the encoder has two directions, or the transformer its heads, which share the hidden state."""
        if self.body == "lstm":
            self.multiple("hidden", *WAYS)
        else:
            self.multiple("hidden", HEADS, "the heads of the transformer share it")

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> TrainedTextModel:
        """Train on the pairs of text and program by the likelihood of the true steps (thesis 4.3.1, first phase).

        Raises:
            HearthError: BAD_ARGUMENT, if there is nothing for validation.
        """
        checked = corpus.checked()
        pairs = [(each.request, each.steps) for each in corpus.train]
        vocabulary = StepVocabulary.of(pairs, corpus.dataset.knowledge)
        torch.manual_seed(derive(how.seed, "weights"))
        closed = listed(pairs, vocabulary, self.longest) if self.steps == "closed" else ()
        writer = self.network(vocabulary, closed, _vectors(pairs, vocabulary, self.vector)).to(device())
        model = TrainedTextModel(self, vocabulary, closed, writer, {})
        data = [(request, encoded(steps, vocabulary, self.longest)) for request, steps in pairs]
        task = likelihood(writer, data, model.read, self.batch, self.longest,
                          lambda: model.score(checked), [asdict(self), corpus.facts])  # fmt: skip
        model.trained.update(train(task, how, seen).record())
        return model

    def network(
        self, vocabulary: StepVocabulary, closed: Sequence[tuple[int, int, int]], vectors: np.ndarray | None
    ) -> Writer:
        """Return the network before training; vectors of words and of names, if given, are where they begin."""
        count = len(vocabulary.words) + UNKNOWN + 1
        given = torch.zeros(count + len(vocabulary.classes), self.vector) if vectors is None else torch.tensor(vectors)
        embedding = StepEmbedding(vocabulary, self.vector, given[count:])
        body: Any
        sizes = self.hidden, self.vector, self.dropout
        if self.body == "lstm":
            body = Seq2SeqBody(word_embedding(given[:count]), self.vector, *sizes)
        else:
            body = TransformerBody(word_embedding(given[:count]), self.vector, *sizes, self.layers)
        if self.steps == "closed":
            head: Any = ClosedHead(vocabulary, embedding, body.features, self.vector, closed)
        else:
            head = ComposedHead(vocabulary, embedding, body.features, self.vector, self.copy)
        return Writer(body, embedding, head, self.dropout)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedTextModel:
        """Return the model of a checkpoint."""
        settings = cls.of(checkpoint.settings)
        vocabulary = StepVocabulary.read(checkpoint.content["vocabulary"])
        closed = vocabulary.read_closed(checkpoint.content["closed"])
        writer = filled(lambda: settings.network(vocabulary, closed, None), checkpoint.weights).to(device())
        return TrainedTextModel(settings, vocabulary, closed, writer, dict(checkpoint.trained))


@dataclass(frozen=True)
class TrainedTextModel:
    """A network with its vocabulary."""

    settings: TextModel
    vocabulary: StepVocabulary
    closed: tuple[tuple[int, int, int], ...]
    writer: Writer
    trained: dict[str, Any]

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps]:
        """Return the most probable program for each text, by greedy or beam search."""
        return [self.program(numbers) for numbers in self.numbers(requests, beam)]

    def numbers(self, requests: Sequence[Request], width: int = 1) -> list[Numbers]:
        """Return the programs as numbers of the vocabulary."""
        return written(self.writer, requests, self.read, lambda each: len(words_of(each)), width, self.settings.longest)

    def read(self, requests: Sequence[Request], noise: Random | None = None) -> InputBatch:
        """Return the texts of requests; with noise, if a generator is given."""
        return text_batch(requests, self.vocabulary, self.writer.device, noise)

    def asked(self, examples: Sequence[Example], random: Random) -> InputBatch:
        """Return the texts of examples in the second phase of training, without noise."""
        return self.read([each.request for each in examples])

    def drawn(self, request: Request, count: int) -> list[Steps]:
        """Programs for a text, drawn step by step; they depend on the text and the weights alone."""
        self.writer.eval()
        generator = torch.Generator().manual_seed(derive(0, "drawn", request.title, request.description) % 2**63)
        with torch.no_grad():
            texts = text_batch([request] * count, self.vocabulary, self.writer.device)
            return [self.program(numbers) for numbers in sample(self.writer, texts, self.settings.longest, generator)]

    def program(self, numbers: Numbers) -> Steps:
        """Return the program of some numbers."""
        return tuple(self.vocabulary.step(*each) for each in numbers)

    def score(self, examples: Sequence[Example]) -> float:
        """Return the mean LCS (of steps, actions and objects) of greedy programs for some examples; 0 without any."""
        texts = {(each.title, each.description): each.request for each in examples}
        known = dict(zip(texts, self.predict(list(texts.values())), strict=True))
        predicted = [known[each.title, each.description] for each in examples]
        return mean_lcs(predicted, [each.steps for each in examples])

    def scorer(self) -> TextScorer:
        """Return the model for decoding with the engine in the loop."""
        return TextScorer(self.writer, self.vocabulary, self.read)

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs."""
        weights = {name: value.detach().cpu().numpy() for name, value in self.writer.state_dict().items()}
        content = {"vocabulary": self.vocabulary.document(), "closed": [list(each) for each in self.closed]}
        return Checkpoint("", asdict(self.settings), content, weights, self.trained)


def mean_lcs(predicted: Sequence[Steps], references: Sequence[Steps]) -> float:
    """Return the mean over programs of the mean LCS of steps, actions and objects; 0 without programs."""
    scores = score_pairs(zip(predicted, references, strict=True))
    return sum(score.mean for score in scores) / len(scores) if scores else 0.0


def listed(
    pairs: Sequence[tuple[Request, Steps]], vocabulary: StepVocabulary, longest: int
) -> tuple[tuple[int, int, int], ...]:
    """Return every step of the training programs once, sorted."""
    return tuple(sorted({numbers for _, steps in pairs for numbers in encoded(steps, vocabulary, longest)}))


def _vectors(pairs: Sequence[tuple[Request, Steps]], vocabulary: StepVocabulary, size: int) -> np.ndarray:
    """Return (words and classes, size): no word, the unknown word, the words, and the names of the classes."""
    names = [words(name.replace("_", " ")) for name in vocabulary.classes]
    documents = (
        (
            words_of(request),
            [word for step in steps for ref in step.objects for word in words(ref.name.replace("_", " "))],
        )
        for request, steps in pairs
    )
    known = sorted({*vocabulary.words, *(word for name in names for word in name)})
    place = {word: number for number, word in enumerate(known)}
    vectors = word_vectors(documents, known, size)
    of_names = [vectors[[place[word] for word in name]].mean(0) if name else np.zeros(size) for name in names]
    of_words = vectors[[place[word] for word in vocabulary.words]].reshape(-1, size)
    return np.concatenate((np.zeros((UNKNOWN + 1, size)), of_words, np.array(of_names))).astype(np.float32)
