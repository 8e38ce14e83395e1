"""The linter finds each fault that a graph can have, and none in our homes."""

from dataclasses import replace
from itertools import pairwise
from time import process_time
from types import SimpleNamespace

import pytest

from hearth.homes import library
from hearth.homes.geometry import Rect
from hearth.homes.lint import CHECKS, lint
from hearth.kb.loading.load import default
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node

ROOM, CHARACTER, CUP, FRIDGE, BOX = 1, 2, 3, 4, 5
NODES = (
    Node(ROOM, "kitchen", "Rooms"),
    Node(CHARACTER, "character", "Characters"),
    Node(CUP, "cup", "Props", ("GRABBABLE",), ("CLEAN",)),
    Node(FRIDGE, "fridge", "Appliances", ("CAN_OPEN", "CONTAINERS"), ("CLOSED",)),
    Node(BOX, "box", "Props", ("CAN_OPEN", "CONTAINERS"), ("CLOSED",)),
)
INSIDE = tuple(Edge(i, "INSIDE", ROOM) for i in (CHARACTER, CUP, FRIDGE, BOX))
SOUND = EnvironmentGraph(NODES, INSIDE)


def with_edges(*edges):
    return replace(SOUND, edges=INSIDE + tuple(Edge(*edge) for edge in edges))


def with_node(node):
    edges = () if node.category == "Rooms" else (Edge(node.id, "INSIDE", ROOM),)
    return EnvironmentGraph((*NODES, node), INSIDE + edges)


def walled_in(*boxes):
    """A kitchen of 6 m by 4 m that a wall of fridges parts; the smaller part has the box in it."""
    room = Node(ROOM, "kitchen", "Rooms", box=Box((3.0, 1.25, 2.0), (6.0, 2.5, 4.0)))
    wall = replace(NODES[3], box=Box((4.5, 0.9, 2.0), (0.6, 1.8, 4.0)))
    own = {node.id: node for node in (room, wall, *boxes)}
    return replace(SOUND, nodes=tuple(own.get(node.id, node) for node in NODES))


IN_THE_CORNER = Box((5.6, 0.3, 2.0), (0.5, 0.6, 0.5))

ODD = {
    "out of reach": (walled_in(replace(NODES[4], class_name="bed", box=IN_THE_CORNER)), Code.NO_PATH, "5"),
    "character in a pocket": (walled_in(replace(NODES[1], box=IN_THE_CORNER)), Code.NO_PATH, "2"),
    "two nodes of one id": (replace(SOUND, nodes=(*NODES, Node(CUP, "cup", "Props"))), Code.DUPLICATE, "3"),
    "unknown category": (with_node(Node(9, "cup", "Spaceship")), Code.BAD_GRAPH, "9"),
    "unknown class": (with_node(Node(9, "warpdrive", "Props")), Code.UNKNOWN_OBJECT, "9"),
    "unknown state": (with_node(Node(9, "cup", "Props", (), ("ENCHANTED",))), Code.BAD_GRAPH, "9"),
    "unknown property": (with_node(Node(9, "cup", "Props", ("MAGIC",))), Code.BAD_GRAPH, "9"),
    "edge to nowhere": (with_edges((CUP, "ON", 99)), Code.UNKNOWN_ID, "3 99"),
    "edge twice": (with_edges((CUP, "ON", BOX), (CUP, "ON", BOX)), Code.DUPLICATE, "3 5"),
    "unknown relation": (with_edges((CUP, "ABOVE", BOX)), Code.BAD_GRAPH, "3 5"),
    "on itself": (with_edges((CUP, "ON", CUP)), Code.LOOP, "3 3"),
    "exclusive states": (with_node(Node(9, "oven", "Appliances", (), ("ON", "OFF"))), Code.CONTRADICTION, "9"),
    "sits and lies": (with_node(Node(9, "character", "Characters", (), ("SITTING", "LYING"))), Code.CONTRADICTION, "9"),
    "no state": (with_node(Node(9, "oven", "Appliances", ("CAN_OPEN",))), Code.CONDITION_UNMET, "9"),
    "two rooms": (
        EnvironmentGraph((*NODES, Node(9, "bedroom", "Rooms")), (*INSIDE, Edge(CUP, "INSIDE", 9))),
        Code.BAD_GRAPH,
        "3 1 9",
    ),
    "two containers": (with_edges((CUP, "INSIDE", FRIDGE), (CUP, "INSIDE", BOX)), Code.BAD_GRAPH, "3 4 5"),
    "no room for it": (replace(SOUND, edges=INSIDE[:1] + INSIDE[2:]), Code.NO_ROOM, "3"),
    "no room at all": (EnvironmentGraph(), Code.NO_ROOM, ""),
    "room in a box": (
        EnvironmentGraph((*NODES, Node(9, "bedroom", "Rooms")), (*INSIDE, Edge(9, "INSIDE", BOX))),
        Code.BAD_GRAPH,
        "9",
    ),
    "circle": (with_edges((FRIDGE, "INSIDE", BOX), (BOX, "INSIDE", FRIDGE)), Code.LOOP, "4 5"),
    "circle of three": (
        with_edges((CUP, "ON", FRIDGE), (FRIDGE, "ON", BOX), (BOX, "ON", CUP)), Code.LOOP, "3 4 5",
    ),
    "between one room": (with_edges((BOX, "BETWEEN", ROOM)), Code.BAD_GRAPH, "5 1"),
    "held twice": (
        EnvironmentGraph(
            (*NODES, Node(9, "character", "Characters")),
            (*INSIDE, Edge(9, "INSIDE", ROOM), Edge(9, "HOLDS_LH", CUP), Edge(CHARACTER, "HOLDS_RH", CUP)),
        ),
        Code.CONFLICT,
        "3 2 9",
    ),
    "two in one hand": (with_edges((CHARACTER, "HOLDS_RH", CUP), (CHARACTER, "HOLDS_RH", BOX)), Code.CONFLICT, "2 3 5"),
    "a fridge holds": (with_edges((FRIDGE, "HOLDS_RH", CUP)), Code.BAD_GRAPH, "4 3"),
    "a table in a couch": (
        EnvironmentGraph(
            (*NODES, Node(9, "couch", "Furniture", ("SITTABLE",)), Node(10, "table", "Furniture", ("SURFACES",))),
            (*INSIDE, *(Edge(node, "INSIDE", ROOM) for node in (9, 10)), Edge(10, "INSIDE", 9)),
        ),
        Code.CONFLICT,
        "10 9",
    ),
    "close one way": (with_edges((CUP, "CLOSE", BOX)), Code.BAD_GRAPH, "3 5"),
}  # fmt: skip


