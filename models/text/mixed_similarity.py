"""Similarities of texts by words and by vectors, mixed with a weight that validation chooses."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from hearth.models.text.retrieval import Similarity, ranked, text_of
from hearth.models.text_examples import Example
from hearth.scoring.metrics import lcs

if TYPE_CHECKING:
    import numpy as np

Vectors = Callable[[Sequence[str]], Any]
"""Gives a vector of length 1 for each text."""

WEIGHTS = (0.0, 0.25, 0.5, 0.75, 1.0)
"""The weights of vectors that validation chooses among; the rest is that of words."""


class MixedSimilarity:
    """Similarities to known texts: of words, as `Similarity`, and the cosine of vectors.

    Args:
        texts: the known texts.
        vectors: gives vectors.
        weight: of vectors, 0 to 1.
    """

    def __init__(self, texts: Sequence[str], vectors: Vectors, weight: float) -> None:
        self._words, self._vectors, self.weight = Similarity(texts), vectors, weight
        self._known = vectors(texts) if weight > 0 else None

    def nearest(self, texts: Sequence[str], count: int) -> list[tuple[list[int], list[float]]]:
        """Return the places of the most similar known texts for each text, best first, and their similarities."""
        if not texts:
            return []
        return ranked(mixed(self._words.alike(texts), self._by_vectors(texts), self.weight), count)

    def _by_vectors(self, texts: Sequence[str]) -> Any:
        return 0.0 if self._known is None else self._vectors(texts) @ self._known.T


def mixed(words: np.ndarray, vectors: Any, weight: float) -> np.ndarray:
    """Return similarities by both; those by vectors are rounded as coarsely as machines differ."""
    import numpy as np

    found: np.ndarray = (1 - weight) * words + weight * np.round(vectors, 5)
    return found


def by_weight(train: Sequence[Example], asked: Sequence[Example], vectors: Vectors) -> dict[float, list[lcs.LcsScore]]:
    """Return for each weight how similar the program of the nearest training text is to each example's own.

    Args:
        train: the known examples.
        asked: the examples whose programs are looked for.
        vectors: gives vectors.
    """
    known, texts = ([text_of(each.title, each.description) for each in part] for part in (train, asked))
    words, there = Similarity(known).alike(texts), vectors(texts) @ vectors(known).T
    found = {}
    for weight in WEIGHTS:
        places = [place for (place,), _ in ranked(mixed(words, there, weight), 1)]
        pairs = [(train[place].steps, each.steps) for place, each in zip(places, asked, strict=True)]
        found[weight] = lcs.score_pairs(pairs)
    return found


def mean_score(scores: Sequence[lcs.LcsScore]) -> float:
    """Return the mean over examples of their three similarities' mean, rounded."""
    return round(sum(each.mean for each in scores) / len(scores), 6)


def chosen_weight(train: Sequence[Example], validation: Sequence[Example], vectors: Vectors) -> float:
    """Return the weight with the best mean on validation; of equal ones the smallest."""
    found = by_weight(train, validation, vectors)
    return max(WEIGHTS, key=lambda weight: (mean_score(found[weight]), -weight))
