"""A home of a dataset as its rows have it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.graph_change import WorkingGraph, in_states
from hearth.schemas.short_repr import brief


class StoredHome(NamedTuple):
    """A published home, and its working graph with sorted states, from which runs start."""

    graph: EnvironmentGraph
    working: WorkingGraph

    def __repr__(self) -> str:
        return brief(self)

    @classmethod
    def read(cls, rows: Callable[[str, str], list[Any]], name: str) -> StoredHome:
        """Return a home by its name; `rows` answers a query in SQL about `$id`.

        Raises:
            KeyError: the name is unknown.
        """
        from hearth.datasets.format.row_conversion import edges_of, node_of

        nodes = tuple(map(node_of, rows("SELECT * FROM home_nodes WHERE home = $id ORDER BY id", name)))
        if not nodes:
            raise KeyError(name)
        edges = sorted(set(edges_of(rows("SELECT * FROM home_edges WHERE home = $id", name))))
        working = WorkingGraph((in_states(node, node.states) for node in nodes), edges)
        return cls(EnvironmentGraph(nodes, tuple(edges)), working)
