"""The part of every program in the split by activity, known before any is published: each part has its own files."""

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from hearth.datasets.format import splits
from hearth.datasets.format.ids import activity_id, split_of

_COLUMNS = ("program_id", "parent_id", "title", "description")


@dataclass(frozen=True, slots=True)
class Assignment:
    """Programs, near duplicates among them, and the part of each."""

    programs: list[splits.SplitProgram]
    similarity: splits.Similarity
    part_of: dict[str, str | None]


def assignment(files: list[Path], seed: int) -> Assignment:
    """The assignment of the programs of cases; `seed` is that of the build.

    Args:
        files: Parquet files of cases (`tables.CASE`), in any order; a program may have several cases.
        seed: of the build.
    """
    programs = sorted(_programs(files, seed), key=lambda each: each.program_id)
    similarity = splits.Similarity(programs)
    return Assignment(programs, similarity, splits.by_activity(programs, similarity))


def _programs(files: list[Path], seed: int) -> list[splits.SplitProgram]:
    columns: dict[str, list[Any]] = {name: [] for name in _COLUMNS}
    steps: list[tuple[str, ...]] = []
    # Augmented programs share most of their values, which are kept once.
    same: dict[Any, Any] = {}
    known: dict[str, tuple[Path, int]] = {}
    for path in files:
        with pq.ParquetFile(path) as file:
            table = file.read([*_COLUMNS, "steps"])
        names = enumerate(table["program_id"].to_pylist())
        new = [row for row, name in names if known.setdefault(name, (path, row)) == (path, row)]
        table = table.take(pa.array(new, pa.int64()))
        steps.extend(same.setdefault(each, each) for each in _step_names(table["steps"].combine_chunks()))
        for name, values in columns.items():
            values.extend(same.setdefault(each, each) for each in table[name].to_pylist())
    tops = splits.roots(dict(zip(columns["program_id"], columns["parent_id"], strict=True)))
    rows = zip(columns["program_id"], map(activity_id, columns["title"]), columns["description"], steps, strict=True)
    return [splits.SplitProgram(name, of, split_of(of, seed), tops[name], mine, text) for name, of, text, mine in rows]


def _step_names(steps: pa.ListArray) -> Iterator[tuple[str, ...]]:
    """For each program its steps as action and class names; by columns, because there are hundreds of thousands."""
    every = steps.flatten()
    actions, objects = every.field("action"), every.field("objects")
    names = pa.ListArray.from_arrays(objects.offsets, objects.values.field("name"))
    texts = [
        sys.intern(text) for text in pc.binary_join_element_wise(actions, pc.binary_join(names, " "), " ").to_pylist()
    ]
    end = 0
    for length in pc.list_value_length(steps).to_pylist():
        yield tuple(texts[end : end + length])
        end += length
