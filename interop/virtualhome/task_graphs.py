"""Scene graphs in files of VirtualHome 2.x, Watch-And-Help, O-WAH and C-WAH: JSON, or pickles of plain values."""

from __future__ import annotations

import io
import pickle
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import orjson

from hearth.homes.node_defaults import filled
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph, from_release
from hearth.schemas.graph_wrappers import graph_in
from hearth.storage.input_files import read_input

PICKLES = (".pik", ".pkl", ".pickle")
"""Endings of the task files of Watch-And-Help and the sets after it."""

MOST_TASKS = 2_000
"""Tasks of a file that are read."""


class _PlainUnpickler(pickle.Unpickler):
    """Reads lists, dicts, texts and numbers; every class and function is refused, so that no code runs."""

    def find_class(self, module: str, name: str) -> Any:
        raise pickle.UnpicklingError(f"it holds an object of {module[:40]}.{name[:40]}")


def task_graphs(path: Path, knowledge: Knowledge) -> Iterator[tuple[str, EnvironmentGraph]]:
    """Yield the name and the graph of each home of a file; of equal graphs of one home number the first.

    Raises:
        HearthError: BAD_JSON, BAD_GRAPH, or every fault of a graph.
    """
    value = _value(path)
    rows = value if isinstance(value, list) and graph_in(value) is None else [value]
    seen: set[tuple[Any, bytes]] = set()
    found = 0
    for number, row in enumerate(rows[:MOST_TASKS]):
        graph = graph_in(row)
        if graph is None:
            continue
        found += 1
        home = row.get("env_id") if isinstance(row, dict) else None
        mark = (home, orjson.dumps(graph["nodes"], default=str))
        if mark in seen or (home is not None and any(each[0] == home for each in seen)):
            continue
        seen.add(mark)
        name = path.stem if len(rows) == 1 else f"{path.stem}[{number if home is None else home}]"
        yield name, from_release(filled(graph, knowledge).data, str(path))
    if not found:
        raise HearthError.of(Code.BAD_GRAPH, "no scene graph, and no tasks with an `init_graph`", file=str(path),
                             suggestion="a file of VirtualHome or of Watch-And-Help's tasks")  # fmt: skip


def _value(path: Path) -> Any:
    data = read_input(path)
    try:
        if path.suffix in PICKLES:
            return _PlainUnpickler(io.BytesIO(data)).load()
        return orjson.loads(data)
    except (ValueError, pickle.UnpicklingError, EOFError, IndexError, KeyError, TypeError, AttributeError,
            ImportError, MemoryError, RecursionError) as error:  # fmt: skip
        message = f"not JSON, or not a pickle of plain values: {str(error)[:100]}"
        raise HearthError.of(Code.BAD_JSON, message, file=str(path)) from error
