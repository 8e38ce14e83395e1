"""The order of steps in programs: by their actions, and by the relations between their objects."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.models.films.clip_data import Clips, Instruction

TRUST = 8.0
"""Number of examples of an action above which its own successors count more than those of all actions."""

START = Instruction("", ())
"""Before the first step."""


@dataclass(frozen=True)
class StepOrder:
    """Counts of steps that follow each other.

    Attributes:
        counts: action -> (next action, for each object of the next step its place among the step's objects, or -1)
            -> how often.
    """

    counts: Mapping[str, Mapping[tuple[str, tuple[int, ...]], int]]

    @classmethod
    def of(cls, programs: Iterable[Sequence[Instruction]]) -> StepOrder:
        """Return the order of steps in programs."""
        counts: defaultdict[str, Counter[tuple[str, tuple[int, ...]]]] = defaultdict(Counter)
        for program in programs:
            for one, other in pairwise([START, *program]):
                counts[one.action][_kind(one, other)] += 1
        return cls({action: dict(found) for action, found in counts.items()})

    def document(self) -> list[Any]:
        """Return the order as JSON."""
        return sorted(
            [one, other, [*places], count]
            for one, found in self.counts.items()
            for (other, places), count in found.items()
        )

    @classmethod
    def read(cls, document: Any) -> StepOrder:
        """Return the order of `document`, which may be a stranger's.

        Raises:
            TypeError, ValueError: it is not one.
        """
        counts: defaultdict[str, dict[tuple[str, tuple[int, ...]], int]] = defaultdict(dict)
        for one, other, places, count in document:
            if type(one) is not str or type(other) is not str or type(count) is not int or count < 1:
                raise ValueError("an order of steps is [action, action, places, count]")
            counts[one][other, tuple(int(place) for place in places)] = count
        return cls(dict(counts))

    def logs(self, before: Sequence[Instruction], after: Sequence[Instruction]) -> NDArray[np.float32]:
        """Return (B, A) logarithms of how probable it is that a step of `after` follows one of `before`."""
        return np.array([[self._log(one, other) for other in after] for one in before], np.float32)

    def _log(self, one: Instruction, other: Instruction) -> float:
        found, kind = self.counts.get(one.action, {}), _kind(one, other)
        total = sum(found.values())
        return float(np.log((found.get(kind, 0) + TRUST * self._any(kind)) / (total + TRUST)))

    def _any(self, kind: tuple[str, tuple[int, ...]]) -> float:
        """Return how probable a next step is after any step."""
        return (self._all.get(kind, 0) + 0.01) / (sum(self._all.values()) + 1)

    @cached_property
    def _all(self) -> Counter[tuple[str, tuple[int, ...]]]:
        return sum((Counter(found) for found in self.counts.values()), Counter())


def _kind(one: Instruction, other: Instruction) -> tuple[str, tuple[int, ...]]:
    return other.action, tuple(one.objects.index(name) if name in one.objects else -1 for name in other.objects)


def programs_of(clips: Clips) -> list[list[Instruction]]:
    """Return the steps of each film, by its clips: steps without a clip are missing."""
    found: list[list[Instruction]] = [[] for _ in clips.executions]
    last: tuple[int, int] | None = None
    for clip in clips.clips:
        if (clip.film, clip.tick) != last:
            found[clip.film].append(clip.done)
        last = clip.film, clip.tick
    return found
