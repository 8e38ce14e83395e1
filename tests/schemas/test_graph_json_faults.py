"""The fault of JSON that is not a scene graph names the first node or edge that lacks a key, and the keys it has."""

import re

import pytest

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import from_release

NODE = {"id": 1, "class_name": "kitchen"}
CASES = {
    "other names of an edge": (
        {"nodes": [NODE], "edges": [{"from": 1, "to": 1, "relation_type": "ON"}]},
        "edge 1 has no `from_id` and no `to_id`; it has `from`, `to`, `relation_type`",
    ),
    "the second edge": (
        {"nodes": [NODE], "edges": [{"from_id": 1, "to_id": 1, "relation_type": "ON"}, {"from_id": 1, "to_id": 1}]},
        "edge 2 has no `relation_type`; it has `from_id`, `to_id`",
    ),
    "a node without a class": (
        {"nodes": [NODE, {"id": 2, "name": "fridge"}], "edges": []},
        "node 2 has no `class_name`; it has `id`, `name`",
    ),
    "a node without anything": ({"nodes": [{}], "edges": []}, "node 1 has no `id` and no `class_name`; it has no key"),
    "an edge as a list": (
        {"nodes": [NODE], "edges": [[1, "ON", 1]]},
        "edge 1 is \"[1, 'ON', 1]\" instead of an object with from_id, relation_type, to_id",
    ),
    "no edges": ({"nodes": [NODE]}, "it has no list `edges`"),
    "no list": ({"nodes": "all", "edges": []}, "it has no list `nodes`"),
    "many keys": (
        {"nodes": [{f"k{n}": n for n in range(20)}], "edges": []},
        "it has `k0`, `k1`, `k2`, `k3`, `k4`, `k5`, ...",
    ),
    "a wrong value": (
        {"nodes": [NODE], "edges": [{"from_id": "one", "to_id": 1, "relation_type": "ON"}]},
        "a field of it is wrong: an edge needs numbers for from_id and to_id",
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_the_message_names_what_is_lacking_and_no_python_error(name):
    graph, message = CASES[name]
    with pytest.raises(HearthError, match=re.escape(message)) as caught:
        from_release(graph)
    (fault,) = caught.value.diagnostics
    assert str(fault.code) == "BAD_GRAPH" and "from_id" in fault.suggestion
    assert "Error" not in fault.message


@pytest.mark.parametrize("names", [("from", "relation", "to"), ("source", "relation_type", "target"),
                                   ("subject", "predicate", "object"), ("from_id", "rel", "To")])  # fmt: skip
def test_keys_of_others_are_named_with_ours(names):
    """A graph whose keys are renamed as the message asks can be read."""
    graph = {"nodes": [NODE], "edges": [dict(zip(names, (1, "ON", 1), strict=True))]}
    with pytest.raises(HearthError) as caught:
        from_release(graph)
    said = dict(re.findall(r"`([^`]+)` to `([^`]+)`", caught.value.diagnostics[0].message))
    assert said
    edge = {said.get(name, name): value for name, value in graph["edges"][0].items()}
    assert from_release({**graph, "edges": [edge]}).edges[0] == (1, "ON", 1)


def test_a_node_of_others_too():
    with pytest.raises(HearthError, match="rename `uid` to `id`, `label` to `class_name`"):
        from_release({"nodes": [{"uid": 1, "label": "kitchen"}], "edges": []})
