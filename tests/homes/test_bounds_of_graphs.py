"""Scene graphs of strangers: no size, place or number of things takes the memory or minutes."""

from __future__ import annotations

import json
import time

import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.homes.from_graph.graph_layout import MOST_STANDING
from hearth.homes.plans.plan_entries import MOST_ROOMS
from hearth.rendering.scene.routes import ways_of
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box, Node, from_release

WITHIN = 20.0
"""Seconds in which each is refused, on a busy machine."""


def node(number, class_name, category="x", center=(0, 1, 0), size=None):
    box = None if size is None else {"center": list(center), "size": list(size)}
    return {"id": number, "class_name": class_name, "category": category, "properties": [], "states": [],
            "prefab_name": None, "bounding_box": box}  # fmt: skip


def graph(*nodes):
    inside = [{"from_id": each["id"], "relation_type": "INSIDE", "to_id": 1} for each in nodes[1:]]
    return {"nodes": list(nodes), "edges": inside}


ROOM, PERSON = node(1, "kitchen", "Rooms", size=(6, 2, 6)), node(2, "character", "Characters", size=(0.5, 1.8, 0.5))
FRIDGE = node(3, "fridge", size=(1, 1, 1))

HUGE = {
    "a room of a kilometre": graph(node(1, "kitchen", "Rooms", size=(1000, 2, 1000)), PERSON, FRIDGE),
    "a room of 100 kilometres": graph(node(1, "kitchen", "Rooms", size=(1e5, 2, 1e5)), PERSON, FRIDGE),
    "a room of 1e300": graph(node(1, "kitchen", "Rooms", size=(1e300, 2, 1e300)), PERSON, FRIDGE),
    "a thing of 1e300": graph(ROOM, PERSON, node(3, "fridge", size=(1e300, 1, 1))),
    "a door of a kilometre": graph(ROOM, PERSON, node(3, "fridge", size=(1, 1, 1000))),
    "a thing far away": graph(ROOM, PERSON, node(3, "fridge", center=(1e9, 1, 0), size=(1, 1, 1))),
    "a negative size": graph(ROOM, PERSON, node(3, "fridge", size=(-1e9, 1, 1))),
    "rooms far apart": graph(ROOM, PERSON, FRIDGE, node(4, "bedroom", "Rooms", center=(9000, 1, 0), size=(5, 2, 5))),
}


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "p.txt"
    path.write_text("Open\n\n\n[Walk] <fridge> (1)\n")
    return path


def refusal(tmp_path, data, *words):
    """The status and the output of a command that is given a graph, and its seconds."""
    file = tmp_path / "g.json"
    file.write_text(json.dumps(data))
    before = time.monotonic()
    result = CliRunner().invoke(cli.app, [*map(str, words), "--graph", str(file)] if words[0] != "home" else
                                [*words[:2], str(file), *map(str, words[2:])])  # fmt: skip
    return result, time.monotonic() - before


@pytest.mark.parametrize("name", HUGE)
def test_a_home_that_is_too_large_is_a_fault_of_the_graph(tmp_path, program, name):
    for words in (
        ("render-program", program, "--out", tmp_path / "out"),
        ("home", "show", "--out", tmp_path / "o.svg"),
    ):
        result, seconds = refusal(tmp_path, HUGE[name], *words)
        assert result.exit_code == 1 and "BAD_GRAPH" in result.output and "metres" in result.output, result.output
        assert seconds < WITHIN


@pytest.mark.parametrize(
    "nodes",
    [
        [node(number, "cup") for number in range(2, MOST_STANDING + 3)],
        [node(number, "bedroom", "Rooms") for number in range(2, MOST_ROOMS + 3)],
        [node(number, "table") for number in range(2, 6000)],
    ],
    ids=["things", "rooms", "many things"],
)
def test_a_graph_without_boxes_of_too_many_things_is_a_fault(tmp_path, nodes):
    data = graph(node(1, "kitchen", "Rooms"), *nodes)
    result, seconds = refusal(tmp_path, data, "home", "show", "--out", tmp_path / "o.svg")
    assert result.exit_code == 1 and "FILE_TOO_LARGE" in result.output, result.output
    assert seconds < WITHIN


def test_the_floor_for_walks_is_refused_too_where_no_file_was_read():
    room = Node(1, "kitchen", "Rooms", box=Box((0, 1, 0), (1e5, 2, 1e5)))
    with pytest.raises(HearthError) as caught:
        ways_of([room], [room])
    assert caught.value.diagnostics[0].code is Code.BAD_GRAPH


def test_the_largest_home_and_the_scenes_of_a_simulator_are_read():
    room = node(1, "kitchen", "Rooms", center=(-3000, 1, 400), size=(500, 3, 499))
    assert from_release(graph(room)).nodes[0].box.size == (500, 3, 499)
