"""The start and end graph of a program, read from a release's JSON: a megabyte a program, nearly all of it edges.

The graphs of a release have most of their edges in common and in one order. The text of some ten edges is parsed when
it is first met, and then looked up. Other text is parsed as it stands, with the same result.
"""

import re
from array import array
from collections.abc import Iterable, Sequence
from itertools import pairwise
from operator import itemgetter
from typing import Any

import orjson

from hearth.schemas.graph import Edge, EdgeColumns
from hearth.schemas.graph_change import Change, Parts, difference
from hearth.schemas.vocabulary import RELATION_ID, STATE_ID

JsonObject = dict[str, Any]
"""An object as the release writes it."""

EDGE = itemgetter("from_id", "relation_type", "to_id")
"""The fields of an edge in JSON."""

_BETWEEN = re.compile(rb"\}\s*,\s*\{")
_CUT = b"7"
"""A file is cut between objects where the last of a text ends in this.

A text has some ten edges, so that the differences of two graphs are in few texts.
"""

_MOST = 50_000
"""Texts that are kept: some 50 MB."""

_RELATION, _SOURCE = 28, 32
"""First bits of an edge's number with its relation and its source; the target is below."""

Portions = set[bytes]
"""Edges by the text, each with its ends and relation in one integer of 64 bits."""

_KNOWN: dict[bytes, bytes] = {}
"""Portions by their texts."""


def read_pair(data: bytes) -> tuple[JsonObject, Change | None]:
    """Return the start graph, and the change to the end graph in edges and simulated states; None without an end graph.

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
    """Return the pair of a JSON value, with its edges as they are.

    Raises:
        KeyError, TypeError, ValueError, AttributeError: it is not a pair of graphs.
    """
    start, final = value["init_graph"], value.get("final_graph")
    if not final:
        return start, None
    return start, _changed(start, final, *(set(map(EDGE, graph["edges"])) for graph in (start, final)))


def _by_texts(data: bytes) -> tuple[JsonObject, Change | None]:
    """Return both, with most edges looked up by their texts.

    The result is exact, because each text is a list of objects by itself. The rest is JSON in which the number of each
    run of texts stands where a graph has its edges.
    """
    rest, runs = _cut(data)
    pair = orjson.loads(rest)
    start, final = pair["init_graph"], pair.get("final_graph")
    graphs = [graph for graph in (start, final) if graph]
    if [one for graph in graphs for one in graph["edges"] if type(one) is int] != list(range(len(runs))):
        raise ValueError("edges where none are expected")
    past, *now = (_portions(graph["edges"], runs) for graph in graphs)
    edges = _sorted(past)
    start["edges"] = _columns(edges)
    if not final:
        return start, None
    added = _columns(_missing(_sorted(now[0].difference(past)), edges)).rows()
    removed = _columns(_missing(_sorted(past.difference(now[0])), _sorted(now[0]))).rows()
    return start, _changed(start, final, set(removed), set(added))


def _cut(data: bytes) -> tuple[bytes, list[Portions]]:
    """Return the file with a number for each run of texts that are nothing but edges, and the runs' edges."""
    between = _BETWEEN.search(data)
    cut = _CUT + between[0] if between else b""
    texts = re.split(re.escape(cut), data) if cut else [data]  # half as long as `bytes.split` takes
    if len(_KNOWN) > _MOST:
        _KNOWN.clear()
    found = [_KNOWN.get(text) or _learnt(text) for text in texts]
    others = [i for i, portion in enumerate(found) if not portion]
    if not others or others[0] or others[-1] != len(texts) - 1:
        raise ValueError("no object with graphs")
    rest: list[bytes] = [texts[0]]
    runs: list[Portions] = []
    for i, j in pairwise(others):
        rest += (cut if j - i == 1 else b"%b}, %d, {" % (_CUT, len(runs)), texts[j])
        if j - i > 1:
            runs.append(set(found[i + 1 : j]))
    return b"".join(rest), runs


def _learnt(text: bytes) -> bytes:
    """Return the edges of a text that is nothing else, kept for the next time; else nothing."""
    try:
        found = _KNOWN[text] = _portion(orjson.loads(b"[{%b%b}]" % (text, _CUT)))
    except (KeyError, TypeError, ValueError, AttributeError):
        return b""
    return found


def _portions(edges: Sequence[Any], runs: Sequence[Portions]) -> Portions:
    """Return a graph's edges: those of its runs, and the others."""
    others = _portion([one for one in edges if type(one) is not int])
    return {others}.union(*(runs[one] for one in edges if type(one) is int))


def _portion(edges: Iterable[JsonObject]) -> bytes:
    rows = list(map(EDGE, edges))
    ids = [*map(itemgetter(0), rows), *map(itemgetter(2), rows)]
    if set(map(type, ids)) != {int} or min(ids) < 0 or max(ids) >> _RELATION:
        raise ValueError("an edge between other ids")
    return array("q", [a << _SOURCE | RELATION_ID[name] << _RELATION | b for a, name, b in rows]).tobytes()


def _sorted(portions: Portions) -> Any:
    import numpy as np

    return np.sort(np.frombuffer(b"".join(portions), np.int64))


def _missing(some: Any, edges: Any) -> Any:
    """Return the items that are not among some ordered edges."""
    import numpy as np

    return some[edges[np.minimum(np.searchsorted(edges, some), len(edges) - 1)] != some]


def _columns(numbers: Any) -> EdgeColumns:
    relations = numbers >> _RELATION & (1 << _SOURCE - _RELATION) - 1
    return EdgeColumns(numbers >> _SOURCE, relations, numbers & (1 << _RELATION) - 1)


def _changed(start: JsonObject, final: JsonObject, edges: set[Edge], new: set[Edge]) -> Change:
    """Return the change between two sets of edges, without the edges of both, and between the simulated states."""
    nodes = (start["nodes"], final["nodes"])
    past, now = ({(int(one["id"]), *(one.get("states") or ())) for one in each} for each in nodes)
    ids = {one[0] for one in past ^ now}
    return difference(Parts(edges, _states(past, ids)), Parts(new, _states(now, ids)))


def _states(nodes: Iterable[tuple[Any, ...]], ids: set[int]) -> set[tuple[int, str]]:
    """Return the simulated states of some nodes, each given as its id and states."""
    return {(one[0], name) for one in nodes if one[0] in ids for name in one[1:] if name in STATE_ID}
