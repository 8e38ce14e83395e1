"""Homes inferred from the environments made of them."""

from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from hearth.datasets.format.row_conversion import graph_of
from hearth.schemas.graph import Edge, EnvironmentGraph, Node, to_release
from hearth.schemas.row_types import GraphRow
from hearth.storage.files import write_json


def common(rows: Iterable[GraphRow]) -> EnvironmentGraph:
    """Return the nodes and edges common to all graphs, with the most frequent states."""
    nodes: dict[int, Node] = {}
    edges: set[Edge] = set()
    states: dict[int, Counter[tuple[str, ...]]] = defaultdict(Counter)
    for number, row in enumerate(rows):
        graph = graph_of(row)
        for node in graph.nodes:
            states[node.id][node.states] += 1
        here = {node.id: node for node in graph.nodes}
        nodes = {i: node for i, node in nodes.items() if i in here and _alike(node, here[i])} if number else here
        edges = edges & set(graph.edges) if number else set(graph.edges)
    kept = (edge for edge in edges if edge.source in nodes and edge.target in nodes)
    usual = (replace(node, states=states[i].most_common(1)[0][0]) for i, node in sorted(nodes.items()))
    return EnvironmentGraph(tuple(usual), tuple(sorted(kept)))


def _alike(one: Node, other: Node) -> bool:
    return replace(one, states=()) == replace(other, states=())


def write_home(path: Path, graph: EnvironmentGraph) -> None:
    """Write a home in the release's format."""
    write_json(path, to_release(graph))
