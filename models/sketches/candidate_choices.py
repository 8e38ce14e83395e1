"""Choices among candidates as arrays, and the network that scores them: one for nodes, one for steps.

A choice has any number of candidates; the candidates of all choices of a batch lie one after the other.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np


class Candidate(NamedTuple):
    """A candidate: numbers of names (see `name_numbers`), and other numbers."""

    names: Sequence[int]
    numbers: Sequence[float]


class Choice(NamedTuple):
    """A choice: the common features of its candidates, the candidates, and the index of the right one (-1 if unknown).

    Attributes:
        names: numbers of names, each with a meaning of its own.
        bag: numbers of names whose order says nothing.
        numbers: other numbers.
        text: numbers of the words of a text.
        candidates: one at least.
        right: index of the right one.
    """

    names: Sequence[int]
    bag: Sequence[int]
    numbers: Sequence[float]
    candidates: Sequence[Candidate]
    right: int = -1
    text: Sequence[int] = ()


class Packed(NamedTuple):
    """D choices with C candidates in all.

    Attributes:
        names: (D, k) int16.
        bag: (D, b) int16, filled up with 0.
        numbers: (D, m) float16.
        candidate_names: (C, k') int16.
        candidate_numbers: (C, m') float16.
        starts: (D + 1,) int64, where each choice's candidates begin.
        right: (D,) int64.
        text: (D, t) int16, filled up with 0.
    """

    names: np.ndarray
    bag: np.ndarray
    numbers: np.ndarray
    candidate_names: np.ndarray
    candidate_numbers: np.ndarray
    starts: np.ndarray
    right: np.ndarray
    text: np.ndarray

    def __len__(self) -> int:
        return len(self.right)

    def part(self, places: Sequence[int] | np.ndarray) -> Packed:
        """Return some of the choices."""
        chosen = np.asarray(places, dtype=np.int64)
        counts = (self.starts[1:] - self.starts[:-1])[chosen]
        starts = np.concatenate([[0], np.cumsum(counts)])
        rows = np.repeat(self.starts[chosen] - starts[:-1], counts) + np.arange(starts[-1])
        names, numbers = self.candidate_names[rows], self.candidate_numbers[rows]
        return Packed(
            self.names[chosen],
            self.bag[chosen],
            self.numbers[chosen],
            names,
            numbers,
            starts,
            self.right[chosen],
            self.text[chosen],
        )


BAG = 12
"""Names in a bag at most."""

TEXT = 40
"""Words of a text at most."""


def packed(choices: Iterable[Choice]) -> Packed:
    """Choices as arrays."""
    found = list(choices)
    candidates = [each for choice in found for each in choice.candidates]
    return Packed(
        np.array([choice.names for choice in found], np.int16),
        _filled([choice.bag for choice in found], BAG),
        np.array([choice.numbers for choice in found], np.float16),
        np.array([each.names for each in candidates], np.int16),
        np.array([each.numbers for each in candidates], np.float16),
        np.cumsum([0, *(len(choice.candidates) for choice in found)]),
        np.array([choice.right for choice in found], np.int64),
        _filled([choice.text for choice in found], TEXT),
    )


def _filled(bags: Sequence[Sequence[int]], most: int) -> np.ndarray:
    """Bags as rows, filled up with 0."""
    rows = np.zeros((len(bags), most), np.int16)
    for row, bag in enumerate(bags):
        rows[row, : min(most, len(bag))] = bag[:most]
    return rows


def joined(parts: Sequence[Packed]) -> Packed:
    """Several arrays of choices as one."""
    names, bag, numbers, more, values = (np.concatenate(column) for column in zip(*(p[:5] for p in parts), strict=True))
    counts = np.concatenate([part.starts[1:] - part.starts[:-1] for part in parts])
    starts, right = np.concatenate([[0], np.cumsum(counts)]), np.concatenate([part.right for part in parts])
    text = np.concatenate([part.text for part in parts])
    return Packed(names, bag, numbers, more, values, starts, right, text)
