"""Clips of a published dataset as arrays, and the numbers of what is seen and done in them."""

from __future__ import annotations

import sys
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
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
"""Number of no object."""

MASKS, COLOURS, CHANGES = "class_ids", "rgb", "rgb_changes"
"""Names of a film's arrays: class masks, which every film has, and colours; those of demonstrations are changes from
picture to picture."""

FORMS: Mapping[str, tuple[int, type[np.generic]]] = {
    MASKS: (3, np.uint16),
    COLOURS: (4, np.uint8),
    CHANGES: (4, np.uint8),
}
"""Dimensions and kind of numbers of a film's arrays."""

LARGEST = 64 << 20
"""Bytes of a film's file."""

MOST_BYTES = 1 << 29
"""Bytes of an array of a film in memory."""


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
        films: (T, H, W) uint16 class numbers, or (T, H, W, 3) uint8 colours, of each film's frames; a dataset's are
            read when they are asked for.
        clips: in the order of films and frames.
        frames: of a clip.
    """

    executions: tuple[str, ...]
    films: Sequence[NDArray[Any]]
    clips: tuple[Clip, ...]
    frames: int

    @classmethod
    def of(cls, dataset: Dataset, part: str, most: int = 0, *, array: str = MASKS, coloured: bool = False) -> Clips:
        """The clips of a part; of some films alone if `most` is given.

        Args:
            dataset: with clips.
            part: of the clips.
            most: films, at most; 0 for all.
            array: which of a film's arrays is read.
            coloured: only films that have colours, as all have if colours are read.

        Raises:
            HearthError: UNKNOWN_ID, if there are none; DAMAGED_FILE, when a film's arrays are not what rows say.
        """
        columns = "execution_id, file, first, frames, action, objects, kind, tick"
        where = "part = $part AND list_contains(modalities, $array)"
        query = f"SELECT {columns} FROM clips WHERE {where} ORDER BY execution_id, number"
        rows = dataset.rows(query, part=part, array=COLOURS if coloured else array)[1]
        if not rows:
            message = f"the dataset has no clips with `{array}` of the part `{part}`"
            raise HearthError.of(Code.UNKNOWN_ID, message, suggestion="`make clips` makes some")
        files = list(dict.fromkeys((row[0], row[1]) for row in rows))[: most or None]
        numbers = {execution: number for number, (execution, _) in enumerate(files)}
        found, least = [], [0] * len(files)
        for execution, _, first, frames, action, objects, kind, tick in rows:
            if execution in numbers:
                number = numbers[execution]
                least[number] = max(least[number], first + frames if first >= 0 else sys.maxsize)
                found.append(Clip(number, first, Instruction(action, tuple(objects)), kind, tick))
        films = Films(dataset, [(file, longest) for (_, file), longest in zip(files, least, strict=True)], array)
        return cls(tuple(execution for execution, _ in files), films, tuple(found), rows[0][3])

    def __len__(self) -> int:
        return len(self.clips)

    def by_film(self) -> Iterator[Clips]:
        """The clips of each film, with its masks alone."""
        for film, group in groupby(self.clips, key=lambda clip: clip.film):
            clips = tuple(clip._replace(film=0) for clip in group)
            yield Clips((self.executions[film],), [self.films[film]], clips, self.frames)


class Films(Sequence[NDArray[Any]]):
    """An array of each film, read when it is asked for: all of them would need gigabytes.

    Args:
        dataset: with clips.
        files: of each film, and the frames that it has at least.
        array: of `FORMS`.
    """

    def __init__(self, dataset: Dataset, files: Sequence[tuple[str, int]], array: str = MASKS) -> None:
        self.dataset, self.files, self.array = dataset, files, array

    def __len__(self) -> int:
        return len(self.files)

    @overload
    def __getitem__(self, number: int) -> NDArray[Any]: ...
    @overload
    def __getitem__(self, number: slice) -> Sequence[NDArray[Any]]: ...
    def __getitem__(self, number: int | slice) -> NDArray[Any] | Sequence[NDArray[Any]]:
        if isinstance(number, slice):
            return Films(self.dataset, self.files[number], self.array)
        file, least = self.files[number]
        found = film_array(BytesIO(read_input(inside(self.dataset.folder, file), LARGEST)), file, self.array)
        if len(found) < least:
            raise _damaged(file, "a clip is outside of its film")
        return found


def film_array(data: IO[bytes], file: str, array: str = MASKS) -> NDArray[Any]:
    """An array of a film, as `rendering.film.clips` stores them, in the form of `FORMS`; `file` names it in errors.

    Raises:
        HearthError: DAMAGED_FILE, if it is something else.
    """
    dimensions, kind = FORMS[array]
    try:
        with np.load(data, allow_pickle=False) as arrays:
            if arrays.zip.getinfo(f"{array}.npy").file_size > MOST_BYTES:
                raise ValueError(f"its {array} are too large")
            found: NDArray[Any] = arrays[array]
    except (ValueError, KeyError, AttributeError, OSError, EOFError, BadZipFile, zlib.error) as error:
        raise _damaged(file, str(error)[:100]) from error
    if found.ndim != dimensions or found.dtype != kind or not found.size:
        raise _damaged(file, f"its {array} have the form {found.shape} of {found.dtype}")
    return found


def _damaged(file: str, message: str) -> HearthError:
    return HearthError.of(Code.DAMAGED_FILE, message, file=file, suggestion="fetch the dataset again")


def no_programs(model: str) -> HearthError:
    """The error of a model of films that is asked for the program of a text or a sketch."""
    message = f"`{model}` is a model of films: it has no programs for texts or sketches"
    return HearthError.of(Code.BAD_ARGUMENT, message, suggestion="`model show M FILM` reads a film with it")
