"""Each executed action in a small home: what it changes, and every way it can fail, in the order of its checks."""

from __future__ import annotations

import pytest
from action_home import IDS, NODES, after, home, said, step
from small_worlds import bound_step, node

from hearth.kb.loading.load import default
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.simulation.actions.registry import ACTIONS
from hearth.simulation.engine import act
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

IN_BEDROOM = "Walk chair"

CHANGES = {
    "Walk": [
        (
            "",
            "Walk table",
            "+character CLOSE table; +character CLOSE cup; +character CLOSE knife; +character CLOSE plate;"
            " +character CLOSE face",
        ),
        ("", "Walk juice", "+character CLOSE juice; +character CLOSE fridge; +character CLOSE face"),
        (
            "Walk table; TurnTo cup",
            "Walk bed",
            "-character CLOSE table; -character CLOSE cup; -character CLOSE knife;"
            " -character CLOSE plate; -character FACING cup; -character INSIDE kitchen; +character INSIDE bedroom;"
            " +character CLOSE bed",
        ),
        (
            "Walk cup; Grab cup; Walk kitchen",
            "Walk bedroom",
            "-character CLOSE kitchen; +character CLOSE bedroom;"
            " -character INSIDE kitchen; +character INSIDE bedroom; -cup INSIDE kitchen; +cup INSIDE bedroom",
        ),
    ],
    "Run": [("", "Run cup", "+character CLOSE cup; +character CLOSE face")],
    "Find": [
        ("", "Find cup", "+character CLOSE cup; +character CLOSE face"),
        ("Walk table; TurnTo cup", "Find apple", "-character FACING cup; +character CLOSE apple"),
    ],
    "Sit": [(IN_BEDROOM, "Sit chair", "+character ON chair; +character FACING television; +character SITTING")],
    "Lie": [
        ("Walk bed", "Lie bed", "+character ON bed; +character LYING"),
        ("Walk bed; Sit bed", "Lie bed", "-character SITTING; +character LYING"),
    ],
    "StandUp": [("Walk bed; Lie bed", "StandUp", "-character LYING; -character ON bed")],
    "Sleep": [("Walk bed; Lie bed", "Sleep", "")],
    "WakeUp": [("Walk bed; Sit bed", "WakeUp", "")],
    "Grab": [
        ("Walk table", "Grab cup", "-cup ON table; -table CLOSE cup; +character HOLDS_RH cup"),
        ("Walk table; Grab cup", "Grab knife", "-knife ON table; +character HOLDS_LH knife"),
        (
            "Walk fridge; Open fridge",
            "Grab juice",
            "-juice INSIDE fridge; -fridge CLOSE juice; +character CLOSE juice; +character HOLDS_RH juice",
        ),
        ("Walk cup; Grab cup", "Grab cup", "+character HOLDS_LH cup"),
    ],
    "PutBack": [
        (
            "Walk cup; Grab cup; Walk fridge",
            "PutBack cup fridge",
            "-character HOLDS_RH cup; +cup ON fridge; +cup CLOSE fridge",
        ),
        (
            "Walk cup; Grab cup; Grab cup",
            "PutBack cup table",
            "-character HOLDS_RH cup; -character HOLDS_LH cup; +cup ON table; +table CLOSE cup",
        ),
    ],
    "PutIn": [
        (
            "Walk cup; Grab cup; Walk fridge; Open fridge",
            "PutIn cup fridge",
            "-character HOLDS_RH cup; +cup INSIDE fridge; +cup CLOSE fridge",
        )
    ],
    "PutObjBack": [
        (
            "Walk cup; Grab cup; Walk table",
            "PutObjBack cup",
            "-character HOLDS_RH cup; +cup ON table; +table CLOSE cup",
        ),
        (
            "Walk fridge; Open fridge; Grab juice",
            "PutObjBack juice",
            "-character HOLDS_RH juice; +juice INSIDE fridge; +fridge CLOSE juice",
        ),
    ],
    "Drop": [("Walk cup; Grab cup", "Drop cup", "-character HOLDS_RH cup")],
    "Release": [("Walk cup; Grab cup", "Release cup", "-character HOLDS_RH cup")],
    "Open": [("Walk fridge", "Open fridge", "-fridge CLOSED; +fridge OPEN")],
    "Close": [("Walk window", "Close window", "-window OPEN; +window CLOSED")],
    "SwitchOn": [("Walk fridge", "SwitchOn fridge", "-fridge OFF; +fridge ON")],
    "SwitchOff": [("Walk toaster", "SwitchOff toaster", "-toaster ON; +toaster OFF")],
    "PlugIn": [("Walk lamp", "PlugIn lamp", "-lamp PLUGGED_OUT; +lamp PLUGGED_IN")],
    "PlugOut": [("Walk toaster", "PlugOut toaster", "-toaster PLUGGED_IN; +toaster PLUGGED_OUT")],
    "TurnTo": [("TurnTo cup", "TurnTo bed", "-character FACING cup; +character FACING bed")],
    "LookAt": [("TurnTo cup", "LookAt cup", ""), ("TurnTo chair", "LookAt television", "")],
    "PointAt": [("TurnTo bed", "PointAt bed", "")],
    "Watch": [
        ("Walk chair; TurnTo picture", "Watch picture", ""),
        ("Walk television; SwitchOn television; Walk chair; Sit chair", "Watch television", ""),
    ],
    "Read": [("Walk book; Grab book", "Read book", "")],
    "Drink": [("Walk cup; Grab cup", "Drink cup", "")],
    "Eat": [("Walk bread", "Eat bread", ""), ("Walk plate", "Eat plate", "")],
    "Cut": [("Walk table; Grab knife", "Cut apple", "")],
    "Pour": [
        ("Walk fridge; Open fridge; Grab juice; Walk table", "Pour juice cup", "+juice INSIDE cup"),
        ("Walk water; Grab water; Walk table", "Pour water cup", "+water INSIDE cup; -character HOLDS_RH water"),
    ],
    "Type": [("Walk keyboard", "Type keyboard", ""), ("Walk fridge", "Type fridge", "")],
    "Touch": [("Walk cup", "Touch cup", "")],
    "Push": [("Walk cup", "Push cup", "")],
    "Pull": [(IN_BEDROOM, "Pull chair", ""), ("Walk sponge", "Pull sponge", "")],
    "Move": [(IN_BEDROOM, "Move chair", ""), ("Walk sponge", "Move sponge", "")],
    "Wipe": [("Walk sponge; Grab sponge; Walk cup", "Wipe cup", "-cup DIRTY; +cup CLEAN")],
    "Wash": [("Walk cup", "Wash cup", "-cup DIRTY; +cup CLEAN")],
    "Rinse": [("Walk knife", "Rinse knife", "+knife CLEAN")],
    "Scrub": [("Walk cup", "Scrub cup", "-cup DIRTY; +cup CLEAN")],
    "Squeeze": [("Walk sponge", "Squeeze sponge", ""), ("Walk dress", "Squeeze dress", "")],
    "PutOn": [("Walk dress; Grab dress", "PutOn dress", "-character HOLDS_RH dress; +dress ON character")],
    "PutOff": [("Walk dress; Grab dress; PutOn dress", "PutOff dress", "-dress ON character")],
    "Greet": [("", "Greet man", "")],
}

