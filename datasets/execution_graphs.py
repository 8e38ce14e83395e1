"""Executions with their start and end graphs, many at a time: for iteration, and for torch's `DataLoader`."""

from __future__ import annotations

import gc
import os
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.row_conversion import Bindings, program_of
from hearth.datasets.format.stored_cases import stored_cases
from hearth.datasets.tensors import GraphSample, Tensors, to_tensors
from hearth.schemas.call_errors import explained
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.program import Program
from hearth.schemas.short_repr import brief

SHARE = 128
"""Executions that iteration reads together."""

_INHERITED: list[Any] = []
"""Datasets of the process that this one was forked from.

To close their connections would wait for threads of DuckDB that the fork left behind, so they stay to the end. Datasets
that the fork had dropped, but not collected, stay, too.
"""

if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=gc.freeze)


class GraphPair(NamedTuple):
    """An execution: its id, its program with the node of each object, and the graphs before and after it."""

    execution_id: str
    program: Program
    bound: Bindings
    start: EnvironmentGraph
    final: EnvironmentGraph

    def __repr__(self) -> str:
        return brief(self)


class ExecutionGraphs(Sequence[GraphPair]):
    """Executions of a dataset with their graphs: a sequence, and a map-style dataset of torch (not imported).

    Each process opens the dataset anew, so that workers of a `DataLoader` share no connection.

    Args:
        dataset: the dataset.
        ids: of executions; by default all of which `dataset` has the runs.

    Examples:
        >>> pairs = hearth.ExecutionGraphs(hearth.load(folder))
        >>> len(pairs) > 1, {pair.start == pair.final for pair in pairs}
        (True, {False})
        >>> start, final = pairs.collate(pairs[:2])  # torch: DataLoader(pairs, 32, collate_fn=pairs.collate)
        >>> len(start.lengths), final.node_states.shape[1]
        (2, 10)
    """

    @explained
    def __init__(self, dataset: Dataset, ids: Iterable[str] | None = None) -> None:
        query = f"SELECT execution_id FROM executions WHERE {dataset.included} ORDER BY 1"
        self.folder = dataset.folder
        self.ids = [name for (name,) in dataset.rows(query)[1]] if ids is None else list(ids)
        self._opened: tuple[int, Dataset] | None = None

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_opened": None}

    def __repr__(self) -> str:
        return f"ExecutionGraphs({str(self.folder)!r}, {len(self.ids):,} executions)"

    def __len__(self) -> int:
        return len(self.ids)

    def __getitem__(self, place: Any) -> Any:
        """Return the execution at a place, or those of a slice."""
        found = self.ids[place]
        return self._read(found) if isinstance(place, slice) else self._read([found])[0]

    def __getitems__(self, places: Sequence[int]) -> list[GraphPair]:
        """Return the executions at several places, read together; `DataLoader` asks for its batches this way."""
        return self._read([self.ids[place] for place in places])

    def __iter__(self) -> Iterator[GraphPair]:
        """All, in the order of their ids; the next ones are read when they are needed."""
        for first in range(0, len(self), SHARE):
            yield from self[first : first + SHARE]

    def collate(self, pairs: Sequence[GraphPair]) -> tuple[Tensors, Tensors]:
        """Return the start graphs and the final graphs of a batch as arrays, each with the programs.

        The method fits `collate_fn`.
        """
        before = (GraphSample(pair.program, pair.start, pair.bound) for pair in pairs)
        after = (GraphSample(pair.program, pair.final, pair.bound) for pair in pairs)
        return to_tensors(before, self._dataset.vocabulary_ids), to_tensors(after, self._dataset.vocabulary_ids)

    @property
    def _dataset(self) -> Dataset:
        if self._opened is None or self._opened[0] != os.getpid():
            _INHERITED.append(self._opened)
            self._opened = os.getpid(), Dataset.open(self.folder)
        return self._opened[1]

    def _read(self, ids: Sequence[str]) -> list[GraphPair]:
        found = {}
        for row in stored_cases(self._dataset, ids, ("ticks",)) if ids else ():
            run = self._dataset.run_of(row)
            pair = GraphPair(row["execution_id"], program_of(row), run.bindings(), run.start, run.final)
            found[pair.execution_id] = pair
        return [found[name] for name in ids]
