"""The engine's functions do what the literals of the knowledge say: every action, every combination of states."""

from __future__ import annotations

import random
from itertools import product

import pytest
from oracles.facts import Facts
from oracles.formulas import changes, first_failure
from small_worlds import random_graph, random_step

from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.engine import act
from hearth.simulation.rules import REPLAY
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

ME, ROOM, OTHER_ROOM, TABLE, BOX, SEAT, GUEST = 1, 2, 3, 4, 5, 6, 7
KNIFE, TOOL, PAN, THING = 8, 9, 10, 20

THINGS = {
    "any": ("GRABBABLE", "MOVABLE", "CAN_OPEN", "HAS_SWITCH", "HAS_PLUG", "LOOKABLE", "READABLE", "CLOTHES", "EATABLE"),
    "food": ("GRABBABLE", "EATABLE", "CUTTABLE", "POURABLE"),
    "bed": ("SITTABLE", "LIEABLE", "SURFACES"),
    "water": ("DRINKABLE", "POURABLE"),
    "hands_both": ("BODY_PART",),
    "man": ("PERSON",),
    "soap": (),
}
POSTURES = ((), ("SITTING",), ("LYING",))
HANDS = ("empty", "it", "knife", "it and a tool", "full")
PLACES = ("close", "loosely close", "far", "in the closed box", "in the open box")
SWITCHES = tuple(product(("OPEN", "CLOSED"), ("ON", "OFF"), ("PLUGGED_IN", "PLUGGED_OUT")))


class Plain(Facts):
    """Facts that remember places as the release does: rooms are in the set, and passed over."""

    def place(self, node):
        for relation in ("ON", "INSIDE", "CLOSE"):
            for found in hash_order(sorted(self.targets(relation, node))):
                if not self.is_room(found):
                    return relation, found
        return None


def hash_order(ids):
    found = set()
    for each in ids:
        found.add(each)
    return list(found)


def plain(graph):
    facts = Facts.of(graph)
    return Plain(facts.by_id, facts.forward, facts.backward, facts.states, facts.memories)


def small_home(name, posture, hands, place, switches):
    """A room with a table, a box, a seat that may face things, a guest; the thing in question somewhere."""
    box = "CLOSED" if place == "in the closed box" else "OPEN"
    nodes = (
        Node(ME, "character", "Characters", (), posture),
        Node(ROOM, "kitchen", "Rooms"),
        Node(OTHER_ROOM, "bedroom", "Rooms"),
        Node(TABLE, "table", "Furniture", ("SURFACES", "MOVABLE")),
        Node(BOX, "box", "Props", ("CAN_OPEN", "CONTAINERS", "RECIPIENT"), (box,)),
        Node(SEAT, "chair", "Furniture", ("SITTABLE", "SURFACES")),
        Node(GUEST, "food_apple", "Food", ("GRABBABLE", "EATABLE")),
        Node(KNIFE, "chef_knife", "Props", ("GRABBABLE",)),
        Node(TOOL, "rag", "Props", ("GRABBABLE",)),
        Node(PAN, "face", "BodyParts", ("BODY_PART",)),
        Node(THING, name, "Props", THINGS[name], switches),
    )
    edges = [Edge(each, "INSIDE", ROOM) for each in (ME, TABLE, BOX, SEAT, GUEST, KNIFE, TOOL, PAN)]
    edges += [Edge(SEAT, "FACING", THING), Edge(GUEST, "ON", THING), *both(ME, "CLOSE", TABLE), *both(ME, "CLOSE", BOX)]
    edges += [Edge(ME, "FACING", SEAT)] if hands != "full" else []
    if place.startswith("in the"):
        edges += [Edge(THING, "INSIDE", BOX), *both(ME, "CLOSE", THING)]
    else:
        edges += [Edge(THING, "INSIDE", ROOM if place != "far" else OTHER_ROOM)]
        edges += both(ME, "CLOSE", THING) if place == "close" else []
        edges += [Edge(THING, "ON", TABLE)] if place == "loosely close" else []
    edges += [Edge(ME, hand, held) for hand, held in held_in(hands)]
    return EnvironmentGraph(nodes, tuple(edges))


def both(first, relation, second):
    return [Edge(first, relation, second), Edge(second, relation, first)]