@pytest.mark.parametrize("odd", ODD)
def test_each_oddity_is_found_once_with_its_nodes(odd):
    graph, code, ids = ODD[odd]
    faults = lint(graph, default(), file="odd.json")
    assert [(fault.code, fault.found, fault.file) for fault in faults] == [(code, ids, "odd.json")]


def test_cushions_on_a_couch_and_a_couch_on_a_mat_are_sound():
    things = (
        Node(9, "couch", "Furniture", ("SITTABLE",)),
        Node(10, "pillow", "Decor", ("GRABBABLE",)),
        Node(11, "mat", "Decor", ("SITTABLE",)),
        Node(12, "chair", "Furniture", ("GRABBABLE", "SITTABLE")),
    )
    inside = tuple(Edge(node.id, "INSIDE", ROOM) for node in things)
    held = (Edge(10, "ON", 9), Edge(9, "ON", 11), Edge(12, "ON", 9))
    assert lint(EnvironmentGraph((*NODES, *things), (*INSIDE, *inside, *held)), default()) == ()


def test_a_room_without_doors_is_found():
    graph = EnvironmentGraph(
        (*NODES, Node(9, "bedroom", "Rooms"), Node(10, "bathroom", "Rooms"), Node(11, "door", "Doors", (), ("OPEN",))),
        (*INSIDE, Edge(11, "INSIDE", ROOM), Edge(11, "BETWEEN", ROOM), Edge(11, "BETWEEN", 9)),
    )
    (fault,) = lint(graph, default())
    assert (fault.code, fault.found) == (Code.NO_PATH, "10")


def test_sound_graphs_have_no_faults():
    assert lint(SOUND, default()) == ()
    # A cup in a box in the fridge may say both.
    assert lint(with_edges((CUP, "INSIDE", BOX), (CUP, "INSIDE", FRIDGE), (BOX, "INSIDE", FRIDGE)), default()) == ()


@pytest.mark.parametrize("name", library.names())
def test_our_homes_lint_clean(name):
    assert lint(library.load_graph(name, default()), default()) == ()


def test_every_check_is_tried():
    tried = {check for graph, _, _ in ODD.values() for check, run in CHECKS.items() if list(run(view_of(graph)))}
    assert tried == set(CHECKS)


def view_of(graph):
    from hearth.homes.lint import View

    return View(graph, default())


def test_the_releases_homes_have_the_faults_they_are_known_for(real_data):
    faults = lint(library.load_graph("TrimmedTestScene1_graph", default(), real_data / "homes"), default())
    assert {fault.code for fault in faults} == {Code.CONDITION_UNMET, Code.LOOP, Code.CONFLICT}
    assert any("table (355) is INSIDE couch (352)" in fault.message for fault in faults)
    assert any("curtain (23) INSIDE curtain (24)" in fault.message for fault in faults)


@pytest.mark.parametrize("size", [(-4.0, 2.0, 4.0), (1e6, 2.0, 4.0), (float("nan"), 2.0, 4.0)])
def test_a_room_of_no_size_is_a_fault_and_no_memory(size):
    from hearth.homes.plans.walkable_floor import grid
    from hearth.schemas.diagnostics import HearthError

    class Plan:
        rooms = (SimpleNamespace(rect=Rect(0.0, 0.0, size[0], size[2])),)

    with pytest.raises(HearthError, match="metres"):
        grid(Plan, None, ())


LONG = tuple(range(10, 6010))


@pytest.mark.parametrize(
    "edges",
    [
        [(one, "INSIDE", other) for one, other in pairwise((*LONG[::-1], ROOM))],
        [(one, "INSIDE", other) for one, other in pairwise(LONG)],
        [(CUP, "INSIDE", other) for other in LONG],
        [edge for other in LONG for edge in ((CUP, "CLOSE", other), (other, "CLOSE", CUP))],
    ],
    ids=["a chain", "a chain in no room", "in many", "close to many"],
)
def test_large_graphs_take_time_by_their_size(edges):
    """A hundredth of the limit; by the square of its size, a chain took four times the limit."""
    boxes = tuple(Node(number, "box", "Props") for number in LONG)
    graph = EnvironmentGraph((*NODES, *boxes), (*INSIDE, *(Edge(*edge) for edge in edges)))
    began = process_time()
    lint(graph, default())
    assert process_time() - began < 3
