"""Precision, recall and F1 from counts, with the empty cases defined (thesis A.3)."""

from __future__ import annotations

from collections.abc import Mapping, Set
from typing import NamedTuple


class Prf(NamedTuple):
    """Precision, recall and their harmonic mean, each from 0 to 1."""

    precision: float
    recall: float
    f1: float


class Match(NamedTuple):
    """Numbers of tuples in both sets, in the prediction and in the reference."""

    both: int
    predicted: int
    reference: int

    def __add__(self, other: object) -> Match:
        if not isinstance(other, Match):
            return NotImplemented
        return Match(self.both + other.both, self.predicted + other.predicted, self.reference + other.reference)

    def prf(self) -> Prf:
        """Return the scores; all 1 for two empty sets, all 0 without common tuples."""
        if not self.predicted and not self.reference:
            return Prf(1.0, 1.0, 1.0)
        if not self.both:
            return NOTHING
        f1 = 2 * self.both / (self.predicted + self.reference)  # 2PR / (P + R), rounded once
        return Prf(self.both / self.predicted, self.both / self.reference, f1)


NOTHING = Prf(0.0, 0.0, 0.0)


class Matches(NamedTuple):
    """Matches of state tuples and of relation tuples."""

    states: Match
    relations: Match

    def rank(self) -> tuple[float, float]:
        """Return the rank of an assignment: F1 over both, then the sum of the two F1."""
        return ((self.states + self.relations).prf().f1, self.states.prf().f1 + self.relations.prf().f1)

    def published_rank(self) -> float:
        """Return the published scorer's rank: the sum of the three F1."""
        return sum(self.rank())


def shared(predicted: Set[object], reference: Set[object]) -> Match:
    """Return the match of two sets of tuples."""
    return Match(len(predicted & reference), len(predicted), len(reference))


def matched(predicted: Mapping[object, int], reference: Mapping[object, int]) -> Match:
    """Return the match of two multisets of tuples."""
    both = 0
    for item, count in predicted.items():
        other = reference.get(item)
        if other is not None:
            both += count if count < other else other
    return Match(both, sum(predicted.values()), sum(reference.values()))
