"""Executions that ran to their ends, by column: the rows of splits are made of them, millions in all."""

from array import array
from collections.abc import Iterable, Iterator

import numpy as np

from hearth.datasets.format.compact_texts import Texts
from hearth.datasets.format.split_columns import SplitPrograms

Run = tuple[str, str, str]
"""Execution id, program id and home of an execution that ran to its end."""


class Runs(Iterable[tuple[str, int, str]]):
    """The id of each run, the place of its program, and its home, in the order of the ids; read as often as one likes.

    Attributes:
        homes: names of the homes, in order.

    Args:
        programs: all published programs.
        runs: in any order, each id once.
    """

    def __init__(self, programs: SplitPrograms, runs: Iterable[Run]) -> None:
        self._ids, self._places, self._homes = Texts(), array("i"), array("i")
        names: dict[str, int] = {}
        for execution_id, program_id, home in runs:
            self._ids.append(execution_id)
            self._places.append(programs.place(program_id))
            self._homes.append(names.setdefault(home, len(names)))
        self._order = self._ids.order().astype(np.int32)  # a sorted copy would be as large as all else here
        self._names = [*names]
        self.homes = sorted(names)

    def __iter__(self) -> Iterator[tuple[str, int, str]]:
        for row in self._order.data:
            yield self._ids[row], self._places[row], self._names[self._homes[row]]
