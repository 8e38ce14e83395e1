"""Clips of a published dataset as arrays: numbers of their frames and of their instructions."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from io import BytesIO
from itertools import groupby
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, overload

from numpy.typing import NDArray

from hearth.models.films.film_arrays import COLOURS, LARGEST, MASKS, damaged, film_array
from hearth.models.interface import Request, Steps
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.input_files import read_input
from hearth.storage.names import inside

if TYPE_CHECKING:
    from hearth.datasets.dataset import Dataset

NOTHING = 0
"""Number of no object."""


class Instruction(NamedTuple):
    """The instruction in the middle of a clip: an action and the classes of its objects."""

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
        """Return the clips of a part; of some films alone if `most` is given.

        Args:
            dataset: with clips.
            part: of the clips.
            most: films, at most; 0 for all.
            array: which of a film's arrays is read.
            coloured: only films that have colours, as all have if colours are read.

        Raises:
            HearthError: UNKNOWN_ID, if there are none; DAMAGED_FILE, when a film's arrays differ from the rows.
        """
        columns = "execution_id, file, first, frames, action, objects, kind, tick"
        where = "part = $part AND list_contains(modalities, $array)"
        query = f"SELECT {columns} FROM clips WHERE {where} ORDER BY execution_id, number"
        rows = dataset.rows(query, part=part, array=COLOURS if coloured else array)[1]
        if not rows:
            message = f"the dataset has no clips with `{array}` of the part `{part}`"
            raise HearthError.of(Code.UNKNOWN_ID, message, suggestion="`make clips` makes some")
        if any(None in row or row[3] < 1 or None in row[5] for row in rows):
            raise damaged("clips", "a row lacks a value, or has no frames")
        if len({row[3] for row in rows}) > 1:
            raise damaged("clips", "clips have different numbers of frames")
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
        """Yield the clips of each film, with its masks alone."""
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
            raise damaged(file, "a clip is outside of its film")
        return found


def no_programs(model: str) -> HearthError:
    """Return the error of a model of films that is asked for the program of a text or a sketch."""
    message = f"`{model}` is a model of films: it has no programs for texts or sketches"
    return HearthError.of(Code.BAD_ARGUMENT, message, suggestion="`model show M FILM` reads a film with it")


class OfFilms:
    """A trained model of films: it has no programs for requests.

    Attributes:
        name: of its checkpoints.
    """

    name: ClassVar[str]

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps]:
        """Refuse to write programs for requests.

        Raises:
            HearthError: BAD_ARGUMENT.
        """
        raise no_programs(self.name)
