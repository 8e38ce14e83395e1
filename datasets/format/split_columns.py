"""The inputs of splits, by column: hundreds of thousands of programs and their runs take some bytes each."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass
from heapq import merge
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.datasets.format.compact_texts import Letters, Texts
from hearth.datasets.format.near_duplicates import near_sequences, near_texts

NEAR = 0.9
"""Normalised LCS of steps, or similarity of texts, from which two programs are near duplicates."""

SHORTEST_TEXT = 20
"""Least characters of a description that is compared: short ones such as `Watch TV.` coincide by chance."""

PARTS = ("train", "validation", "test")
"""The parts of `activities`, which is `programs.split`; of near duplicates, those in earlier parts are left out."""

NOTHING = -1
"""The number of steps or a text that is not compared, of a part that there is not, and of no parent."""

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
    """Return a text in lower case with single spaces."""
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
        """Return the near duplicates, at least `NEAR`, among values that numbers stand for."""
        one, other = array("i"), array("i")
        for a, b in pairs(values, NEAR):
            one.extend((a, b))
            other.extend((b, a))
        return cls(numbers, np.array(one, np.int32), np.array(other, np.int32), len(values))

    def around(self, programs: NDArray[Any]) -> NDArray[np.bool_]:
        """Return (values,) which values those of some programs, given by their places, are similar or equal to."""
        mine = np.zeros(self.count + 1, bool)
        mine[self.numbers[programs]] = True
        mine[NOTHING] = False
        return self.like(mine)

    def like(self, values: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return (values,) which values are similar or equal to some."""
        found = values.copy()
        found[self.other[values[self.one]]] = True
        return found

    def among(self, values: NDArray[np.bool_], programs: NDArray[Any]) -> NDArray[np.bool_]:
        """Return whether each of some programs has one of some values; `values` as `around` gives them."""
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

    ids: Texts
    known: NDArray[np.bool_]
    root: NDArray[np.int32]
    part: NDArray[np.int8]
    steps: Near
    texts: Near

    @classmethod
    def of(cls, programs: Iterable[SplitProgram]) -> SplitPrograms:
        """Return the columns of programs in any order; they are read once. Of programs with one id the first counts."""
        ids, parts, parents = Texts(), array("b"), _Numbers()
        letters, steps, texts = Letters(), Texts(), _Numbers()
        for each in programs:
            ids.append(each.program_id)
            parents.add(each.parent, each.parent is not None)
            parts.append(PARTS.index(each.part) if each.part else NOTHING)
            steps.append(letters.text(each.steps))
            text = normalised(each.description)
            texts.add(text, len(text) >= SHORTEST_TEXT)
        names, rows = _in_order(ids, parents.known)
        root = _roots(_above(names, rows, parents))
        del ids, parents  # together all columns would be the peak of memory
        numbers, different = _different(steps)
        del steps
        near = Near.of(_taken(numbers, rows), different, near_sequences)
        del different
        near_by_text = Near.of(_taken(texts.numbers, rows), [*texts.known], near_texts)
        return cls(names, rows != NOTHING, root, _taken(parts, rows), near, near_by_text)

    def place(self, program_id: str) -> int:
        """Return the place of a program.

        Raises:
            KeyError: the program is unknown.
        """
        found = self.ids.find(program_id)
        if found is None:
            raise KeyError(program_id)
        return found


def _in_order(ids: Texts, parents: Iterable[str]) -> tuple[Texts, NDArray[np.int32]]:
    """Different ids and parents in order; the first row of each, or `NOTHING`."""
    names, rows = Texts(), array("i")
    last = None
    mine = ((ids[row], row) for row in ids.order().data)
    for name, row in merge(mine, ((parent, NOTHING) for parent in sorted(parents)), key=itemgetter(0)):
        if name != last:  # of equal names, `merge` gives those of rows first
            names.append(name)
            rows.append(row)
            last = name
    return names, np.array(rows, np.int32)


def _above(names: Texts, rows: NDArray[np.int32], parents: _Numbers) -> NDArray[np.int32]:
    """Return the place of the parent of each name, or `NOTHING`."""
    places = np.array([*map(names.find, parents.known), NOTHING], np.int32)
    above: NDArray[np.int32] = places[_taken(parents.numbers, rows)]  # the last one is that of the number `NOTHING`
    return above


def _different(texts: Texts) -> tuple[NDArray[np.int32], Texts]:
    """Return the number of each text among the different ones, or `NOTHING` for an empty one; and these.

    A table of all of them would take more memory than they do: equal ones follow each other in order.
    """
    numbers, different = np.full(len(texts), NOTHING, np.int32), Texts()
    last = ""
    for place in texts.order().data:
        text = texts[place]
        if text != last:
            different.append(text)
            last = text
        numbers[place] = len(different) - 1
    return numbers, different


def _taken(column: array[int] | NDArray[Any], rows: NDArray[np.int32]) -> NDArray[Any]:
    """Return a column's values in some rows, `NOTHING` in the row `NOTHING`."""
    values = np.append(np.array(column), np.array([NOTHING], np.array(column).dtype))
    return values[rows]


def _roots(above: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return the last of the places above each, or its own."""
    root = np.where(above == NOTHING, np.arange(len(above), dtype=np.int32), above)
    while not np.array_equal(higher := root[root], root):
        root = higher
    return root
