"""Clips of a published dataset as arrays, and the numbers of what is seen and done in them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.names import inside

if TYPE_CHECKING:
    from hearth.datasets.dataset import Dataset

NOTHING = 0
"""Number of what is not in the palette, and of no object."""

MOST_COLOURS = 255
"""Classes that a palette has numbers for."""

LARGEST = 64 << 20
"""Bytes of a film's file."""


class Instruction(NamedTuple):
    """What is done in the middle of a clip: an action and the classes of its objects."""

    action: str
    objects: tuple[str, ...]


class Clip(NamedTuple):
    """A clip.

    Attributes:
        film: number of its film.
        first: its first frame.
        done: in its middle.
        kind: of its home: seen, validation or unseen.
        tick: of the film.
    """

    film: int
    first: int
    done: Instruction
    kind: str
    tick: int


@dataclass(frozen=True)
class Clips:
    """Clips of a part of a dataset.

    Attributes:
        executions: of each film.
        films: (T, H, W) uint16 class numbers of each film's frames.
        clips: in the order of films and frames.
        frames: of a clip.
    """

    executions: tuple[str, ...]
    films: tuple[NDArray[np.uint16], ...]
    clips: tuple[Clip, ...]
    frames: int

    @classmethod
    def of(cls, dataset: Dataset, part: str, most: int = 0) -> Clips:
        """The clips of a part; of some films alone if `most` is given.

        Raises:
            HearthError: UNKNOWN_ID, if there are none; DAMAGED_FILE, if a film's arrays are not what rows say.
        """
        columns = "execution_id, file, first, frames, action, objects, kind, tick"
        query = f"SELECT {columns} FROM clips WHERE part = $part ORDER BY execution_id, number"
        rows = dataset.rows(query, part=part)[1]
        if not rows:
            message = f"the dataset has no clips of the part `{part}`"
            raise HearthError.of(Code.UNKNOWN_ID, message, suggestion="`make clips` makes some")
        files = list(dict.fromkeys((row[0], row[1]) for row in rows))[: most or None]
        numbers = {execution: number for number, (execution, _) in enumerate(files)}
        films = tuple(_film(dataset, file) for _, file in files)
        found = []
        for execution, file, first, frames, action, objects, kind, tick in rows:
            if execution in numbers:
                number = numbers[execution]
                if not 0 <= first <= len(films[number]) - frames:
                    raise _damaged(file, "a clip is outside of its film")
                found.append(Clip(number, first, Instruction(action, tuple(objects)), kind, tick))
        return cls(tuple(execution for execution, _ in files), films, tuple(found), rows[0][3])

    def __len__(self) -> int:
        return len(self.clips)


def _film(dataset: Dataset, file: str) -> NDArray[np.uint16]:
    from io import BytesIO

    from hearth.storage.input_files import read_input

    data = BytesIO(read_input(inside(dataset.folder, file), LARGEST))
    try:
        with np.load(data, allow_pickle=False) as arrays:
            masks: NDArray[np.uint16] = arrays["class_ids"]
    except (ValueError, KeyError, OSError, EOFError) as error:
        raise _damaged(file, str(error)[:100]) from error
    if masks.ndim != 3 or masks.dtype != np.uint16 or not 0 < masks.size <= 1 << 28:
        raise _damaged(file, f"its masks have the form {masks.shape} of {masks.dtype}")
    return masks


def _damaged(file: str, message: str) -> HearthError:
    return HearthError.of(Code.DAMAGED_FILE, message, file=file, suggestion="fetch the dataset again")


@dataclass(frozen=True)
class Labels:
    """Numbers of classes that are seen, of actions, of objects and of instructions.

    Attributes:
        seen: class numbers of masks, the commonest first; they get the numbers from 1, all others `NOTHING`.
        actions: sorted.
        objects: sorted; they get the numbers from 1, no object `NOTHING`.
        instructions: those of training, sorted: what a clip can be taken for.
    """

    seen: tuple[int, ...]
    actions: tuple[str, ...]
    objects: tuple[str, ...]
    instructions: tuple[Instruction, ...]

    @classmethod
    def of(cls, clips: Clips) -> Labels:
        """Those of training clips."""
        pixels: Counter[int] = Counter()
        for film in clips.films:
            numbers, counts = np.unique(film, return_counts=True)
            pixels.update(dict(zip(numbers.tolist(), counts.tolist(), strict=True)))
        done = {clip.done for clip in clips.clips}
        common = sorted((number for number in pixels if number), key=lambda number: (-pixels[number], number))
        return cls(
            tuple(common[:MOST_COLOURS]),
            tuple(sorted({each.action for each in done})),
            tuple(sorted({name for each in done for name in each.objects})),
            tuple(sorted(done)),
        )

    def document(self) -> dict[str, Any]:
        """As JSON."""
        rows = [[each.action, *each.objects] for each in self.instructions]
        return {"seen": [*self.seen], "actions": [*self.actions], "objects": [*self.objects], "instructions": rows}

    @classmethod
    def read(cls, document: Mapping[str, Any]) -> Labels:
        """Those of `document`, which may be a stranger's.

        Raises:
            KeyError: a part is missing.
            TypeError, ValueError: a part is of another kind, or does not fit the others.
        """
        rows = tuple(Instruction(str(row[0]), tuple(row[1:])) for row in document["instructions"])
        found = cls(tuple(document["seen"]), tuple(document["actions"]), tuple(document["objects"]), rows)
        fits = (
            all(type(number) is int and 0 < number < 1 << 16 for number in found.seen),
            0 < len({*found.seen}) == len(found.seen) <= MOST_COLOURS,
            all(row.action in found.actions and len(row.objects) <= 2 for row in rows),
            {name for row in rows for name in row.objects} <= {*found.objects},
            bool(rows),
        )
        if not all(fits):
            raise ValueError("the numbers of classes, actions, objects and instructions do not fit")
        return found

    @cached_property
    def palette(self) -> NDArray[np.uint8]:
        """(65536,) the number of each class number of a mask."""
        found = np.zeros(1 << 16, np.uint8)
        found[list(self.seen)] = np.arange(1, len(self.seen) + 1, dtype=np.uint8)
        return found

    @cached_property
    def rows(self) -> NDArray[np.int64]:
        """(I, 3) the numbers of each instruction's action and objects."""
        return np.array([self.numbers(each) for each in self.instructions], np.int64)

    def numbers(self, done: Instruction) -> tuple[int, int, int]:
        """The numbers of an instruction; -1 for an action, and for an object, that training never had."""
        names = [self._objects.get(name, -1) for name in done.objects]
        first, second = (*names, NOTHING, NOTHING)[:2]
        return self._actions.get(done.action, -1), first, second

    @cached_property
    def _actions(self) -> dict[str, int]:
        return {name: number for number, name in enumerate(self.actions)}

    @cached_property
    def _objects(self) -> dict[str, int]:
        return {name: number for number, name in enumerate(self.objects, 1)}


def frames_of(clips: Clips, which: Sequence[int], labels: Labels, taken: Iterable[int]) -> NDArray[np.uint8]:
    """(N, K, H, W) palette numbers of some frames of some clips."""
    places = list(taken)
    chosen = [clips.clips[number] for number in which]
    return np.stack([labels.palette[clips.films[each.film][[each.first + n for n in places]]] for each in chosen])