BOTH_HANDS = "Walk table; Grab cup; Grab plate"

FAILURES = [
    ("Walk bed; Sit bed", "Walk cup", Code.SITTING, ["cup"]),
    ("Walk bed; Lie bed", "Walk cup", Code.LYING, ["cup"]),
    ("Walk bed; Lie bed", "Run cup", Code.LYING, ["cup"]),
    ("", "Walk moon", Code.NO_ROOM, ["moon"]),
    ("Walk door; Close door; Walk kitchen", "Walk bed", Code.DOOR_CLOSED, ["door", "bedroom"]),
    ("Walk door; Close door; Walk kitchen", "Find bed", Code.DOOR_CLOSED, ["door", "bedroom"]),
    ("Walk bed; Sit bed", "Find cup", Code.NOT_CLOSE, ["cup"]),
    ("", "Find face", Code.NOT_CLOSE, ["face"]),
    ("", "Find moon", Code.NO_ROOM, ["moon"]),
    ("", "Sit chair", Code.NOT_CLOSE, ["chair"]),
    ("Walk bed; Sit bed", "Sit bed", Code.SITTING, ["bed"]),
    ("Walk cup", "Sit cup", Code.NOT_AFFORDED, ["cup"]),
    ("Walk book; Grab book; Walk chair; PutBack book chair", "Sit chair", Code.OCCUPIED, ["chair", "book"]),
    ("Walk bench", "Lie bench", Code.OCCUPIED, ["bench", "book", "dress"]),
    ("", "Lie bed", Code.NOT_CLOSE, ["bed"]),
    ("Walk bed; Lie bed", "Lie bed", Code.LYING, ["bed"]),
    ("Walk cup", "Lie cup", Code.NOT_AFFORDED, ["cup"]),
    ("", "StandUp", Code.NOT_SITTING_OR_LYING, []),
    ("", "Sleep", Code.NOT_SITTING_OR_LYING, []),
    ("", "WakeUp", Code.NOT_SITTING_OR_LYING, []),
    ("", "Grab table", Code.NOT_AFFORDED, ["table"]),
    ("", "Grab cup", Code.NOT_CLOSE, ["cup"]),
    ("Walk fridge", "Grab juice", Code.INSIDE_CLOSED, ["juice", "fridge"]),
    ("Walk chair; Sit chair", "Grab chair", Code.SITTING, ["chair"]),
    (BOTH_HANDS, "Grab knife", Code.NO_FREE_HAND, ["knife", "cup", "plate"]),
    ("Walk cup", "PutBack cup table", Code.NOT_HOLDING, ["cup"]),
    ("Walk cup; Grab cup; Walk kitchen", "PutBack cup bed", Code.NOT_CLOSE, ["bed"]),
    ("Walk cup", "PutIn cup fridge", Code.NOT_HOLDING, ["cup"]),
    ("Walk cup; Grab cup", "PutIn cup fridge", Code.NOT_CLOSE, ["fridge"]),
    ("Walk cup; Grab cup; Walk fridge", "PutIn cup fridge", Code.IS_CLOSED, ["fridge"]),
    ("Walk cup; Grab cup; Walk box", "PutIn cup box", Code.IS_CLOSED, ["box"]),
    ("Walk cup", "PutObjBack cup", Code.NO_ORIGIN, ["cup"]),
    (
        "Walk cup; Grab cup; PutBack cup table; Walk knife; Grab knife; PutObjBack knife",
        "PutObjBack knife",
        Code.NO_ORIGIN,
        ["knife"],
    ),
    ("Walk cup; Grab cup; PutBack cup table", "PutObjBack cup", Code.NOT_HOLDING, ["cup"]),
    ("Walk cup; Grab cup; Walk bed", "PutObjBack cup", Code.NOT_CLOSE, ["table"]),
    ("Walk fridge; Open fridge; Grab juice; Close fridge", "PutObjBack juice", Code.IS_CLOSED, ["fridge"]),
    ("Walk cup", "Drop cup", Code.NOT_HOLDING, ["cup"]),
    ("Walk cup", "Release cup", Code.NOT_HOLDING, ["cup"]),
    ("", "Open cup", Code.NOT_AFFORDED, ["cup"]),
    ("", "Open fridge", Code.NOT_CLOSE, ["fridge"]),
    (BOTH_HANDS + "; Walk fridge", "Open fridge", Code.NO_FREE_HAND, ["fridge", "cup", "plate"]),
    ("Walk window", "Open window", Code.IS_OPEN, ["window"]),
    ("Walk box", "Open box", Code.NOT_OPENABLE_STATE, ["box"]),
    ("Walk toaster", "Open toaster", Code.IS_ON, ["toaster"]),
    ("", "Close cup", Code.NOT_AFFORDED, ["cup"]),
    ("", "Close window", Code.NOT_CLOSE, ["window"]),
    ("Walk fridge", "Close fridge", Code.IS_CLOSED, ["fridge"]),
    ("Walk box", "Close box", Code.NOT_OPENABLE_STATE, ["box"]),
    ("", "SwitchOn cup", Code.NOT_AFFORDED, ["cup"]),
    ("", "SwitchOn fridge", Code.NOT_CLOSE, ["fridge"]),
    ("Walk toaster", "SwitchOn toaster", Code.IS_ON, ["toaster"]),
    ("Walk lamp", "SwitchOn lamp", Code.IS_UNPLUGGED, ["lamp"]),
    ("", "SwitchOff cup", Code.NOT_AFFORDED, ["cup"]),
    ("", "SwitchOff toaster", Code.NOT_CLOSE, ["toaster"]),
    ("Walk lamp", "SwitchOff lamp", Code.IS_OFF, ["lamp"]),
    ("", "PlugIn cup", Code.NOT_AFFORDED, ["cup"]),
    ("", "PlugIn lamp", Code.NOT_CLOSE, ["lamp"]),
    (BOTH_HANDS + "; Walk lamp", "PlugIn lamp", Code.NO_FREE_HAND, ["lamp", "cup", "plate"]),
    ("Walk toaster", "PlugIn toaster", Code.IS_PLUGGED, ["toaster"]),
    ("", "PlugOut cup", Code.NOT_AFFORDED, ["cup"]),
    ("", "PlugOut toaster", Code.NOT_CLOSE, ["toaster"]),
    (BOTH_HANDS + "; Walk toaster", "PlugOut toaster", Code.NO_FREE_HAND, ["toaster", "cup", "plate"]),
    ("Walk lamp", "PlugOut lamp", Code.IS_UNPLUGGED, ["lamp"]),
    ("", "LookAt cup", Code.NOT_FACING, ["cup"]),
    ("Walk cup", "PointAt cup", Code.NOT_FACING, ["cup"]),
    ("", "Watch cup", Code.NOT_AFFORDED, ["cup"]),
    ("TurnTo picture", "Watch picture", Code.NOT_IN_ROOM, ["picture"]),
    (IN_BEDROOM, "Watch picture", Code.NOT_FACING, ["picture"]),
    ("Walk bed; Sit bed; TurnTo chair", "Watch television", Code.NOT_FACING, ["television"]),
    ("Walk chair; TurnTo television", "Watch television", Code.IS_OFF, ["television"]),
    ("", "Read cup", Code.NOT_AFFORDED, ["cup"]),
    ("Walk book", "Read book", Code.NOT_HOLDING, ["book"]),
    ("", "Drink knife", Code.NOT_AFFORDED, ["knife"]),
    ("Walk cup", "Drink cup", Code.NOT_HOLDING, ["cup"]),
    ("", "Eat bread", Code.NOT_CLOSE, ["bread"]),
    ("Walk cup", "Eat cup", Code.NOTHING_TO_EAT, ["cup"]),
    (BOTH_HANDS, "Cut bread", Code.NO_FREE_HAND, ["bread", "cup", "plate"]),
    ("", "Cut apple", Code.NOT_CLOSE, ["apple"]),
    ("Walk bread", "Cut bread", Code.NOT_AFFORDED, ["bread"]),
    ("Walk apple", "Cut apple", Code.NOT_HOLDING, ["apple"]),
    ("", "Pour knife cup", Code.NOT_AFFORDED, ["knife"]),
    ("", "Pour juice table", Code.NOT_AFFORDED, ["table"]),
    ("Walk fridge", "Pour juice cup", Code.NOT_HOLDING, ["juice"]),
    ("Walk water; Grab water", "Pour water cup", Code.NOT_CLOSE, ["cup"]),
    ("", "Type keyboard", Code.NOT_CLOSE, ["keyboard"]),
    ("Walk cup", "Type cup", Code.NOT_AFFORDED, ["cup"]),
    ("", "Touch cup", Code.NOT_CLOSE, ["cup"]),
    ("Walk fridge", "Touch juice", Code.INSIDE_CLOSED, ["juice", "fridge"]),
    ("", "Push cup", Code.NOT_CLOSE, ["cup"]),
    ("Walk fridge", "Push juice", Code.INSIDE_CLOSED, ["juice", "fridge"]),
    (BOTH_HANDS, "Push knife", Code.NO_FREE_HAND, ["knife", "cup", "plate"]),
    ("", "Pull cup", Code.NOT_AFFORDED, ["cup"]),
    ("", "Pull sponge", Code.NOT_CLOSE, ["sponge"]),
    (BOTH_HANDS + "; Walk sponge", "Pull sponge", Code.NO_FREE_HAND, ["sponge", "cup", "plate"]),
    ("", "Move cup", Code.NOT_AFFORDED, ["cup"]),
    ("", "Move sponge", Code.NOT_CLOSE, ["sponge"]),
    (BOTH_HANDS + "; Walk sponge", "Move sponge", Code.NO_FREE_HAND, ["sponge", "cup", "plate"]),
    ("", "Wipe cup", Code.NOT_CLOSE, ["cup"]),
    ("Walk cup", "Wipe cup", Code.NOT_HOLDING, ["cup"]),
    ("", "Wash cup", Code.NOT_CLOSE, ["cup"]),
    ("", "Rinse cup", Code.NOT_CLOSE, ["cup"]),
    ("", "Scrub cup", Code.NOT_CLOSE, ["cup"]),
    (BOTH_HANDS + "; Walk sponge", "Squeeze sponge", Code.NO_FREE_HAND, ["sponge", "cup", "plate"]),
    ("", "Squeeze sponge", Code.NOT_CLOSE, ["sponge"]),
    ("Walk cup", "Squeeze cup", Code.NOT_AFFORDED, ["cup"]),
    ("Walk dress", "PutOn dress", Code.NOT_HOLDING, ["dress"]),
    ("Walk cup; Grab cup", "PutOn cup", Code.NOT_AFFORDED, ["cup"]),
    ("Walk dress", "PutOff dress", Code.NOT_WORN, ["dress"]),
    ("Walk cup; Grab cup; Walk character; PutBack cup character", "PutOff cup", Code.NOT_AFFORDED, ["cup"]),
    ("", "Greet cup", Code.NOT_AFFORDED, ["cup"]),
]


