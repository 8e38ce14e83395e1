"""Goals are counted, and the counts follow the changes."""

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_worlds import random_graph, random_step

from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.goals import Goal
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.engine import act
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.literal_truth import holds
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

THINGS = ("GRABBABLE", "MOVABLE")
GRAPH = EnvironmentGraph(
    (
        Node(1, "kitchen", "Rooms"),
        Node(2, "character", "Characters"),
        Node(3, "plate", "Props", THINGS, ("DIRTY",)),
        Node(4, "plate", "Props", THINGS, ("CLEAN",)),
        Node(5, "table", "Furniture", ("SURFACES",)),
        Node(6, "dishwasher", "Appliances", ("CAN_OPEN", "CONTAINERS", "HAS_SWITCH"), ("CLOSED", "OFF")),
    ),
    (Edge(2, "INSIDE", 1), *(Edge(i, "INSIDE", 1) for i in (3, 4, 5, 6)), Edge(3, "INSIDE", 6), Edge(4, "ON", 5)),
)
SET_TABLE = Goal.of(
    (Literal.of("ON", "plate", "table"), 2), Literal.of("CLEAN", 3), Literal.of("HOLDS", "agent", "plate")
)


def start():
    return World.start(Home.from_graph(GRAPH, "kitchen", default()))


def step(action, *nodes):
    return Step(action, tuple(ObjectRef("thing", 1, node) for node in nodes))


def follow(world, progress, *steps):
    for instruction in steps:
        after = act(world, instruction)
        assert not isinstance(after, Failure), after.message()
        progress = progress.after(after, after.changes(world))
        world = after
    return world, progress


def test_counts_follow_what_is_done():
    progress = Progress.start(SET_TABLE, start())
    assert progress.counts == (1, 0, 0) and not progress.satisfied
    world, progress = follow(
        start(), progress, step("Walk", 6), step("Open", 6), step("Walk", 3), step("Grab", 3), step("Wash", 3)
    )
    assert progress.counts == (1, 1, 1)
    assert str(progress.unmet().counts[0][0]) == "ON(plate, table)" and progress.unmet().counts[0][1] == 1
    world, progress = follow(world, progress, step("Walk", 5), step("PutBack", 3, 5), step("Grab", 4))
    assert progress.counts == (1, 1, 1)
    world, progress = follow(world, progress, step("PutBack", 4, 5), step("Grab", 3))
    assert progress.counts == (1, 1, 1)
    assert not progress.satisfied


def test_a_satisfied_goal_has_nothing_unmet():
    goal = Goal.of(Literal.of("ON", "plate", "table"), Literal.of("INSIDE", 3, "dishwasher"))
    progress = Progress.start(goal, start())
    assert progress.satisfied and progress.unmet() == Goal(())


def test_two_books_in_two_hands_are_two():
    world = start()
    goal = Goal.of((Literal.of("HOLDS", "agent:0", "plate"), 2))
    progress = Progress.start(goal, world)
    _, progress = follow(world, progress, step("Walk", 5), step("Grab", 4), step("Walk", 6), step("Open", 6))
    assert progress.counts == (1,)


@pytest.mark.parametrize(
    ("predicate", "code", "suggestion"),
    [
        (Literal.of("ON", "plato", "table"), Code.UNKNOWN_OBJECT, "plant"),
        (Literal.of("UNDER", "plate", "table"), Code.SYNTAX, ""),
        (Literal.of("SHINY", "plate"), Code.SYNTAX, ""),
        (Literal.of("HOLDS", "agent:3", "plate"), Code.UNKNOWN_AGENT, ""),
        (Literal.of("HOLDS", f"agent:{'1' * 5000}", "plate"), Code.UNKNOWN_AGENT, ""),
        (Literal.of("ON", 99, "table"), Code.UNKNOWN_OBJECT, ""),
    ],
)
def test_a_goal_about_nothing_is_refused(predicate, code, suggestion):
    with pytest.raises(HearthError) as refused:
        Progress.start(Goal.of(predicate), start())
    (fault,) = refused.value.diagnostics
    assert fault.code is code and suggestion in fault.suggestion


