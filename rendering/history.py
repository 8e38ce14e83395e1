"""The graphs of an execution, one a tick, at a cost that follows what changes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from hearth.schemas.graph import EnvironmentGraph, Node
from hearth.simulation.change import Change
from hearth.simulation.engine import Execution

SHOWN = frozenset({"ON", "INSIDE", "HOLDS_RH", "HOLDS_LH"})
"""Relations that decide where things are."""


def graphs(execution: Execution) -> Iterator[EnvironmentGraph]:
    """The graph at the start and after each tick, with the relations that can be seen."""
    graph = execution.worlds[0].graph()
    edges = {edge for edge in graph.edges if edge.relation in SHOWN}
    nodes = {node.id: node for node in graph.nodes}
    yield EnvironmentGraph(graph.nodes, tuple(sorted(edges)))
    for change in execution.changes():
        edges = (edges - set(change.removed)) | {edge for edge in change.added if edge.relation in SHOWN}
        nodes |= _restated(nodes, change)
        yield EnvironmentGraph(tuple(nodes.values()), tuple(sorted(edges)))


def _restated(nodes: dict[int, Node], change: Change) -> dict[int, Node]:
    states: dict[int, list[str]] = {}
    for node_id, name in change.cleared_states:
        states.setdefault(node_id, list(nodes[node_id].states)).remove(name)
    for node_id, name in change.set_states:
        states.setdefault(node_id, list(nodes[node_id].states)).append(name)
    return {node_id: replace(nodes[node_id], states=tuple(sorted(found))) for node_id, found in states.items()}