def test_every_executed_action_is_tested():
    assert CHANGES.keys() == ACTIONS.keys()


@pytest.mark.parametrize(("before", "text", "expected"), [c for cases in CHANGES.values() for c in cases], ids=str)
def test_an_action_changes_this_and_nothing_else(before, text, expected):
    start = after(before)
    end = act(start, step(text))
    assert isinstance(end, World), end
    assert said(end.changes(start)) == {part.strip() for part in expected.split(";") if part}


@pytest.mark.parametrize(("before", "text", "code", "objects"), FAILURES, ids=str)
def test_an_action_that_cannot_be_done_says_why(before, text, code, objects):
    start = after(before)
    graph = start.graph()
    failure = act(start, step(text))
    assert isinstance(failure, Failure), failure
    assert failure.code is code
    assert [NODES[name].id for name in objects] == list(failure.objects)
    assert list(failure.names) == objects
    assert failure.action == step(text).action
    assert failure.expected
    assert failure.actual
    assert start.graph() == graph


def test_every_check_of_the_knowledge_is_failed_once():
    """Each code that the actions file gives for an action is among the failures above."""
    checks = {(name, condition.code) for name in ACTIONS for condition in default().actions[name].preconditions}
    failed = {(step(text).action, code) for _, text, code, _ in FAILURES}
    # Run is Walk, and what can be shifted is checked by Push.
    same = {("Run", code) for code in (Code.SITTING, Code.NO_ROOM)} | {
        ("Pull", Code.INSIDE_CLOSED),
        ("Move", Code.INSIDE_CLOSED),
        ("Grab", Code.LYING),  # of nothing here that one can lie on (test_leaving_seats)
    }
    assert checks - failed == same


