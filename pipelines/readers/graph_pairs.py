"""The start and end graph of a program, read from a release's JSON: a megabyte a program, nearly all of it edges.

The graphs of a release have most of their edges in common and in one order: the text of some ten edges is parsed when
it is first met, and then looked up. What looks otherwise is parsed as it stands, with the same result.
"""

import re
from array import array
from operator import itemgetter
from typing import Any

import orjson

from hearth.schemas.change import Change, Parts, difference
from hearth.schemas.graph import Edge, EdgeColumns
from hearth.schemas.vocabulary import RELATION_ID, STATE_ID

JsonObject = dict[str, Any]
"""An object as the release writes it."""

EDGE = itemgetter("from_id", "relation_type", "to_id")
"""The fields of an edge in JSON."""

_START = re.compile(rb'"edges"\s*:\s*\[')
_BETWEEN = re.compile(rb"\}\s*,\s*\{")
_CUT = b"7"
"""Lists are cut between objects where the last of a text ends in this."""

_MOST = 50_000
"""Texts that are kept: some 50 MB."""

_RELATION, _SOURCE = 28, 32
"""From which bit of its number on an edge has its relation and source; the target is below."""


def read_pair(data: bytes) -> tuple[JsonObject, Change | None]:
    """The start graph, and the change to the end graph in edges and simulated states; None without an end graph.

    The start graph is the release's, but for its edges, which are `EdgeColumns` if they have usual ids and relations.

    Raises:
        orjson.JSONDecodeError: it is not JSON.
        KeyError, TypeError, ValueError, AttributeError: it is not a pair of graphs.
    """
    try:
        return _by_texts(data)
    except (KeyError, TypeError, ValueError, AttributeError):
        return pair_of(orjson.loads(data))


def pair_of(value: Any) -> tuple[JsonObject, Change | None]:
    """The same of a JSON value, its edges as they are.

    Raises:
        KeyError, TypeError, ValueError, AttributeError: it is not a pair of graphs.
    """
    start, final = value["init_graph"], value.get("final_graph")
    if not final:
        return start, None
    return start, _changed(start, final, *(set(map(EDGE, graph["edges"])) for graph in (start, final)))


def _by_texts(data: bytes) -> tuple[JsonObject, Change | None]:
    """Both, the lists of edges cut out as texts: exact, because each text is a list of objects by itself, and what is
    left is JSON in which the number of each list stands where a graph has its edges.
    """
    import numpy as np

    rest: list[bytes] = []
    lists: list[list[bytes]] = []
    at = 0
    while match := _START.search(data, at):
        rest += (data[at : match.end()], b"%d" % len(lists))
        at = data.index(b"]", match.end())
        lists.append(_texts(data[match.end() : at].strip()))
    pair = orjson.loads(b"".join((*rest, data[at:])))
    start, final = pair["init_graph"], pair.get("final_graph")
    if [graph["edges"] for graph in (start, final) if graph] != [[number] for number in range(len(lists))]:
        raise ValueError("edges where none are expected")
    if len(_NUMBERS) > _MOST:
        _NUMBERS.clear()
    past, *now = (np.sort(np.frombuffer(b"".join(map(_NUMBERS.__getitem__, texts)), np.int64)) for texts in lists)
    start["edges"] = _columns(past)
    if not final:
        return start, None
    return start, _changed(start, final, _only_in(past, now[0]), _only_in(now[0], past))


def _only_in(one: Any, other: Any) -> set[Edge]:
    """The edges of one of two sorted arrays."""
    import numpy as np

    found = other[np.minimum(np.searchsorted(other, one), len(other) - 1)] != one
    return set(_columns(one[found]).rows())


def _texts(text: bytes) -> list[bytes]:
    """A list's objects, some ten a text, so that what differs between two lists is in few texts; the last ends in }."""
    between = _BETWEEN.search(text)
    found = text[1:].split(_CUT + between[0]) if between else [text[1:]]
    if not (text.startswith(b"{") and [one.endswith(b"}") for one in found].index(True) == len(found) - 1):
        raise ValueError("no list of objects")
    return found


class _Numbers(dict[bytes, bytes]):
    """A text -> its edges, each with ends and relation in one integer of 64 bits."""

    def __missing__(self, text: bytes) -> bytes:
        whole = text if text.endswith(b"}") else b"%b%b}" % (text, _CUT)
        found = self[text] = array("q", [_number(*EDGE(edge)) for edge in orjson.loads(b"[{%b]" % whole)]).tobytes()
        return found


_NUMBERS = _Numbers()


def _number(source: object, relation: str, target: object) -> int:
    if not (type(source) is type(target) is int and 0 <= min(source, target) <= max(source, target) < 1 << _RELATION):
        raise ValueError("an edge between other ids")
    return source << _SOURCE | RELATION_ID[relation] << _RELATION | target


def _columns(numbers: Any) -> EdgeColumns:
    relations = numbers >> _RELATION & (1 << _SOURCE - _RELATION) - 1
    return EdgeColumns(numbers >> _SOURCE, relations, numbers & (1 << _RELATION) - 1)


def _changed(start: JsonObject, final: JsonObject, edges: set[Edge], new: set[Edge]) -> Change:
    """The change between two sets of edges, which may lack what both have, and in the simulated states."""
    nodes, others = start["nodes"], final["nodes"]
    if len(nodes) == len(others):
        pairs = [(node, other) for node, other in zip(nodes, others, strict=True) if node != other]
        nodes, others = [node for node, _ in pairs], [other for _, other in pairs]
    return difference(Parts(edges, _states(nodes)), Parts(new, _states(others)))


def _states(nodes: list[JsonObject]) -> set[tuple[int, str]]:
    return {(int(node["id"]), name) for node in nodes for name in node.get("states") or () if name in STATE_ID}
