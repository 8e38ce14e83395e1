"""Demonstrations of a published dataset: which executions have one, and their pictures from above as arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.models.films.film_arrays import CHANGES, LARGEST, MASKS, damaged, film_array
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import Program
from hearth.storage.input_files import read_input
from hearth.storage.names import inside

if TYPE_CHECKING:
    from hearth.datasets.dataset import Dataset
    from hearth.models.text_examples import Example

FILE = "above.npz"
"""Name of a demonstration's arrays in its folder."""

MOST_PICTURES = 2_000
"""Pictures of a demonstration at most; it has one for each tick, and programs of people have less than a hundred ticks.
"""

MOST_CLASSES = 2_048
"""Classes in pictures at most: each is looked at by itself. The knowledge has some hundreds."""


class Pictures(NamedTuple):
    """T pictures from above, at the start and after each tick.

    Attributes:
        masks: (T, H, W) class numbers.
        colours: (T, H, W, 3).
    """

    masks: NDArray[np.uint16]
    colours: NDArray[np.uint8]


@dataclass(frozen=True)
class Demonstrations:
    """The demonstrations of a dataset.

    Attributes:
        dataset: where they are.
        files: of each execution that has one.
        person: class number of people in masks.
    """

    dataset: Dataset
    files: Mapping[str, str]
    person: int

    @classmethod
    def of(cls, dataset: Dataset) -> Demonstrations:
        """Return all that a dataset has.

        Raises:
            HearthError: UNKNOWN_ID, if there are none.
        """
        rows = dataset.rows("SELECT DISTINCT execution_id, file FROM demonstration_frames ORDER BY 1")[1]
        if not rows:
            message = "the dataset has no demonstrations"
            raise HearthError.of(Code.UNKNOWN_ID, message, file=str(dataset.folder),
                                 suggestion="`make demos`, or `build --demonstrations N`, makes some")  # fmt: skip
        if any(None in row for row in rows):
            raise damaged("demonstration_frames", "a row lacks its execution or its file")
        return cls(dataset, dict(rows), dataset.knowledge.objects["character"].id)

    def of_example(self, example: Example) -> str:
        """Return the execution of an example's program that has a demonstration; "" if none has."""
        return next((name for name in example.executions if name in self.files), "")

    def pictures(self, execution: str) -> Pictures:
        """Return the pictures of an execution.

        Raises:
            HearthError: DAMAGED_FILE, if its arrays differ from the table's facts.
        """
        file = self.files[execution]
        return arrays(read_input(inside(self.dataset.folder, file), LARGEST), file)

    def pictures_of(self, example: Example, execution: str) -> Pictures:
        """Return the pictures of an example's execution, to learn the steps between them.

        Raises:
            HearthError: DAMAGED_FILE, as of `pictures`, or if they are not one more than the ticks of the program, or
                the sketch has flags for fewer or more steps than the program has.
        """
        flags, steps = len(example.keep), len(example.steps)
        if flags not in (0, steps):
            message = f"the sketch of `{example.program_id}` has {flags:,} flags, its program {steps:,} steps"
            remedy = "correct its annotation, a flag for each step, or leave it out, and build the dataset again"
            raise HearthError.of(Code.DAMAGED_FILE, message, file=str(self.dataset.folder), suggestion=remedy)
        found, ticks = self.pictures(execution), len([*Program(steps=example.steps).ticks()])
        if (count := len(found.masks)) != ticks + 1:
            message = f"it has {count:,} pictures of {ticks:,} ticks, not one at the start and one after each tick"
            raise damaged(self.files[execution], message)
        return found


def read_pictures(path: Path) -> Pictures:
    """Return the pictures of a file, or of a folder with one.

    Raises:
        HearthError: MISSING_FILE; DAMAGED_FILE, if the file holds something else.
    """
    file = path / FILE if path.is_dir() else path
    return arrays(read_input(file, LARGEST), str(file))


def is_demonstration(text: str) -> bool:
    """Return whether an argument names pictures from above: their file, or a folder with one."""
    try:
        path = Path(text)
        return bool(text) and (path.name == FILE or (path / FILE).is_file())
    except (OSError, ValueError):  # a long text, or one with a null, names nothing
        return False


def arrays(data: bytes, file: str) -> Pictures:
    """Return the pictures of an .npz file as `rendering.film.pictures_from_above` stores them.

    Raises:
        HearthError: as of `film_array`.
    """
    masks, changes = (film_array(BytesIO(data), file, array, MOST_PICTURES) for array in (MASKS, CHANGES))
    if changes.shape != (*masks.shape, 3):
        message = f"its {CHANGES} have the form {changes.shape}, its {MASKS} {masks.shape}"
        raise damaged(file, message)
    shown = np.zeros(1 << 16, np.bool_)
    for mask in masks:
        shown[mask] = True
    if (count := np.count_nonzero(shown)) > MOST_CLASSES:
        raise damaged(file, f"its {MASKS} have {count:,} classes, more than {MOST_CLASSES:,}")
    return Pictures(masks, np.cumsum(changes, axis=0, dtype=np.uint8))


def shown(demonstrations: Demonstrations, examples: Sequence[Example]) -> list[tuple[Example, str]]:
    """Return the examples that have a demonstration, with its execution."""
    found = ((each, demonstrations.of_example(each)) for each in examples)
    return [(each, name) for each, name in found if name]