def test_a_closed_door_can_be_walked_to_from_either_side():
    for before, room in (("", "kitchen"), (IN_BEDROOM, "bedroom")):
        world = after(before, f"Walk door; Close door; Walk {room}")
        world = act(world, step("Walk door"))
        assert Edge(IDS["character"], "INSIDE", IDS[room]) in world.edges()
        assert isinstance(act(world, step("Open door")), World)


def test_what_a_program_may_not_ask():
    world = World.start(home())
    unbound = act(world, bound_step("Walk", [node(99, "cup")]))
    assert (unbound.code, unbound.objects) == (Code.UNBOUND, (99,))
    assert act(world, bound_step("Fly", [NODES["cup"]])).code is Code.UNKNOWN_ACTION
    assert act(world, bound_step("Brush", [NODES["cup"]])).code is Code.NOT_SIMULATED
    assert act(world, bound_step("Walk", [NODES["cup"]], agent=1)).code is Code.UNKNOWN_AGENT


def test_who_sits_faces_all_that_the_seat_faces():
    """Things and people, of whom some are characters."""
    edges = (Edge(2, "INSIDE", 1), Edge(3, "INSIDE", 1), Edge(4, "INSIDE", 1), Edge(4, "FACING", 3))
    nodes = [node(n, name) for n, name in enumerate(("kitchen", "character", "character", "chair", "chair"), 1)]
    world = World.start(Home.from_graph(EnvironmentGraph(tuple(nodes), (*edges, Edge(5, "INSIDE", 1))), "", default()))
    faced = {}
    for chair in (nodes[3], nodes[4]):
        sat = act(act(world, bound_step("Walk", [chair])), bound_step("Sit", [chair]))
        faced[chair.id] = [edge.target for edge in sat.edges() if edge.source == 2 and edge.relation == "FACING"]
    assert faced == {4: [3], 5: []}


def test_who_walks_to_a_table_is_close_to_what_was_put_on_it():
    """As it was at the start, and after things were moved."""
    near = after("Walk apple", "Grab apple", "Walk table", "PutBack apple table", "Walk chair", "Walk table")
    close = {edge.target for edge in near.edges() if edge.source == IDS["character"] and edge.relation == "CLOSE"}
    assert {IDS["apple"], IDS["cup"], IDS["knife"], IDS["plate"]} <= close and IDS["bread"] not in close