def held_in(hands):
    return {
        "empty": (),
        "it": (("HOLDS_RH", THING),),
        "knife": (("HOLDS_LH", KNIFE),),
        "it and a tool": (("HOLDS_LH", THING), ("HOLDS_RH", TOOL)),
        "full": (("HOLDS_RH", KNIFE), ("HOLDS_LH", TOOL)),
    }[hands]


def compare(knowledge, world, facts, step, where):
    """Do a step in both; the next worlds, or None when neither can do it."""
    action = knowledge.actions[step.action]
    binding = {"a": next(n for n, node in facts.by_id.items() if node.class_name == "character")}
    binding.update(zip("os", (ref.node for ref in step.objects), strict=False))
    failed = first_failure(knowledge, facts, action, binding)
    result = act(world, step, REPLAY)
    code = result.code if isinstance(result, Failure) else None
    if len(set(step.objects)) < len(step.objects):  # of no action in the table
        assert code == Code.NOT_AFFORDED, where
        return None
    assert code == (failed.code if failed else None), (where, str(failed and failed.formula))
    if failed:
        return None
    after = facts.after(changes(knowledge, facts, action, binding))
    assert {tuple(edge) for edge in result.edges()} == after.edges(), where
    pairs = {(node.id, state) for node in result.graph().nodes for state in node.states}
    assert pairs == {(node, state) for node, states in after.states.items() for state in states}, where
    return result, after


def step_of(action, *objects):
    return Step(action.name, tuple(ObjectRef(str(each), 1, each) for each in objects))


def situations(name):
    """All of posture, hands and place; and for the thing that has every state, all of its states in each posture."""
    hands, places = (HANDS, PLACES) if name == "any" else (HANDS[:2], PLACES[::2])
    yield from product(POSTURES, hands, places, SWITCHES[:1])
    if name == "any":
        yield from product(POSTURES, ("empty", "it"), ("close", "far"), SWITCHES[1:])


@pytest.mark.parametrize("name", THINGS)
def test_every_action_in_every_combination_of_states(knowledge, name):
    done = failed = 0
    executed = [action for action in knowledge.actions.values() if action.executed]
    for situation in situations(name):
        graph = small_home(name, *situation)
        world, facts = World.start(Home.from_graph(graph, "", knowledge)), plain(graph)
        for action in executed:
            for second in (TABLE, BOX)[: 2 if action.arity == 2 else 1]:
                objects = (THING, second)[: action.arity]
                where = (action.name, objects, name, situation)
                result = compare(knowledge, world, facts, step_of(action, *objects), where)
                done, failed = done + (result is not None), failed + (result is None)
    assert done > 150 and failed > 150


@pytest.mark.parametrize("block", range(2))
def test_random_programs_go_the_same_way(knowledge, block):
    done = 0
    for seed in range(block * 40, block * 40 + 40):
        rng = random.Random(seed)
        graph = random_graph(rng)
        world, facts = World.start(Home.from_graph(graph, "", knowledge)), plain(graph)
        for number in range(20):
            step = random_step(rng, graph)
            if not knowledge.actions[step.action].executed:
                continue
            result = compare(knowledge, world, facts, step, (seed, number, step))
            if result is not None:
                world, facts = result
                done += 1
    assert done > 100


def test_each_executed_action_succeeds_and_fails_somewhere(knowledge):
    outcomes = {action.name: set() for action in knowledge.actions.values() if action.executed}
    for name, posture, hands, place in product(THINGS, POSTURES, HANDS, PLACES):
        for switches in (SWITCHES[0], SWITCHES[7], SWITCHES[6]):
            graph = small_home(name, posture, hands, place, switches)
            facts = plain(graph)
            for action_name, seen in outcomes.items():
                if len(seen) < 2:
                    action = knowledge.actions[action_name]
                    binding = {"a": ME, **dict(zip("os", (THING, BOX)[: action.arity], strict=False))}
                    seen.add(first_failure(knowledge, facts, action, binding) is None)
    always = {"TurnTo"}
    never_here = {"PutObjBack", "PutOff"}  # nothing was grabbed or worn; random programs and the release cover them
    assert {name for name, seen in outcomes.items() if seen != {True, False}} == always | never_here
