"""Start and end graphs are read by the texts of their edges with the result of reading them whole."""

from __future__ import annotations

import json
import zipfile

import orjson
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hearth.pipelines.readers.graph_pairs import EDGE, read_pair
from hearth.schemas.graph import EdgeColumns, read_node
from hearth.schemas.graph_change import Change, Parts, difference, states_of

ids = st.sampled_from([*range(1, 30), 17, 77, 107, 1000])
edges = st.lists(st.tuples(ids, st.sampled_from(["ON", "INSIDE", "CLOSE", "HOLDS_RH"]), ids), min_size=1, max_size=40)
states = st.lists(st.sampled_from(["OPEN", "CLOSED", "ON", "OFF", "SHINY"]), max_size=3, unique=True)
graphs = st.tuples(st.dictionaries(ids, states, min_size=1, max_size=8), edges)
layouts = st.sampled_from([{}, {"separators": (",", ":")}, {"indent": 1}])


def as_json(graph, **more):
    nodes, found = graph
    return {
        "nodes": [{"id": i, "class_name": "cup", "properties": [], "states": names} for i, names in nodes.items()],
        "edges": [{"from_id": a, "relation_type": r, "to_id": b} for a, r, b in found],
        **more,
    }


def plainly(data):
    """Return the two graphs as a plain reader gives them, which reads them whole."""
    pair = orjson.loads(data)
    parts = [
        Parts(set(map(EDGE, graph["edges"])), states_of(map(read_node, graph["nodes"])))
        for graph in (pair["init_graph"], pair.get("final_graph"))
        if graph
    ]
    return parts[0].edges, difference(*parts) if len(parts) == 2 else None


def edges_of(graph):
    found = graph["edges"]
    return set(found.rows() if isinstance(found, EdgeColumns) else map(EDGE, found))


@given(graphs, graphs, layouts, st.booleans())
def test_both_ways_of_reading_agree(start, final, layout, has_final):
    data = json.dumps(
        {"init_graph": as_json(start), **({"final_graph": as_json(final)} if has_final else {})}, **layout
    )
    found, change = read_pair(data.encode())
    assert isinstance(found["edges"], EdgeColumns)
    assert (edges_of(found), change) == plainly(data)
    assert found["nodes"] == json.loads(data)["init_graph"]["nodes"]


ODD = {
    "another relation": [{"from_id": 1, "relation_type": "SITTING", "to_id": 2}],
    "an id below 0": [{"from_id": -1, "relation_type": "ON", "to_id": 2}],
    "a large id": [{"from_id": 1 << 30, "relation_type": "ON", "to_id": 2}],
    "other order": [
        {"to_id": 7, "from_id": 1, "relation_type": "ON"},
        {"from_id": 1, "relation_type": "ON", "to_id": 7},
    ],
    "more fields": [{"from_id": 1, "x": "7}, {", "relation_type": "ON", "to_id": 7, "y": ["]"]}],
    "no edges": [],
    "in two ways": [
        {"from_id": 1, "relation_type": "ON", "to_id": 2},
        {"relation_type": "ON", "from_id": 1, "to_id": 2},
    ],
}


@pytest.mark.parametrize("odd", ODD.values(), ids=ODD)
def test_irregular_edges_are_read_too(odd):
    usual = as_json(({1: []}, [(1, "ON", 2)]))
    for pair in ((usual, {**usual, "edges": odd}), ({**usual, "edges": odd}, usual)):
        data = json.dumps(dict(zip(("init_graph", "final_graph"), pair, strict=True)))
        found, change = read_pair(data.encode())
        assert (edges_of(found), change) == plainly(data)


def test_edges_elsewhere_are_not_the_graph_s():
    graph = as_json(({1: []}, [(1, "ON", 2)]), trimmed={"edges": [{"from_id": 5, "relation_type": "ON", "to_id": 6}]})
    found, change = read_pair(json.dumps({"init_graph": graph, "final_graph": graph}).encode())
    assert edges_of(found) == {(1, "ON", 2)} and change == Change()


@pytest.mark.parametrize("data", [
    b"[", b'{"init_graph": {"nodes": [], "edges": [{"from_id": 1}7}, {"from_id": 1}]}}', b"[]", b"{}", b"null",
    b'{"init_graph": {"nodes": [], "edges": [{"from_id": 1, "relation_type": "ON", "to_id": 2}, ]}}',
    b'{"init_graph": {"nodes": 3, "edges": 4}, "final_graph": {"nodes": [], "edges": []}}',
])  # fmt: skip
def test_what_is_no_pair_is_refused(data):
    with pytest.raises((ValueError, KeyError, TypeError, AttributeError)):
        read_pair(data)


def test_the_texts_of_the_release_suffice(real_data):
    with zipfile.ZipFile(real_data / "activityprograms-sample.zip") as archive:
        names = [
            name for name in sorted(archive.namelist()) if "/init_and_final_graphs/" in name and name.endswith("json")
        ]
        for name in names[::20]:
            data = archive.read(name)
            start, change = read_pair(data)
            assert isinstance(start["edges"], EdgeColumns) and (edges_of(start), change) == plainly(data)
