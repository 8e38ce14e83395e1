"""Demonstrations as arrays, and two demonstrations as one."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from random import Random
from typing import NamedTuple

import numpy as np

from hearth.models.watching.object_sightings import Layout, Seen

Counts = tuple[int, ...]
"""The number of times that each predicate is wanted."""

MOST_PLACES = 12
"""Places of a thing that are read: of more, the last ones."""


@dataclass(frozen=True, slots=True)
class Watched:
    """A demonstration with its goal.

    Attributes:
        things: the observed things (see `object_sightings`).
        counts: of the goal.
    """

    things: tuple[Seen, ...]
    counts: Counts


class Packed(NamedTuple):
    """Demonstrations as arrays, padded; D demonstrations of at most T things with at most E places.

    Attributes:
        kinds: (D, T), from 1; 0 stands for no thing.
        places: (D, T, E), from 1; 0 stands for no place.
        times: (D, T, E).
        counts: (D, P), of the P predicates.
    """

    kinds: np.ndarray
    places: np.ndarray
    times: np.ndarray
    counts: np.ndarray


def packed(examples: Sequence[Watched], predicates: int) -> Packed:
    """Demonstrations as arrays."""
    most = max((len(each.things) for each in examples), default=0) or 1
    longest = max((len(thing.places) for each in examples for thing in each.things), default=1)
    shape = (len(examples), most, min(longest, MOST_PLACES))
    found = Packed(
        np.zeros(shape[:2], np.int64),
        np.zeros(shape, np.int64),
        np.zeros(shape, np.float32),
        np.zeros((len(examples), predicates), np.int64),
    )
    for i, each in enumerate(examples):
        found.counts[i] = each.counts
        for j, thing in enumerate(each.things):
            places = thing.places[-MOST_PLACES:]
            found.kinds[i, j] = thing.kind + 1
            found.places[i, j, : len(places)] = [place + 1 for place in places]
            found.times[i, j, : len(places)] = thing.times[-MOST_PLACES:]
    return found


@dataclass(frozen=True)
class Joining:
    """A function that joins two demonstrations into one, as if one person had had both goals.

    A network that has only seen single activities takes whatever belongs to another for a distraction.

    Attributes:
        layout: of the predicates.
        set_of: for each predicate the number of its goal set.
        forbidden: goals that are kept for testing.
    """

    layout: Layout
    set_of: tuple[int, ...]
    forbidden: frozenset[Counts]

    def goal_set(self, example: Watched) -> int:
        """Return the goal set of a demonstration of one."""
        return next((self.set_of[i] for i, count in enumerate(example.counts) if count), -1)

    def __call__(self, one: Watched, other: Watched, chooser: Random) -> Watched | None:
        """Return both at once, each in a part of the time; None where both are of one set, or the goal is forbidden.

        Things that were left where only the other goal wants such things would be in the way: they are left out, and so
        are all distractions of the second demonstration.
        """
        counts = tuple(map(sum, zip(one.counts, other.counts, strict=True)))
        if self.goal_set(one) == self.goal_set(other) or counts in self.forbidden:
            return None
        first = [thing for thing in one.things if not self._stray(thing, one) or not self._concerns(thing, other)]
        second = [thing for thing in other.things if not self._stray(thing, other)]
        return Watched((*_within(first, chooser), *_within(second, chooser)), counts)

    def _stray(self, thing: Seen, example: Watched) -> bool:
        """Return whether a thing ends where the goal does not want it, but another may."""
        cell = (thing.kind, thing.places[-1])
        return cell in self.layout.cells and not example.counts[self.layout.cells.index(cell)]

    def _concerns(self, thing: Seen, example: Watched) -> bool:
        """Return whether a goal, or another of its set, is about such things."""
        cell = self.layout.cells.index((thing.kind, thing.places[-1]))
        wanted = {self.layout.cells[i][0] for i, count in enumerate(example.counts) if count}
        return thing.kind in wanted or self.set_of[cell] == self.goal_set(example)


def _within(things: Sequence[Seen], chooser: Random) -> list[Seen]:
    """Return the things in a part of the time: of two activities one begins later, or ends earlier."""
    length = chooser.uniform(0.5, 1.0)
    start = chooser.uniform(0.0, 1.0 - length)
    return [thing._replace(times=tuple(start + length * time for time in thing.times)) for thing in things]


def epoch(examples: Sequence[Watched], joining: Joining, share: float, chooser: Random) -> list[Watched]:
    """Return all demonstrations in an order that is drawn; some share of them is joined with another one."""
    found = []
    for each in chooser.sample(examples, len(examples)):
        both = joining(each, chooser.choice(examples), chooser) if chooser.random() < share else None
        found.append(both or each)
    return found


def in_batches(examples: Sequence[Watched], size: int, predicates: int) -> Iterator[Packed]:
    """Batches of demonstrations as arrays."""
    for start in range(0, len(examples), size):
        yield packed(examples[start : start + size], predicates)
