"""Clips of a published dataset as arrays, and the numbers of what is seen and done in them."""

from __future__ import annotations

import sys
import zlib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from io import BytesIO
from itertools import groupby
from typing import IO, TYPE_CHECKING, Any, NamedTuple, overload
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.input_files import read_input
from hearth.storage.names import inside

if TYPE_CHECKING:
    from hearth.datasets.dataset import Dataset

NOTHING = 0
"""Number of what is not in the palette, and of no object."""

MOST_COLOURS = 255
"""Classes that a palette has numbers for."""

LARGEST = 64 << 20
"""Bytes of a film's file."""

MOST_BYTES = 1 << 29
"""Bytes of a film's masks in memory."""


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
        films: (T, H, W) uint16 class numbers of each film's frames; a dataset's are read when they are asked for.
        clips: in the order of films and frames.
        frames: of a clip.
    """

    executions: tuple[str, ...]
    films: Sequence[NDArray[np.uint16]]
    clips: tuple[Clip, ...]
    frames: int

    @classmethod
    def of(cls, dataset: Dataset, part: str, most: int = 0) -> Clips:
        """The clips of a part; of some films alone if `most` is given.

        Raises:
            HearthError: UNKNOWN_ID, if there are none; DAMAGED_FILE, when a film's arrays are not what rows say.
        """
        columns = "execution_id, file, first, frames, action, objects, kind, tick"
        query = f"SELECT {columns} FROM clips WHERE part = $part ORDER BY execution_id, number"
        rows = dataset.rows(query, part=part)[1]
        if not rows:
            message = f"the dataset has no clips of the part `{part}`"
            raise HearthError.of(Code.UNKNOWN_ID, message, suggestion="`make clips` makes some")
        files = list(dict.fromkeys((row[0], row[1]) for row in rows))[: most or None]
        numbers = {execution: number for number, (execution, _) in enumerate(files)}
        found, least = [], [0] * len(files)
        for execution, _, first, frames, action, objects, kind, tick in rows:
            if execution in numbers:
                number = numbers[execution]
                least[number] = max(least[number], first + frames if first >= 0 else sys.maxsize)
                found.append(Clip(number, first, Instruction(action, tuple(objects)), kind, tick))
        films = Films(dataset, [(file, longest) for (_, file), longest in zip(files, least, strict=True)])
        return cls(tuple(execution for execution, _ in files), films, tuple(found), rows[0][3])

    def __len__(self) -> int:
        return len(self.clips)

    def by_film(self) -> Iterator[Clips]:
        """The clips of each film, with its masks alone."""
        for film, group in groupby(self.clips, key=lambda clip: clip.film):
            clips = tuple(clip._replace(film=0) for clip in group)
            yield Clips((self.executions[film],), [self.films[film]], clips, self.frames)


class Films(Sequence[NDArray[np.uint16]]):
    """The masks of films, read when they are asked for: all of them would need gigabytes.

    Args:
        dataset: with clips.
        files: of each film, and the frames that it has at least.
    """

    def __init__(self, dataset: Dataset, files: Sequence[tuple[str, int]]) -> None:
        self.dataset, self.files = dataset, files

    def __len__(self) -> int:
        return len(self.files)

    @overload
    def __getitem__(self, number: int) -> NDArray[np.uint16]: ...
    @overload
    def __getitem__(self, number: slice) -> Sequence[NDArray[np.uint16]]: ...
    def __getitem__(self, number: int | slice) -> NDArray[np.uint16] | Sequence[NDArray[np.uint16]]:
        if isinstance(number, slice):
            return Films(self.dataset, self.files[number])
        file, least = self.files[number]
        masks = masks_in(BytesIO(read_input(inside(self.dataset.folder, file), LARGEST)), file)
        if len(masks) < least:
            raise _damaged(file, "a clip is outside of its film")
        return masks


def masks_in(data: IO[bytes], file: str) -> NDArray[np.uint16]:
    """(T, H, W) class numbers of a film's arrays, as `rendering.film.clips` stores them; `file` names them in errors.

    Raises:
        HearthError: DAMAGED_FILE, if they are something else.
    """
    try:
        with np.load(data, allow_pickle=False) as arrays:
            if arrays.zip.getinfo("class_ids.npy").file_size > MOST_BYTES:
                raise ValueError("its masks are too large")
            masks: NDArray[np.uint16] = arrays["class_ids"]
    except (ValueError, KeyError, AttributeError, OSError, EOFError, BadZipFile, zlib.error) as error:
        raise _damaged(file, str(error)[:100]) from error
    if masks.ndim != 3 or masks.dtype != np.uint16 or not masks.size:
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


WIDTH = 64
"""Of the pictures that a network of whole frames looks at."""

Pictures = Sequence[NDArray[np.uint8]]
"""(T, H, W) palette numbers of each film's frames, `WIDTH` wide."""


def pictures_of(clips: Clips, labels: Labels) -> Pictures:
    """The films of clips as a network of whole frames looks at them: of larger ones some pixels are left out."""
    return [_picture(film, labels) for film in clips.films]


def _picture(film: NDArray[np.uint16], labels: Labels) -> NDArray[np.uint8]:
    step = max(1, film.shape[2] // WIDTH)
    return labels.palette[film[:, step // 2 :: step, step // 2 :: step]]


def frames_of(clips: Clips, pictures: Pictures, which: Sequence[int], taken: Iterable[int]) -> NDArray[np.uint8]:
    """(N, K, H, W) palette numbers of some frames of some clips."""
    places = list(taken)
    chosen = [clips.clips[number] for number in which]
    return np.stack([pictures[each.film][[each.first + n for n in places]] for each in chosen])
