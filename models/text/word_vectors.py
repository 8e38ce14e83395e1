"""Vectors of words, made from the training texts: word2vec's published ones are not to be had (thesis 4.3.2).

Words are alike that stand near the same words, or in texts of the same programs: positive pointwise mutual information
with the words around and with the names in the program, and the first singular vectors of it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np

WINDOW = 4
"""Words before and after a word that count as near it."""


def word_vectors(
    documents: Iterable[tuple[Sequence[str], Sequence[str]]], vocabulary: Sequence[str], size: int
) -> np.ndarray:
    """Return a vector for each word of the vocabulary, of length 1; of words that no document has, 0.

    Args:
        documents: the words of a text, and those of the names in its program.
        vocabulary: words and words of names.
        size: numbers in a vector.

    Returns:
        (len(vocabulary), size) float32; equal documents give equal vectors, whatever their order.
    """
    import numpy as np
    from scipy.sparse import coo_array
    from scipy.sparse.linalg import svds

    place = {word: number for number, word in enumerate(vocabulary)}
    counts = _pairs(documents, place)
    found = np.zeros((len(vocabulary), size), dtype=np.float32)
    rank = min(size, len(vocabulary) - 1)
    if not counts or rank < 1:
        return found
    keys = sorted(counts)
    rows, columns = np.array(keys, dtype=np.int64).T
    values = np.array([counts[key] for key in keys], dtype=np.float64)
    total = np.bincount(rows, values, len(vocabulary))
    information = np.log(values * values.sum() / (total[rows] * total[columns]))
    shape = (len(vocabulary), len(vocabulary))
    matrix = coo_array((np.maximum(information, 0), (rows, columns)), shape=shape).tocsr()
    left, strengths, _ = svds(matrix, k=rank, v0=np.ones(len(vocabulary)))
    order = (-strengths).argsort(kind="stable")
    vectors = left[:, order] * np.sqrt(strengths[order])
    vectors *= np.where(vectors[np.abs(vectors).argmax(0), np.arange(rank)] < 0, -1, 1)  # signs are arbitrary
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    found[:, :rank] = np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 1e-9)
    return found


def _pairs(documents: Iterable[tuple[Sequence[str], Sequence[str]]], place: dict[str, int]) -> Counter[tuple[int, int]]:
    """Return how often two words are near each other, or one in a text and one in its program; both ways."""
    counts: Counter[tuple[int, int]] = Counter()
    for text, names in documents:
        numbers = [place[word] for word in text if word in place]
        for at, one in enumerate(numbers):
            for other in numbers[at + 1 : at + 1 + WINDOW]:
                counts[one, other] += 1
                counts[other, one] += 1
        for name in {place[word] for word in names if word in place}:
            for one in set(numbers):
                counts[one, name] += 1
                counts[name, one] += 1
    return counts
