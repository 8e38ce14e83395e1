"""Baselines that answer with a training program: a random one, or that of the most similar description (thesis 4.5.2).

Skip-thoughts' weights are not to be had; the similarity of descriptions is the cosine of their TF-IDF weights, as they
are or in the space of their first singular vectors.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from hearth.models.checkpoint import Checkpoint
from hearth.models.interface import Request, Settings, Steps, Training
from hearth.models.text.text_words import words
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.rng import rng
from hearth.schemas.syntax import parse_steps, print_step
from hearth.storage.parallel import Seen, unseen

if TYPE_CHECKING:
    import numpy as np

    from hearth.models.text_examples import Corpus


@dataclass(frozen=True, slots=True)
class Memory:
    """The texts and programs of the training examples, each pair once, in the order of its first example."""

    texts: tuple[str, ...]
    programs: tuple[Steps, ...]

    @classmethod
    def of(cls, corpus: Corpus) -> Memory:
        """Return the memory of a corpus."""
        pairs = dict.fromkeys((text_of(each.title, each.description), each.steps) for each in corpus.train)
        return cls(tuple(text for text, _ in pairs), tuple(steps for _, steps in pairs))

    def document(self) -> dict[str, Any]:
        """Return the memory as JSON; each step is stored once."""
        lines = {print_step(step): step for steps in self.programs for step in steps}
        number = {step: place for place, step in enumerate(lines.values())}
        return {
            "texts": list(self.texts),
            "steps": list(lines),
            "programs": [[number[step] for step in steps] for steps in self.programs],
        }

    @classmethod
    def read(cls, document: dict[str, Any]) -> Memory:
        """Return the memory of `document`.

        Raises:
            KeyError: a part is missing.
            TypeError, ValueError: a part is of another kind, or there is not one text for each program.
        """
        steps = []
        for line in document["steps"]:
            parsed = parse_steps(line)
            if isinstance(parsed, Diagnostic):
                raise ValueError(str(parsed))
            steps.append(parsed[0])
        programs = tuple(tuple(steps[number] for number in program) for program in document["programs"])
        texts = tuple(document["texts"])
        if not texts or len(texts) != len(programs) or not all(isinstance(text, str) for text in texts):
            raise ValueError(f"{len(texts)} texts of {len(programs)} programs")
        return cls(texts, programs)


def text_of(title: str, description: str) -> str:
    """Return the title and the description in one."""
    return f"{title}. {description}" if title else description


@dataclass(frozen=True, slots=True)
class RandomRetrieval(Settings):
    """Answers with the program of a random training example, drawn from the seed and the text that is asked."""

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> TrainedRandomRetrieval:
        """Remember the training programs."""
        return TrainedRandomRetrieval(self, Memory.of(corpus), how.seed)

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedRandomRetrieval:
        """Return the model of a checkpoint."""
        content = checkpoint.content
        return TrainedRandomRetrieval(cls.of(checkpoint.settings), Memory.read(content["memory"]), content["seed"])


@dataclass(frozen=True)
class TrainedRandomRetrieval:
    """The training programs, and a seed."""

    settings: RandomRetrieval
    memory: Memory
    seed: int

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps]:
        """Return a program for each request, drawn from its text: the same whatever else is asked."""
        drawn = (rng(self.seed, "random retrieval", each.title, each.description) for each in requests)
        return [each.choice(self.memory.programs) for each in drawn]

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs."""
        content = {"memory": self.memory.document(), "seed": self.seed}
        return Checkpoint("random-retrieval", asdict(self.settings), content, {})


@dataclass(frozen=True, slots=True)
class Nearest(Settings):
    """Answers with the program of the training example whose text is most similar.

    Attributes:
        singular: the number of singular vectors in whose space texts are compared; 0 for TF-IDF as it is.
    """

    singular: int = 0

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> TrainedNearest:
        """Remember the training texts and programs."""
        return TrainedNearest(self, Memory.of(corpus))

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> TrainedNearest:
        """Return the model of a checkpoint."""
        found = TrainedNearest(cls.of(checkpoint.settings), Memory.read(checkpoint.content["memory"]))
        found.similarity  # noqa: B018  (texts without a word are refused now, not when it is asked)
        return found


@dataclass(frozen=True)
class TrainedNearest:
    """The training texts with their programs, and their weights."""

    settings: Nearest
    memory: Memory

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps]:
        """Return the program of the most similar text for each request; of equal ones the first."""
        nearest = self.similarity.nearest([text_of(each.title, each.description) for each in requests], 1)
        return [self.memory.programs[places[0]] for places, _ in nearest]

    def checkpoint(self) -> Checkpoint:
        """Return all that `restored` needs; the weights are made again from the texts."""
        name = "nearest-svd" if self.settings.singular else "nearest"
        return Checkpoint(name, asdict(self.settings), {"memory": self.memory.document()}, {})

    @cached_property
    def similarity(self) -> Similarity:
        """Similarities to the training texts."""
        return Similarity(self.memory.texts, self.settings.singular)


class Similarity:
    """Similarities of texts to known ones: the cosine of TF-IDF weights, or of their projections."""

    def __init__(self, texts: Sequence[str], singular: int = 0) -> None:
        from sklearn.feature_extraction.text import TfidfVectorizer

        self.weights = TfidfVectorizer(analyzer=_terms, sublinear_tf=True)
        known = self.weights.fit_transform(texts)
        self.projection = None
        if singular:
            from sklearn.decomposition import TruncatedSVD

            size = max(1, min(singular, min(known.shape) - 1))
            self.projection = TruncatedSVD(size, algorithm="randomized", random_state=0).fit(known)
        self.known = self._projected(known)

    def nearest(self, texts: Sequence[str], count: int) -> list[tuple[list[int], list[float]]]:
        """Return the places of the most similar known texts for each text, best first, and their similarities."""
        if not texts:
            return []
        return ranked(self.alike(texts), count)

    def alike(self, texts: Sequence[str]) -> np.ndarray:
        """Return the similarity of each text to each known one."""
        found: Any = self._projected(self.weights.transform(texts)) @ self.known.T
        alike: np.ndarray = found if self.projection is not None else found.toarray()
        return alike

    def _projected(self, weights: Any) -> np.ndarray | Any:
        if self.projection is None:
            return weights
        from sklearn.preprocessing import normalize

        return normalize(self.projection.transform(weights))


def ranked(alike: np.ndarray, count: int) -> list[tuple[list[int], list[float]]]:
    """Return the places of the greatest similarities in each row, best first, and these; of equal ones the first."""
    rows = alike.round(9)  # sums of floats depend on the order of words: rounding makes them equal
    places = (-rows).argsort(axis=1, kind="stable")[:, :count]
    return [(place.tolist(), row[place].tolist()) for place, row in zip(places, rows, strict=True)]


def _terms(text: str) -> list[str]:
    """Return the words of a text, and its pairs of neighbours."""
    found = words(text)
    return [*found, *(f"{one} {other}" for one, other in pairwise(found))]