ACTIONS = ["Walk", "Find", "Grab", "PutBack", "PutIn", "Open", "Close", "Wash", "Drop", "Sit", "TurnTo"]
GOAL = Goal.of(
    Literal.of("ON", "plate", "table"),
    Literal.of("INSIDE", "plate", "dishwasher"),
    Literal.of("CLOSE", "agent", "plate"),
    Literal.of("CLOSE", "plate", "agent"),
    Literal.of("HOLDS", "agent", "plate"),
    Literal.of("OPEN", "dishwasher"),
    Literal.of("FACING", "agent", 5),
    Literal.of("CLEAN", "plate"),
)


@given(st.lists(st.tuples(st.sampled_from(ACTIONS), st.integers(1, 6), st.integers(1, 6)), max_size=30))
def test_following_the_changes_is_looking_again(plan):
    world = start()
    progress = Progress.start(GOAL, world)
    for action, first, second in plan:
        nodes = (first, second) if action in ("PutBack", "PutIn") else (first,)
        after = act(world, step(action, *nodes))
        if isinstance(after, Failure):
            continue
        progress = progress.after(after, after.changes(world))
        world = after
        assert progress.counts == Progress.start(GOAL, world).counts


@pytest.mark.parametrize("text", ["not ON(plate, table)", "not ON(plate, table) and not [Watch](plate)"])
def test_clearing_a_table_is_done_when_nothing_of_the_class_is_on_it(text):
    """Followed or looked at anew, as a literal or over a run, it agrees with `holds`."""
    world = World.start(Home.from_graph(GRAPH, "", default()))
    goal = read_goal(text, world.home)
    (literal,) = (literal for literal, _ in goal)
    assert literal.negated and literal.name == "ON" and read_goal(str(goal), world.home) == goal
    progress = Progress.start(goal, world)
    assert str(progress.unmet()).startswith("not ON(plate, table)") and not progress.satisfied
    for action, *nodes in (("Walk", 5), ("Grab", 4), ("PutBack", 4, 5), ("Grab", 4)):
        step = Step(action, tuple(ObjectRef("thing", 1, node) for node in nodes))
        after = act(world, step)
        assert isinstance(after, World), after
        progress, world = progress.then(world, after, (step,)), after
        assert progress.satisfied == holds(literal, world) == Progress.start(goal, world).satisfied
    assert progress.satisfied and progress.fraction == 1.0 and not progress.unmet().counts


@pytest.mark.parametrize("seed", range(20))
def test_following_two_worlds_is_following_their_change(seed):
    chooser = random.Random(seed)
    graph = random_graph(chooser, characters=2)
    world = World.start(Home.from_graph(graph, "", default()))
    names = ["ON", "INSIDE", "CLOSE", "FACING", "HOLDS", "HOLDS_LH", "HOLDS_RH", "OPEN", "ON", "CLEAN", "SITTING"]
    classes = sorted(set(world.home.classes))
    literals = []
    for name in names * 2:
        count = 1 if name in ("OPEN", "CLEAN", "SITTING") else 2
        terms = tuple(chooser.choice(classes) for _ in range(count))
        literals.append(Literal(name, terms, chooser.random() < 0.3))
    goal = Goal.of(*literals, Literal.of("HOLDS", "agent", classes[0]))
    by_worlds = by_change = Progress.at(goal, world)
    for _ in range(60):
        after = act(world, random_step(chooser, graph, chooser.randrange(2)))
        if isinstance(after, Failure):
            continue
        by_worlds, by_change = by_worlds.then(world, after), by_change.after(after, after.changes(world))
        assert by_worlds.counts == by_change.counts == Progress.at(goal, after).counts
        world = after
