"""Graphs and steps as arrays for graph networks, with the ids of the dataset's vocabulary."""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from hearth.datasets.format.row_conversion import Bindings
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.program import Program
from hearth.schemas.short_repr import brief
from hearth.schemas.vocabulary import PROPERTY_ID, RELATION_ID, ROOM_CATEGORY, STATE_ID

INSIDE_ROOM = len(RELATION_ID)
"""Type of an edge INSIDE a room, distinct from INSIDE a thing (thesis 5.4.1); other types are `RELATION_ID`."""

EDGE_TYPES = (*RELATION_ID, "INSIDE_ROOM")

PADDING = -1


class GraphSample(NamedTuple):
    """A program, the graph of one of its runs at some tick, and the bindings of its objects in that run."""

    program: Program
    graph: EnvironmentGraph
    bound: Bindings

    def __repr__(self) -> str:
        return brief(self)


class Tensors(NamedTuple):
    """A batch of B graphs with N nodes and E edges in all, and programs of at most T steps; `torch.from_numpy` accepts
    each array.

    Attributes:
        node_class: (N,) int64, ids of classes; -1 for classes that the vocabulary lacks.
        node_states: (N, 10) float32, 1 for each state of the node.
        node_properties: (N, 23) float32, 1 for each property of the node.
        node_id: (N,) int64, ids in the graph.
        graph: (N,) int64, index of the node's graph.
        edge_index: (2, E) int64, indices of source and target nodes.
        edge_type: (E,) int64, an index of `EDGE_TYPES`.
        actions: (B, T) int64, ids of actions; -1 past the end.
        objects: (B, T, 2) int64, indices of the nodes of a step's objects; -1 for none.
        lengths: (B,) int64, number of steps of each program.
    """

    node_class: np.ndarray
    node_states: np.ndarray
    node_properties: np.ndarray
    node_id: np.ndarray
    graph: np.ndarray
    edge_index: np.ndarray
    edge_type: np.ndarray
    actions: np.ndarray
    objects: np.ndarray
    lengths: np.ndarray

    def __repr__(self) -> str:
        return brief(self)


def to_tensors(samples: Iterable[GraphSample], vocabulary: Iterable[tuple[str, str, int]]) -> Tensors:
    """Programs and graphs of their runs, as arrays.

    Args:
        samples: programs with one of their graphs each.
        vocabulary: kind (`action` or `class`), name and id.
    """
    ids = _Ids({(kind, name): number for kind, name, number in vocabulary})
    parts: dict[str, list[Any]] = {name: [] for name in Tensors._fields}
    first = 0
    for number, (program, graph, bound) in enumerate(samples):
        row = {node.id: first + place for place, node in enumerate(graph.nodes)}
        rooms = {node.id for node in graph.nodes if node.category == ROOM_CATEGORY}
        parts["node_class"] += [ids["class", node.class_name] for node in graph.nodes]
        parts["node_states"].append(_marks((node.states for node in graph.nodes), STATE_ID))
        parts["node_properties"].append(_marks((node.properties for node in graph.nodes), PROPERTY_ID))
        parts["node_id"] += row
        parts["graph"] += [number] * len(row)
        parts["edge_index"] += [(row[edge.source], row[edge.target]) for edge in graph.edges]
        parts["edge_type"] += [
            INSIDE_ROOM if edge.relation == "INSIDE" and edge.target in rooms else RELATION_ID[edge.relation]
            for edge in graph.edges
        ]
        actions, objects = _steps(program, bound, row, ids)
        parts["actions"].append(actions)
        parts["objects"].append(objects)
        parts["lengths"].append(len(program.steps))
        first += len(row)
    _pad(parts["actions"], PADDING)
    _pad(parts["objects"], (PADDING, PADDING))
    marks = {"node_states": len(STATE_ID), "node_properties": len(PROPERTY_ID)}
    stacked = {
        name: np.concatenate(parts[name]) if parts[name] else np.zeros((0, width), np.float32)
        for name, width in marks.items()
    }
    steps = (len(parts["lengths"]), max(parts["lengths"], default=0))
    shapes = {"edge_index": (-1, 2), "actions": steps, "objects": (*steps, 2)}
    rest = {
        name: np.array(parts[name], dtype=np.int64).reshape(shapes.get(name, (-1,)))
        for name in Tensors._fields
        if name not in marks
    }
    return Tensors(**{**stacked, **rest, "edge_index": rest["edge_index"].T.copy()})


class _Ids(dict[tuple[str, str], int]):
    def __missing__(self, key: tuple[str, str]) -> int:
        return PADDING


def _marks(found: Iterable[Iterable[str]], known: dict[str, int]) -> np.ndarray:
    rows = [[known[name] for name in names if name in known] for names in found]
    marks = np.zeros((len(rows), len(known)), dtype=np.float32)
    for place, columns in enumerate(rows):
        marks[place, columns] = 1
    return marks


def _steps(
    program: Program, bound: Bindings, row: dict[int, int], ids: _Ids
) -> tuple[list[int], list[tuple[int, int]]]:
    actions, objects = [], []
    for step in program.steps:
        nodes = [row.get(bound.get(ref.key, PADDING), PADDING) for ref in step.objects]
        actions.append(ids["action", step.action])
        objects.append(((*nodes, PADDING, PADDING)[0], (*nodes, PADDING, PADDING)[1]))
    return actions, objects


def _pad(rows: list[list[Any]], filling: object) -> None:
    """Pad all rows to the length of the longest."""
    longest = max(map(len, rows), default=0)
    for row in rows:
        row.extend([filling] * (longest - len(row)))
