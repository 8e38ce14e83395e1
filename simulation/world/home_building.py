"""Reading nodes and edges into bit sets. Irregular graphs are read so:

- an id used twice, a node without id or class, an id that is not a number: refused as BAD_GRAPH;
- no category, properties or states: none; categories, properties and states that are not of the vocabulary: kept for
  printing, and of no effect;
- two states that exclude each other: the first holds;
- an edge to a node that there is not: left out; a repeated edge: once; CLOSE one way: both ways;
- a relation that is not of the vocabulary, or HOLDS by something else than a character: kept for printing only;
- two characters holding one thing: the one of the lower id holds it;
- a character that could be grabbed, worn, sat on or filled: of its properties only PERSON counts;
- INSIDE several rooms: the one of the lowest id is its room; INSIDE in a circle: no room, unless one is on the way;
- BETWEEN one room: a door that leads nowhere.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain, pairwise, repeat
from operator import attrgetter, itemgetter
from typing import Any, NamedTuple

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Edge, EdgeColumns, Node
from hearth.schemas.graph_json_faults import REMEDY
from hearth.schemas.vocabulary import CHARACTER_CLASS, PROPERTIES, RELATION_ID, ROOM_CATEGORY, STATE_ID, STATES
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.pose import STRIDE

Rows = list[int]
Raw = tuple[int, str, int]

CHARACTER_PROPERTIES = frozenset({"PERSON"})
"""The only property of a character that counts."""

LARGEST_MATRIX = 2048
"""Largest number of nodes for which edges are read through a matrix of n x n, which is faster; beyond, edge by edge."""

FEW_EDGES = 250
"""Largest number of edges for which reading one by one is faster than any matrix."""

LARGEST_TABLE = 100_000
"""Up to this id nodes are looked up in an array."""


@dataclass(frozen=True, slots=True)
class Nodes:
    """The nodes in the order of their ids; see `Home` for the fields."""

    nodes: list[Any]
    ids: list[int]
    index: dict[int, int]
    classes: list[str]
    by_class: dict[str, int]
    properties: dict[str, int]
    rooms: int
    states: tuple[int, ...]
    agents: tuple[int, ...]


class Edges(NamedTuple):
    """The edges as rows; see `Home` for the fields."""

    on: Rows
    bears: Rows
    inside: Rows
    contents: Rows
    close: Rows
    facing: Rows
    faced: Rows
    between: Rows
    agent_rows: list[Agent]
    others: list[Raw]


def read_nodes(given: Iterable[Mapping[str, Any]] | Iterable[Node]) -> Nodes:
    """Nodes of a graph or of the release's JSON, in any order.

    Raises:
        HearthError: BAD_GRAPH.
    """
    nodes: list[Any] = list(given)
    try:
        fields: Callable[[str], Callable[[Any], Any]]
        fields = attrgetter if nodes and isinstance(nodes[0], Node) else itemgetter
        nodes.sort(key=fields("id"))
        ids: list[int] = list(map(fields("id"), nodes))
        classes: list[str] = list(map(fields("class_name"), nodes))
        _check_names(ids, classes)
        index = dict(zip(ids, range(len(ids)), strict=True))
        by_class = _masks(classes)
        characters = by_class.get(CHARACTER_CLASS, 0)
        rooms = _masks(map(_getter("category", nodes), nodes)).get(ROOM_CATEGORY, 0) & ~characters
        properties, states = _properties(nodes, characters), _states(nodes)
    except (KeyError, TypeError, AttributeError) as error:
        raise bad_graph(f"a node lacks a field or has a wrong one: {type(error).__name__} {error}") from error
    return Nodes(nodes, ids, index, classes, by_class, properties, rooms, states, tuple(indices(characters)))


def bad_graph(message: str) -> HearthError:
    """Return the error of a graph that no world can be made of."""
    return HearthError.of(Code.BAD_GRAPH, message, suggestion=REMEDY)


def _check_names(ids: Sequence[int], classes: Sequence[str]) -> None:
    if not set(map(type, ids)) <= {int} or not set(map(type, classes)) <= {str}:
        found = next(pair for pair in zip(ids, classes, strict=True) if tuple(map(type, pair)) != (int, str))
        raise bad_graph(f"a node's id must be a whole number and its class a text, not {found[0]!r} and {found[1]!r}")
    if len(set(ids)) < len(ids):
        twice = next(a for a, b in pairwise(ids) if a == b)
        raise bad_graph(f"two nodes have the id {twice}")


def _getter(field: str, nodes: Sequence[Any]) -> Any:
    """Return a function from a node to a field of it that may be missing."""
    if nodes and isinstance(nodes[0], Node):
        return attrgetter(field)
    return lambda node: node.get(field) or ()


def _masks(values: Iterable[Any]) -> dict[Any, int]:
    """Value -> the positions at which it stands."""
    found: dict[Any, int] = {}
    bit = 1
    get = found.get
    for value in values:
        found[value] = get(value, 0) | bit
        bit <<= 1
    return found


def _properties(nodes: Sequence[Any], characters: int) -> dict[str, int]:
    found = dict.fromkeys(PROPERTIES, 0)
    for names, mask in _masks(map(tuple, map(_getter("properties", nodes), nodes))).items():
        for name in names:
            counted = mask if name in CHARACTER_PROPERTIES else mask & ~characters
            found[name] = found.get(name, 0) | counted
    return found


def _states(nodes: Sequence[Any]) -> tuple[int, ...]:
    states = [0] * len(STATES)
    for names, mask in _masks(map(tuple, map(_getter("states", nodes), nodes))).items():
        entered = set()
        for name in names:
            number = STATE_ID.get(name)
            if number is not None and number ^ 1 not in entered:
                entered.add(number)
                states[number] |= mask
    return tuple(states)


def read_edges(
    edges: Sequence[Mapping[str, Any]] | Sequence[Edge] | Sequence[Raw] | EdgeColumns, nodes: Nodes
) -> Edges:
    """Edges of a graph or of the release's JSON.

    Raises:
        HearthError: BAD_GRAPH.
    """
    try:
        given = edges if isinstance(edges, EdgeColumns) else _columns(edges)
        if 0 < len(nodes.ids) <= LARGEST_MATRIX and len(given[0]) > FEW_EDGES:
            tables, others = _by_matrix(given, nodes)
        else:
            named = _columns(list(given.rows())) if isinstance(given, EdgeColumns) else given
            tables, others = _one_by_one(named, nodes)
    except (KeyError, TypeError, ValueError) as error:
        raise bad_graph(f"an edge lacks a field or has a wrong one: {type(error).__name__} {error}") from error
    agent_rows = _part_characters(tables, nodes, others)
    on, bears, inside, contents, close, facing, faced, between = tables[:8]
    return Edges(on, bears, inside, contents, close, facing, faced, between, agent_rows, others)


Columns = tuple[Sequence[Any], Sequence[Any], Sequence[Any]]


def _columns(edges: Sequence[Any]) -> Columns:
    """Sources, relations, targets."""
    if edges and isinstance(edges[0], Mapping):
        sources, relations, targets = (list(map(itemgetter(k), edges)) for k in ("from_id", "relation_type", "to_id"))
        return sources, relations, targets
    if not edges:
        return (), (), ()
    found = tuple(zip(*edges, strict=True))
    if len(found) != 3:
        raise ValueError("not three fields")
    return found[0], found[1], found[2]


_OTHER = len(RELATION_ID)


_FORWARD = (0, 2, 4, 5, 7, 8, 9, 10)
"""The table, of ten, of an edge of each relation, by relation id; 10 means none."""

_BACKWARD = (1, 3, 4, 6, 10, 10, 10, 10)
"""The table of its inverse."""


_FROM_BYTES: Callable[[bytes], int] = partial(int.from_bytes, byteorder="little")


def _by_matrix(columns: Columns | EdgeColumns, nodes: Nodes) -> tuple[list[Rows], list[Raw]]:
    """Return the ten tables: their rows that are not empty, scattered into one array of booleans and packed at once."""
    import numpy as np

    n = len(nodes.ids)
    width = (n + 7) // 8
    a, b = _positions(columns[0], nodes), _positions(columns[2], nodes)
    relation: Any = columns[1]
    if not isinstance(relation, np.ndarray):
        relation = np.fromiter(map(RELATION_ID.get, relation, repeat(_OTHER)), np.int64, len(relation))
    known = (a >= 0) & (b >= 0)
    others = [_edge(columns, i) for i in np.flatnonzero(known & (relation == _OTHER)).tolist()]
    if not known.all():
        a, b, relation = a[known], b[known], relation[known]
    source = np.concatenate((np.take(_FORWARD, relation) * n + a, np.take(_BACKWARD, relation) * n + b))
    has = np.zeros(11 * n, bool)
    has[source] = True
    cells = np.zeros(np.count_nonzero(has) * width * 8, bool)
    cells[((np.cumsum(has) - 1) * (width * 8))[source] + np.concatenate((b, a))] = True
    rows = [0] * (11 * n)
    # As texts of `width` bytes they lack the zeros at their ends, which are the highest of a number.
    packed: list[bytes] = np.packbits(cells, bitorder="little").view(f"S{width}").tolist()
    for i, row in zip(np.flatnonzero(has).tolist(), map(_FROM_BYTES, packed), strict=True):
        rows[i] = row
    return [rows[k * n : (k + 1) * n] for k in range(10)], others


def _positions(ids: Sequence[Any], nodes: Nodes) -> Any:
    """Return indices of nodes by their ids as an array; -1 for those that there are not."""
    import numpy as np

    count = len(ids)
    if nodes.ids[0] < 0 or nodes.ids[-1] > LARGEST_TABLE:
        return np.fromiter(map(nodes.index.get, ids, repeat(-1)), np.int64, count)
    table = np.full(nodes.ids[-1] + 2, -1)
    table[nodes.ids] = np.arange(len(nodes.ids))
    found = np.array(ids)
    if found.dtype != np.int64:
        return np.fromiter(map(nodes.index.get, ids, repeat(-1)), np.int64, count)
    found[(found < 0) | (found >= len(table))] = len(table) - 1
    return table[found]


def _one_by_one(columns: Columns, nodes: Nodes) -> tuple[list[Rows], list[Raw]]:
    """Return the same, for homes of which a matrix would be too large."""
    n = len(nodes.ids)
    index = nodes.index
    tables = [[0] * n for _ in range(10)]
    on, bears, inside, contents, close, facing, faced, between, right, left = tables
    pairs = {
        "ON": (on, bears), "INSIDE": (inside, contents), "CLOSE": (close, close), "FACING": (facing, faced),
        "BETWEEN": (between, None), "HOLDS_RH": (right, None), "HOLDS_LH": (left, None),
    }  # fmt: skip
    others = []
    for i, (source, relation, target) in enumerate(zip(*columns, strict=True)):
        a, b = index.get(source), index.get(target)
        if a is None or b is None:
            continue
        if relation not in pairs:
            others.append(_edge(columns, i))
            continue
        forward, backward = pairs[relation]
        forward[a] |= 1 << b
        if backward is not None:
            backward[b] |= 1 << a
    return tables, others


def _edge(columns: Columns | EdgeColumns, i: int) -> Raw:
    return columns[0][i], columns[1][i], columns[2][i]


def _part_characters(tables: list[Rows], nodes: Nodes, others: list[Raw]) -> list[Agent]:
    """Move the characters' edges out of the things' rows; edges of hands that are no character's go to `others`."""
    on, bears, inside, contents, close, facing, faced, _between, right, left = tables
    characters = mask_of(nodes.agents)
    mine = (close, facing, faced, inside, contents, on, bears, right, left)
    # Edges between two characters stay with the one they go out from (see `Agent`).
    things = (-1, -1, ~characters, -1, ~characters, -1, ~characters, -1, -1)
    edges = ([row[i] & mask for row, mask in zip(mine, things, strict=True)] for i in nodes.agents)
    found = [Agent._make((i, 1 << i, *own, (), None, STRIDE)) for i, own in zip(nodes.agents, edges, strict=True)]
    opposite = (close, faced, facing, contents, inside, bears, on)
    for i in nodes.agents:
        for table, inverse in zip(mine, opposite, strict=False):
            for j in indices(table[i]):
                inverse[j] &= ~(1 << i)
            table[i] = 0
        right[i] = left[i] = 0
    others.extend(_hands_without_character(nodes, right, left))
    return _held_once(found)


def _hands_without_character(nodes: Nodes, right: Rows, left: Rows) -> Iterator[Raw]:
    ids = nodes.ids
    for name, rows in (("HOLDS_RH", right), ("HOLDS_LH", left)):
        if any(rows):
            yield from chain.from_iterable(((ids[i], name, ids[j]) for j in indices(r)) for i, r in enumerate(rows))


def _held_once(rows: list[Agent]) -> list[Agent]:
    """Take from each character what one before it holds."""
    if len(rows) < 2:
        return rows
    taken = 0
    found = []
    for row in rows:
        right, left = row.right & ~taken, row.left & ~taken
        taken |= right | left
        found.append(row._replace(right=right, left=left))
    return found
