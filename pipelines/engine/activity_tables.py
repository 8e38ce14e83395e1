"""Activities and descriptions, gathered from the ingested records and the published programs."""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from itertools import islice

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from hearth.datasets.format.compact_texts import Texts
from hearth.datasets.format.ids import activity_id
from hearth.schemas.published_rows import ActivityRow, DescriptionRow, ProgramRow
from hearth.schemas.stage_rows import IngestedRow
from hearth.schemas.tables import TABLES
from hearth.storage.batch_sizes import DESCRIPTIONS_SORTED

COUNTED = ["activity_id", "title", "parent_id", "description_id"]
"""The columns of programs that are counted."""

_WORDS = [name for name in DescriptionRow.__annotations__ if name not in ("activity_id", "programs")]
"""The columns of descriptions that ingested rows have."""

_DESCRIBING = ("program", "description")
"""The kinds of ingested rows that have a description."""

Ingested = Callable[[list[str]], Iterable[IngestedRow]]
"""Gives some columns of the ingested rows, in their order; called twice."""


@dataclass(slots=True)
class _Activity:
    titles: Counter[str] = field(default_factory=Counter)
    scenes: set[str] = field(default_factory=set)
    descriptions: int = 0
    programs: int = 0


class Activities:
    """The rows of both tables.

    Args:
        ingested: the ingested rows.
        programs: the published programs, with the columns `COUNTED`.
    """

    def __init__(self, ingested: Ingested, programs: Iterable[ProgramRow]) -> None:
        self._activities: dict[str, _Activity] = {}
        names, rows = _descriptions(ingested(["kind", "description_id"]))
        self._words = _words(ingested(_WORDS), np.sort(rows))
        self._order = np.searchsorted(np.sort(rows), rows)
        self._programs = np.zeros(len(names), np.int32)
        for program in programs:
            self._count(program, names)
        for row in self._described():
            self._gather(row)

    def _activity(self, name: str) -> _Activity:
        return self._activities.setdefault(name, _Activity())

    def _count(self, program: ProgramRow, names: Texts) -> None:
        """Count a program under its activity and, if it is an original, its description."""
        activity = self._activity(program["activity_id"])
        activity.programs += 1
        activity.titles[program["title"]] += 1
        if program["parent_id"] is None:
            place = names.find(program["description_id"])
            if place is not None:
                self._programs[place] += 1

    def _described(self) -> Iterator[DescriptionRow]:
        """Yield the descriptions in the order of their ids, without the number of their programs."""
        for start in range(0, len(self._order), DESCRIPTIONS_SORTED):  # a sorted copy of all would be as large again
            yield from self._words.take(pa.array(self._order[start : start + DESCRIPTIONS_SORTED])).to_pylist()

    def _gather(self, row: DescriptionRow) -> None:
        """Count a description under its activity."""
        activity = self._activity(activity_id(row["title"]))
        activity.descriptions += 1
        activity.titles[row["title"]] += 1
        if row["scene"]:
            activity.scenes.add(row["scene"])

    def activity_rows(self) -> Iterator[ActivityRow]:
        """Yield the activities in the order of their ids."""
        for name, activity in sorted(self._activities.items()):
            title = min(activity.titles, key=lambda title: (-activity.titles[title], title))
            yield {
                "activity_id": name,
                "title": title,
                "scenes": sorted(activity.scenes),
                "descriptions": activity.descriptions,
                "programs": activity.programs,
            }

    def description_rows(self) -> Iterator[DescriptionRow]:
        """Yield the descriptions in the order of their ids."""
        for row, programs in zip(self._described(), self._programs.data, strict=True):
            yield {**row, "activity_id": activity_id(row["title"]), "programs": programs}


def _descriptions(ingested: Iterable[IngestedRow]) -> tuple[Texts, NDArray[np.int64]]:
    """Return the ids of descriptions in order, and the number of the ingested row of each: the first that is its own,
    or, if
    none is, the first copy that came with a program."""
    ids, own, numbers = Texts(), array("b"), array("q")
    for number, row in enumerate(ingested):
        if row["kind"] in _DESCRIBING:
            ids.append(row["description_id"])
            own.append(row["kind"] == "description")
            numbers.append(number)
    names, chosen, last = Texts(), array("q"), None
    for row_of_id in ids.order().data:
        name = ids[row_of_id]
        if name != last:
            names.append(name)
            chosen.append(row_of_id)
            last = name
        elif own[row_of_id] and not own[chosen[-1]]:
            chosen[-1] = row_of_id
    return names, np.array(numbers, np.int64)[np.array(chosen, np.int64)]


def _words(ingested: Iterable[IngestedRow], numbers: NDArray[np.int64]) -> pa.Table:
    """Return the words of the ingested rows of some numbers, which are in order."""
    schema = pa.schema([TABLES["descriptions"].field(name) for name in _WORDS])
    kept: list[pa.RecordBatch] = []
    rows = _numbered(ingested, numbers)
    while share := list(islice(rows, DESCRIPTIONS_SORTED)):
        kept.append(pa.RecordBatch.from_pylist(share, schema))
    return pa.Table.from_batches(kept, schema)


def _numbered(rows: Iterable[IngestedRow], numbers: NDArray[np.int64]) -> Iterator[IngestedRow]:
    """Yield the rows of some numbers, which are in order."""
    waiting = iter(numbers.data)
    next_one = next(waiting, None)
    for number, row in enumerate(rows):
        if number == next_one:
            yield row
            next_one = next(waiting, None)
