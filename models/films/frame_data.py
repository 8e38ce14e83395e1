"""The training data of a network of whole frames: numbers of instructions, and pictures."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.models.films.clip_data import NOTHING, Clips, Instruction


@dataclass(frozen=True)
class Labels:
    """Numbers of actions, of objects and of instructions.

    Attributes:
        actions: sorted.
        objects: sorted; they get the numbers from 1, no object `NOTHING`.
        instructions: those of training, sorted: the possible predictions for a clip.
    """

    actions: tuple[str, ...]
    objects: tuple[str, ...]
    instructions: tuple[Instruction, ...]

    @classmethod
    def of(cls, clips: Clips) -> Labels:
        """Return the labels of training clips."""
        done = {clip.done for clip in clips.clips}
        return cls(
            tuple(sorted({each.action for each in done})),
            tuple(sorted({name for each in done for name in each.objects})),
            tuple(sorted(done)),
        )

    def document(self) -> dict[str, Any]:
        """Return the labels as JSON."""
        rows = [[each.action, *each.objects] for each in self.instructions]
        return {"actions": [*self.actions], "objects": [*self.objects], "instructions": rows}

    @classmethod
    def read(cls, document: Mapping[str, Any]) -> Labels:
        """Return the labels of `document`, which may be a stranger's.

        Raises:
            KeyError: a part is missing.
            TypeError, ValueError: a part is of another kind, or does not fit the others.
        """
        rows = tuple(Instruction(str(row[0]), tuple(row[1:])) for row in document["instructions"])
        found = cls(tuple(document["actions"]), tuple(document["objects"]), rows)
        fits = (
            all(row.action in found.actions and len(row.objects) <= 2 for row in rows),
            {name for row in rows for name in row.objects} <= {*found.objects},
            bool(rows),
        )
        if not all(fits):
            raise ValueError("the numbers of actions, objects and instructions do not fit")
        return found

    @cached_property
    def rows(self) -> NDArray[np.int64]:
        """Return (I, 3) the numbers of each instruction's action and objects."""
        return np.array([self.numbers(each) for each in self.instructions], np.int64)

    def numbers(self, done: Instruction) -> tuple[int, int, int]:
        """Return the numbers of an instruction; -1 for an action, and for an object, that training never had."""
        names = [self._objects.get(name, -1) for name in done.objects]
        first, second = (*names, NOTHING, NOTHING)[:2]
        return self._actions.get(done.action, -1), first, second

    @cached_property
    def _actions(self) -> dict[str, int]:
        return {name: number for number, name in enumerate(self.actions)}

    @cached_property
    def _objects(self) -> dict[str, int]:
        return {name: number for number, name in enumerate(self.objects, 1)}


WIDTH = 64
"""Width of the pictures that a network of whole frames looks at, pixels."""

Pictures = Sequence[NDArray[np.uint8]]
"""(T, H, W, 3) colours of each film's frames, `WIDTH` wide."""


def pictures_of(clips: Clips) -> Pictures:
    """Return the colours of films as a network of whole frames looks at them.

    Of larger ones some pixels are left out.
    """
    return [_picture(film) for film in clips.films]


def _picture(film: NDArray[np.uint8]) -> NDArray[np.uint8]:
    step = max(1, film.shape[2] // WIDTH)
    return np.ascontiguousarray(film[:, step // 2 :: step, step // 2 :: step])


def frames_of(clips: Clips, pictures: Pictures, which: Sequence[int], taken: Iterable[int]) -> NDArray[np.uint8]:
    """Return (N, K, H, W, 3) colours of some frames of some clips."""
    places = list(taken)
    chosen = [clips.clips[number] for number in which]
    return np.stack([pictures[each.film][[each.first + n for n in places]] for each in chosen])
