"""Homes of which only environments are known: what all of them share."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from hearth.pipelines.files import write_json
from hearth.pipelines.rows import graph_of
from hearth.schemas.graph import Edge, EnvironmentGraph, to_release


def common(graphs: Iterable[Mapping[str, Any]]) -> EnvironmentGraph:
    """The nodes and edges that all graphs (rows of `tables.GRAPH`) share, with the states of the first of them."""
    nodes: dict[int, Any] = {}
    edges: set[Edge] = set()
    for number, row in enumerate(graphs):
        graph = graph_of(row)
        if number == 0:
            nodes = {node.id: node for node in graph.nodes}
            edges = set(graph.edges)
        else:
            shared = {(node.id, node.class_name) for node in graph.nodes}
            nodes = {node_id: node for node_id, node in nodes.items() if (node_id, node.class_name) in shared}
            edges &= set(graph.edges)
    kept = (edge for edge in edges if edge.source in nodes and edge.target in nodes)
    return EnvironmentGraph(tuple(nodes[node_id] for node_id in sorted(nodes)), tuple(sorted(kept)))


def write_home(path: Path, graph: EnvironmentGraph) -> None:
    """Write a home in the release's form."""
    write_json(path, to_release(graph))
