"""The part of every program in the split by activity, known before any is published: each part has its own files."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
from numpy.typing import NDArray

from hearth.datasets.format import splits
from hearth.datasets.format.ids import activity_id, split_of
from hearth.datasets.format.split_columns import SplitProgram, SplitPrograms

_COLUMNS = ("program_id", "parent_id", "title", "description")


@dataclass(frozen=True, slots=True, eq=False)
class Assignment:
    """Programs, and the position in `PARTS` of the part of each."""

    programs: SplitPrograms
    parts: NDArray[np.int8]

    def part_of(self, program_id: str) -> str | None:
        """Return the part of a program in `activities`."""
        return splits.part_name(int(self.parts[self.programs.place(program_id)]))


def assignment(files: list[Path], seed: int) -> Assignment:
    """Return the assignment of the programs of cases; `seed` is that of the build.

    Args:
        files: Parquet files of cases (`tables.CASE`), in any order; a program may have several cases.
        seed: of the build.
    """
    programs = SplitPrograms.of(programs_of(files, seed))
    return Assignment(programs, splits.by_activity(programs, splits.groups(programs)))


def programs_of(files: list[Path], seed: int) -> Iterator[SplitProgram]:
    """Yield each program of cases, once a file; its steps are a text with a character for each action and its classes.

    The texts of one call are alike where actions and classes are; those of two calls do not compare.

    Args:
        files, seed: as of `assignment`.
    """
    letters: dict[str, str] = {}
    for path in files:
        with pq.ParquetFile(path) as file:
            table = file.read([*_COLUMNS, "steps"])
        names = table["program_id"].to_pylist()
        first = {name: row for row, name in reversed([*enumerate(names)])}
        table = table.take(pa.array(sorted(first.values()), pa.int64()))
        steps = _steps(table["steps"].combine_chunks(), letters)
        columns = (table[name].to_pylist() for name in _COLUMNS)
        for program_id, parent_id, title, text, mine in zip(*columns, steps, strict=True):
            of = activity_id(title)
            yield SplitProgram(program_id, of, split_of(of, seed), parent_id, mine, text)


def _steps(steps: pa.ListArray, letters: dict[str, str]) -> Iterator[str]:
    """Yield the steps of each program; by columns, because there are hundreds of thousands of programs."""
    every = steps.flatten()
    actions, objects = every.field("action"), every.field("objects")
    names = pa.ListArray.from_arrays(objects.offsets, objects.values.field("name"))
    texts = pc.binary_join_element_wise(actions, pc.binary_join(names, " "), " ").to_pylist()
    written = [letters.setdefault(text, chr(_FIRST + len(letters))) for text in texts]
    end = 0
    for length in pc.list_value_length(steps).to_pylist():
        yield "".join(written[end : end + length])
        end += length


_FIRST = 0xE000
"""First code point after the surrogates, which are not characters; leaves a million different steps."""
