"""`networkx` and `graphml`: the initial and final graph of each run, for other tools."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import orjson

from hearth.datasets.dataset import Dataset
from hearth.datasets.export.program_batches import Wanted, runs, write
from hearth.schemas.terminal import escaped
from hearth.storage.names import file_name, inside

if TYPE_CHECKING:
    import networkx


def node_link(dataset: Dataset, to: Path, wanted: Wanted) -> int:
    """`EXECUTION.start.json` and `.final.json`, in networkx's node-link format.

    Returns:
        Number of executions.
    """
    import networkx

    def written(graph: networkx.MultiDiGraph) -> bytes:
        return orjson.dumps(networkx.node_link_data(graph, edges="edges"))

    return _each(dataset, to, wanted, "json", written)


def graphml(dataset: Dataset, to: Path, wanted: Wanted) -> int:
    """`EXECUTION.start.graphml` and `.final.graphml`; lists as words separated by spaces.

    Returns:
        Number of executions.
    """
    import networkx

    def written(graph: networkx.MultiDiGraph) -> bytes:
        flat: networkx.MultiDiGraph = networkx.MultiDiGraph()
        for node, attributes in graph.nodes(data=True):
            flat.add_node(node, **{name: _plain(value).translate(_NOT_XML) for name, value in attributes.items()})
        for source, target, relation in graph.edges(keys=True):
            flat.add_edge(source, target, key=relation, relation=relation.translate(_NOT_XML))
        return "\n".join(networkx.generate_graphml(flat)).encode() + b"\n"

    return _each(dataset, to, wanted, "graphml", written)


_NO_CHARACTERS = {*range(32), *range(0xD800, 0xE000), 0xFFFE, 0xFFFF} - {*b"\t\n\r"}
_NOT_XML = {code: escaped(code) for code in _NO_CHARACTERS}
"""Characters that no XML document has, not even as references; of the others it says what it said."""


def _plain(value: object) -> str:
    return " ".join(map(str, value)) if isinstance(value, list) else str(value)


def _each(
    dataset: Dataset, to: Path, wanted: Wanted, suffix: str, written: Callable[[networkx.MultiDiGraph], bytes]
) -> int:
    number = 0
    for number, (_, run) in enumerate(runs(dataset, wanted), 1):  # noqa: B007 - the last number is the count
        name = file_name(run.row["execution_id"])
        write(inside(to, f"{name}.start.{suffix}"), written(run.networkx(0)))
        write(inside(to, f"{name}.final.{suffix}"), written(run.networkx(len(run.row["ticks"]))))
    return number
