"""Graphs that a client of VirtualHome's program sends: edited ones, and ones that contradict themselves."""

from __future__ import annotations

import copy
import json

import pytest

from tests.interop.unity_client import ids_of, relations


def opened(graph, ids):
    next(node for node in graph["nodes"] if node["class_name"] == "fridge")["states"] = ["OPEN"]


def removed(graph, ids):
    graph["nodes"] = [node for node in graph["nodes"] if node["id"] != ids["milk"]]
    graph["edges"] = [e for e in graph["edges"] if ids["milk"] not in (e["from_id"], e["to_id"])]


def moved(graph, ids):
    gone = [e for e in graph["edges"] if e["from_id"] == ids["mug"] and e["relation_type"] in ("ON", "INSIDE")]
    graph["edges"] = [e for e in graph["edges"] if e not in gone]
    graph["edges"].append({"from_id": ids["mug"], "relation_type": "ON", "to_id": ids["sofa"]})


def laden(graph, ids):
    graph["nodes"] += [{"class_name": "plate", "id": 2000}, {"class_name": "apple", "id": 2001}]
    graph["edges"] += [{"from_id": 2001, "relation_type": "ON", "to_id": 2000},
                       {"from_id": 2000, "relation_type": "ON", "to_id": ids["table"]}]  # fmt: skip


def shifted(graph, ids):
    node = next(node for node in graph["nodes"] if node["id"] == ids["vase"])
    node["bounding_box"]["center"][0] += 0.25


@pytest.mark.parametrize(
    ("edit", "kind", "number"),
    [(opened, "states", "fridge"), (removed, "removed", "milk"), (moved, "placed", "mug"), (laden, "added", 2001),
     (shifted, "boxes", "vase")],
)  # fmt: skip
def test_edited_graphs(client, edit, kind, number):
    before = client.graph()
    ids, wanted = ids_of(before), copy.deepcopy(before)
    edit(wanted, ids)
    number = ids.get(number, number)
    reply = client.expand(wanted)
    assert reply["success"], reply["message"]
    assert number in json.loads(reply["message"])[kind]
    after = {node["id"]: node for node in client.graph()["nodes"]}
    if kind == "removed":
        assert number not in after
    elif kind == "states":
        assert after[number]["states"] == ["OPEN"] or "CLOSED" not in after[number]["states"]
    elif kind == "placed":
        assert ("ON", ids["sofa"]) in relations(client, number)
        sofa, mug = after[ids["sofa"]]["bounding_box"], after[number]["bounding_box"]
        assert all(abs(sofa["center"][k] - mug["center"][k]) <= sofa["size"][k] / 2 for k in (0, 2))
    elif kind == "added":
        assert ("ON", 2000) in relations(client, 2001) and after[2001]["bounding_box"]
    else:
        old = next(node for node in before["nodes"] if node["id"] == number)["bounding_box"]["center"]
        assert after[number]["bounding_box"]["center"][0] == pytest.approx(old[0] + 0.25)


def both_states(graph, ids):
    next(node for node in graph["nodes"] if node["class_name"] == "fridge")["states"] = ["OPEN", "CLOSED"]


def two_places(graph, ids):
    graph["edges"].append({"from_id": ids["mug"], "relation_type": "ON", "to_id": ids["sofa"]})


def on_and_in(graph, ids):
    graph["edges"] = [edge for edge in graph["edges"] if edge["from_id"] != ids["mug"]]
    graph["edges"] += [{"from_id": ids["mug"], "relation_type": name, "to_id": ids["bed"]} for name in ("ON", "INSIDE")]


def beneath(graph, ids):
    graph["nodes"].append({"class_name": "box", "id": 2000})
    graph["edges"].append({"from_id": 2000, "relation_type": "BENEATH", "to_id": ids["bed"]})


def in_hand(graph, ids):
    graph["edges"].append({"from_id": ids["character"], "relation_type": "HOLDS_RH", "to_id": ids["mug"]})


def circle(graph, ids):
    graph["nodes"] += [{"class_name": "box", "id": 2000}, {"class_name": "box", "id": 2001}]
    graph["edges"] += [{"from_id": 2000, "relation_type": "INSIDE", "to_id": 2001},
                       {"from_id": 2001, "relation_type": "INSIDE", "to_id": 2000}]  # fmt: skip


def nowhere(graph, ids):
    graph["nodes"].append({"class_name": "box", "id": 2000})


def dangling(graph, ids):
    graph["edges"].append({"from_id": ids["mug"], "relation_type": "ON", "to_id": 99_999})


def twice(graph, ids):
    graph["nodes"].append(dict(graph["nodes"][-1]))


def unknown(graph, ids):
    graph["nodes"].append({"class_name": "flux capacitor", "id": 2000})


def renamed(graph, ids):
    next(node for node in graph["nodes"] if node["class_name"] == "fridge")["class_name"] = "sofa"


def flying(graph, ids):
    next(node for node in graph["nodes"] if node["class_name"] == "fridge")["states"].append("FLYING")


def roomless(graph, ids):
    graph["nodes"] = [node for node in graph["nodes"] if node["id"] != ids["kitchen"]]


@pytest.mark.parametrize(
    ("edit", "words"),
    [(both_states, "fridge (137) is both CLOSED and OPEN"), (two_places, "at once"), (circle, "on or in itself"),
     (nowhere, "box (2000) is nowhere"), (dangling, "there is no node 99999"), (twice, "two nodes have the id"),
     (unknown, "no class is called `flux capacitor`"), (renamed, "is a `fridge`, and the graph calls it `sofa`"),
     (on_and_in, "INSIDE bed"), (beneath, "no relation has that name"),
     (in_hand, "a graph puts nothing into hands"),
     (roomless, "lacks the room kitchen"), (flying, "fridge (137) has the unknown state FLYING")],
)  # fmt: skip
def test_graphs_that_contradict_themselves_change_nothing(client, edit, words):
    client.add_character(room="kitchen")
    before = client.graph()
    wanted = copy.deepcopy(before)
    edit(wanted, ids_of(before))
    reply = client.expand(wanted)
    assert not reply["success"] and words in reply["message"], reply["message"]
    assert client.graph() == before
