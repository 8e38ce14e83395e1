"""What splits depend on, by column: hundreds of thousands of programs and their runs take some bytes each."""

from __future__ import annotations

from array import array
from bisect import bisect_left
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from hearth.datasets.format.near_duplicates import near_sequences, near_texts

NEAR = 0.9
"""Normalised LCS of steps, or similarity of texts, from which two programs are near duplicates."""

SHORTEST_TEXT = 20
"""Least characters of a description that is compared: short ones such as `Watch TV.` coincide by chance."""

PARTS = ("train", "validation", "test")
"""The parts of `activities`, which is `programs.split`; of near duplicates, those in earlier parts are left out."""

NOTHING = -1
"""The number of steps or a text that is not compared, of a part that there is not, and of no parent."""

BATCH = 65_536
"""Runs that are held as Python values at a time."""

Run = tuple[str, str, str]
"""Execution id, program id and home of an execution that ran to its end."""

Pairs = Callable[[Sequence[Any], float], Iterable[tuple[int, int]]]


@dataclass(frozen=True, slots=True)
class SplitProgram:
    """The fields of a program that splits depend on.

    Attributes:
        program_id: its id.
        activity: its activity.
        part: one of `PARTS`, assigned by activity; or "".
        parent: id of the program that it was made of; None for an original.
        steps: action and class names, one element per step, without instances.
        description: its text.
    """

    program_id: str
    activity: str
    part: str
    parent: str | None
    steps: Sequence[Hashable]
    description: str


def normalised(text: str) -> str:
    """A text in lower case with single spaces."""
    return " ".join(text.lower().split())


@dataclass(frozen=True, eq=False)
class Near:
    """Near duplicates among the values of programs.

    Attributes:
        numbers: (programs,) number of each program's value, `NOTHING` where it is not compared.
        one, other: (pairs,) numbers of similar values, each pair both ways.
        count: number of different values.
    """

    numbers: NDArray[np.int32]
    one: NDArray[np.int32]
    other: NDArray[np.int32]
    count: int

    @classmethod
    def of(cls, numbers: NDArray[np.int32], values: Sequence[Any], pairs: Pairs) -> Near:
        """The near duplicates, at least `NEAR`, among values that numbers stand for."""
        one, other = array("i"), array("i")
        for a, b in pairs(values, NEAR):
            one.extend((a, b))
            other.extend((b, a))
        return cls(numbers, np.array(one, np.int32), np.array(other, np.int32), len(values))

    def around(self, programs: NDArray[Any]) -> NDArray[np.bool_]:
        """(values,) which values those of some programs, given by their places, are similar or equal to."""
        mine = np.zeros(self.count + 1, bool)
        mine[self.numbers[programs]] = True
        mine[NOTHING] = False
        return self.like(mine)

    def like(self, values: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """(values,) which values are similar or equal to some."""
        found = values.copy()
        found[self.other[values[self.one]]] = True
        return found

    def among(self, values: NDArray[np.bool_], programs: NDArray[Any]) -> NDArray[np.bool_]:
        """Which of some programs have one of some values; `values` as `around` gives them."""
        found: NDArray[np.bool_] = values[self.numbers[programs]]
        return found


class _Numbers:
    """Numbers of different values, in the order in which they come."""

    def __init__(self) -> None:
        self.known: dict[Any, int] = {}
        self.numbers = array("i")

    def add(self, value: Any, compared: bool) -> None:
        self.numbers.append(self.known.setdefault(value, len(self.known)) if compared else NOTHING)


@dataclass(frozen=True, eq=False)
class SplitPrograms:
    """Programs by column, in the order of their ids; `place` is a program's position.

    Attributes:
        ids: of the programs, and of the originals that are not among them.
        known: (ids,) which of them are among the programs.
        root: (ids,) place of the original, or its own.
        part: (ids,) position in `PARTS` of the part by activity.
        steps, texts: near duplicates by steps and by description.
    """

    ids: list[str]
    known: NDArray[np.bool_]
    root: NDArray[np.int32]
    part: NDArray[np.int8]
    steps: Near
    texts: Near

    @classmethod
    def of(cls, programs: Iterable[SplitProgram]) -> SplitPrograms:
        """The columns of programs in any order; they are read once."""
        ids, parts, parents = list[str](), array("b"), list[str | None]()
        steps, texts = _Numbers(), _Numbers()
        for each in programs:
            ids.append(each.program_id)
            parents.append(each.parent)
            parts.append(PARTS.index(each.part) if each.part else NOTHING)
            steps.add(each.steps, bool(each.steps))
            text = normalised(each.description)
            texts.add(text, len(text) >= SHORTEST_TEXT)
        names, order, above = _in_order(ids, parents)
        near = (
            Near.of(_sorted(steps.numbers, order), list(steps.known), near_sequences),
            Near.of(_sorted(texts.numbers, order), list(texts.known), near_texts),
        )
        return cls(names, order < len(ids), _roots(above), _sorted(parts, order), *near)

    def place(self, program_id: str) -> int:
        """The place of a program.

        Raises:
            KeyError: the program is unknown.
        """
        found = bisect_left(self.ids, program_id)
        if found == len(self.ids) or self.ids[found] != program_id:
            raise KeyError(program_id)
        return found

    def places(self) -> NDArray[np.int64]:
        """The places of all programs."""
        return np.flatnonzero(self.known)


def _in_order(ids: list[str], parents: list[str | None]) -> tuple[list[str], NDArray[np.int64], NDArray[np.int32]]:
    """Ids and parents that are none of them, in order; where each was; the place of each one's parent, or `NOTHING`."""
    place = {name: number for number, name in enumerate(ids)}
    for parent in parents:
        if parent is not None:
            place.setdefault(parent, len(place))
    names = list(place)
    order = np.array(sorted(range(len(names)), key=names.__getitem__), np.int64)
    at = np.empty(len(names), np.int32)
    at[order] = np.arange(len(names))
    above = np.full(len(names), NOTHING, np.int32)
    above[: len(ids)] = [NOTHING if parent is None else at[place[parent]] for parent in parents]
    return [names[k] for k in order], order, above[order]


def _sorted(column: array[int], order: NDArray[np.int64]) -> NDArray[Any]:
    """A column in an order, with `NOTHING` for what it does not have."""
    values = np.array(column)
    return np.concatenate([values, np.full(len(order) - len(values), NOTHING, values.dtype)])[order]


def _roots(above: NDArray[np.int32]) -> NDArray[np.int32]:
    """The last of the places above each, or its own."""
    root = np.where(above == NOTHING, np.arange(len(above), dtype=np.int32), above)
    while not np.array_equal(higher := root[root], root):
        root = higher
    return root


class Runs(Iterable[Run]):
    """Executions that ran to their ends, sorted by id, by column; read as often as one likes."""

    def __init__(self, runs: Iterable[Run]) -> None:
        schema = pa.schema(
            [("execution_id", pa.large_string()), ("program_id", pa.large_string()), ("home", pa.string())]
        )
        found, values = list[pa.RecordBatch](), iter(runs)
        while some := list(islice(values, BATCH)):
            columns = [
                pa.array(column, each.type) for column, each in zip(zip(*some, strict=True), schema, strict=True)
            ]
            found.append(pa.record_batch(columns, schema=schema))
        table = pa.Table.from_batches(found, schema)
        self._table = table.sort_by([(name, "ascending") for name in schema.names])
        self.homes: list[str] = sorted(self._table["home"].unique().to_pylist())

    def __iter__(self) -> Iterator[Run]:
        for batch in self._table.to_batches(BATCH):
            yield from zip(*(column.to_pylist() for column in batch.columns), strict=True)
