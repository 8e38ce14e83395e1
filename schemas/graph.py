"""Environment graphs: the nodes of a home and how they relate (thesis 2.3.2, 5.4.1)."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, cast

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph_json_faults import REMEDY, graph_fault
from hearth.schemas.numbers import FARTHEST, LONGEST_HOME, stored
from hearth.schemas.short_repr import brief
from hearth.schemas.vocabulary import RELATIONS

Point = tuple[float, float, float]
"""(x, y, z) in metres, y upwards."""

Spot = tuple[float, float]
"""(x, z) in metres: a place on the floor."""


class Box(NamedTuple):
    """An axis-aligned box: centre and full size."""

    center: Point
    size: Point


class Edge(NamedTuple):
    """`source` stands in `relation` to `target`; both are node ids."""

    source: int
    relation: str
    target: int


class EdgeColumns(NamedTuple):
    """Edges column by column, as arrays of int64; relations by their ids in the vocabulary."""

    sources: Any
    relations: Any
    targets: Any

    def __repr__(self) -> str:
        return brief(self)

    def rows(self) -> Iterator[Edge]:
        """Return the edges, as plain tuples, which equal `Edge` and are made faster."""
        names = map(RELATIONS.__getitem__, self.relations.tolist())
        return cast("Iterator[Edge]", zip(self.sources.tolist(), names, self.targets.tolist(), strict=True))


@dataclass(frozen=True, slots=True)
class Node:
    """One thing of a home.

    Attributes:
        id: unique within its graph.
        class_name: `television`.
        category: `Electronics`, `Rooms`, ...
        properties: names of `vocabulary.PROPERTIES` as far as known.
        states: names of `vocabulary.STATES`, in the order given.
        prefab: the model that shows it, if any.
        box: where it is, if known.
        yaw: the way it faces, in degrees about y from +z; None when unknown.
    """

    id: int
    class_name: str
    category: str = ""
    properties: tuple[str, ...] = ()
    states: tuple[str, ...] = ()
    prefab: str | None = None
    box: Box | None = None
    yaw: float | None = None

    __repr__ = brief


@dataclass(frozen=True, slots=True)
class EnvironmentGraph:
    """Nodes and edges, in the order given; `extra` keeps the file's other fields."""

    nodes: tuple[Node, ...] = ()
    edges: tuple[Edge, ...] = ()
    extra: tuple[tuple[str, Any], ...] = ()

    __repr__ = brief

    def node(self, node_id: int) -> Node:
        """Return the node of that id.

        Raises:
            KeyError: there is none.
        """
        for node in self.nodes:
            if node.id == node_id:
                return node
        raise KeyError(node_id)


def from_release(data: Mapping[str, Any], file: str = "") -> EnvironmentGraph:
    """Read a graph as the release writes it.

    Raises:
        HearthError: BAD_GRAPH, naming the first node or edge that lacks a required field.
    """
    try:
        nodes = tuple(map(read_node, data["nodes"]))
        edges = tuple(map(_edge, data["edges"]))
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise HearthError.of(
            Code.BAD_GRAPH,
            f"not an environment graph: {_place_of_fault(data)}{graph_fault(data, error)}",
            file=file,
            suggestion=REMEDY,
        ) from error
    extra = tuple((key, value) for key, value in data.items() if key not in ("nodes", "edges"))
    return EnvironmentGraph(nodes, edges, extra)


def _place_of_fault(data: Any) -> str:
    """Return the first node that has its keys and can't be read, as `nodes[3]: `; "" where there is none."""
    nodes = data.get("nodes") if isinstance(data, Mapping) else None
    for number, node in enumerate(nodes if isinstance(nodes, list) else ()):
        try:
            read_node(node)
        except (KeyError, TypeError, ValueError, AttributeError):
            return f"nodes[{number}]: " if isinstance(node, Mapping) and {"id", "class_name"} <= node.keys() else ""
    return ""


def to_release(graph: EnvironmentGraph) -> dict[str, Any]:
    """Write a graph as the release does: the inverse of `from_release`."""
    return {
        **dict(graph.extra),
        "nodes": [_node_json(node) for node in graph.nodes],
        "edges": [{"from_id": e.source, "relation_type": e.relation, "to_id": e.target} for e in graph.edges],
    }


def edge_set(edges: Iterable[Edge]) -> frozenset[tuple[int, str, int]]:
    """Edges for comparison: order and duplicates left out."""
    return frozenset((e.source, e.relation, e.target) for e in edges)


def read_node(data: Mapping[str, Any]) -> Node:
    """Return a node as the release writes it.

    Raises:
        KeyError, TypeError, ValueError, AttributeError: a field that it needs is missing, or one is of a wrong kind.
    """
    box, prefab, yaw = data.get("bounding_box"), data.get("prefab_name"), data.get("yaw")
    if yaw is not None and type(yaw) not in (int, float):
        raise TypeError(f"yaw is {type(yaw).__name__}, not a number")
    return Node(
        stored(data["id"]),
        word(data["class_name"]),
        word(data.get("category") or ""),
        tuple(map(word, _listed(data.get("properties")))),
        tuple(map(word, _listed(data.get("states")))),
        None if prefab is None else word(prefab),
        Box(_point(box["center"], FARTHEST), _point(box["size"], LONGEST_HOME)) if box else None,
        yaw,
    )


def _edge(data: Mapping[str, Any]) -> Edge:
    source, target = data["from_id"], data["to_id"]
    if type(source) is not int or type(target) is not int:
        raise TypeError("an edge needs numbers for from_id and to_id")
    return Edge(stored(source), word(data["relation_type"]), stored(target))


def word(value: Any) -> str:
    """Return a value that must be text.

    Raises:
        TypeError: it is not.
    """
    if not isinstance(value, str):
        raise TypeError(f"{type(value).__name__} where a word is expected")
    return value


def _listed(value: Any) -> Iterable[Any]:
    if isinstance(value, str):
        raise TypeError("a word where a list is expected")
    return value or ()


def _point(values: Iterable[float], most: float) -> Point:
    """Return a place or a size in metres.

    Raises:
        ValueError: it is not three numbers, or one that no home has.
    """
    x, y, z = map(float, values)
    if not (-most <= x <= most and -most <= y <= most and -most <= z <= most):
        raise ValueError(f"a box with {x:g}, {y:g}, {z:g} metres, where {most:g} is the most")
    return x, y, z


def _node_json(node: Node) -> dict[str, Any]:
    box = node.box and {"center": list(node.box.center), "size": list(node.box.size)}
    data = {
        "id": node.id,
        "class_name": node.class_name,
        "category": node.category,
        "properties": list(node.properties),
        "states": list(node.states),
        "prefab_name": node.prefab,
        "bounding_box": box,
    }
    if node.yaw is not None:
        data["yaw"] = node.yaw
    return data
