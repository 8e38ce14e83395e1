"""The language of preconditions and effects: reading, printing, and what it says of a world."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.facts import Facts
from oracles.formulas import changes, first_failure, holds

from hearth.kb.formula import (
    And,
    Count,
    Effect,
    Not,
    Or,
    Some,
    Term,
    free,
    parse_atom,
    parse_effect,
    parse_formula,
    predicates,
)
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.literals import Literal

names = st.sampled_from(["close", "ON", "holds", "hidden", "x_2"])
terms = st.builds(Term, st.sampled_from("aosxy")) | st.builds(
    Term, st.sampled_from("aos"), st.sampled_from(["room", "origin", "place"])
)
atoms = st.builds(Literal, names, st.lists(terms, min_size=1, max_size=3).map(tuple))
formulas = st.recursive(
    atoms,
    lambda inner: st.one_of(
        st.builds(lambda part: part._replace(negated=True) if isinstance(part, Literal) else Not(part), inner),
        st.builds(And, st.lists(inner.filter(lambda f: not isinstance(f, And)), min_size=2, max_size=3).map(tuple)),
        st.builds(Or, st.lists(inner.filter(lambda f: not isinstance(f, Or)), min_size=2, max_size=3).map(tuple)),
        st.builds(Some, st.sampled_from("xyz"), inner),
        st.builds(Count, st.sampled_from("xyz"), atoms, st.builds(Term, st.just("o"), st.just("seat_limit"))),
    ),
    max_leaves=6,
)


@given(formulas)
@settings(max_examples=60)
def test_printing_and_reading_a_formula_gives_it_back(formula):
    assert parse_formula(str(formula)) == formula


@settings(max_examples=60)
@given(atoms, st.booleans(), formulas, st.lists(st.sampled_from("xyz"), max_size=2, unique=True).map(tuple))
def test_printing_and_reading_an_effect_gives_it_back(atom, delete, condition, variables):
    effect = Effect(atom._replace(negated=delete), condition, variables)
    assert parse_effect(str(effect)) == effect
    bare = Effect(atom._replace(negated=delete))
    assert parse_effect(str(bare)) == bare


def test_the_actions_literals_print_as_they_read(knowledge):
    for action in knowledge.actions.values():
        for check in action.preconditions:
            assert parse_formula(str(check.formula)) == check.formula
        for effect in action.effects:
            assert parse_effect(str(effect)) == effect


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "in ``: expected a name but found `the end`"),
        ("close(a, o", "in `close(a, o`: expected ) but found `the end`"),
        ("close(a, o))", "in `close(a, o))`: `)` is too much"),
        ("close(a & o)", "in `close(a & o)`: expected ) but found `&`"),
        ("close(a, o) & ", "in `close(a, o) & `: expected a name but found `the end`"),
        ("some x close(a, x)", "in `some x close(a, x)`: expected : but found `close`"),
        ("close(a, 7)", "in `close(a, 7)`: cannot read `7)`"),
        ("count x: ON(x, o) < 3", "in `count x: ON(x, o) < 3`: cannot read `3`"),
    ],
)
def test_what_cannot_be_read_says_where(text, message):
    with pytest.raises(HearthError) as caught:
        parse_formula(text)
    assert caught.value.diagnostics[0].message == message


def test_variables_and_predicates_of_a_formula():
    formula = parse_formula("holds(a, o) & some k: ON(k, room(s)) & state(k, OPEN) & not class(x, knife)")
    assert free(formula) == {"a", "o", "s", "x"}
    assert predicates(formula) == {"holds", "ON", "state", "class"}
    assert free(parse_formula("count x: ON(x, o) < seat_limit(s)")) == {"o", "s"}
    assert parse_atom("close(a, x)").terms == (Term("a"), Term("x"))


ME, KITCHEN, FRIDGE, MILK, TABLE, CUP, COUCH, KNIFE = range(1, 9)


@pytest.fixture
def world():
    nodes = (
        Node(ME, "character", "Characters"),
        Node(KITCHEN, "kitchen", "Rooms"),
        Node(FRIDGE, "fridge", "Appliances", ("CAN_OPEN", "CONTAINERS"), ("CLOSED",)),
        Node(MILK, "milk", "Food", ("GRABBABLE", "DRINKABLE")),
        Node(TABLE, "table", "Furniture", ("SURFACES",)),
        Node(CUP, "cup", "Props", ("GRABBABLE",)),
        Node(COUCH, "couch", "Furniture", ("SITTABLE",)),
        Node(KNIFE, "butter_knife", "Props", ("GRABBABLE",)),
    )
    edges = [Edge(n, "INSIDE", KITCHEN) for n in (ME, FRIDGE, TABLE, COUCH)]
    edges += [Edge(MILK, "INSIDE", FRIDGE), Edge(CUP, "ON", TABLE), Edge(ME, "CLOSE", TABLE), Edge(TABLE, "CLOSE", ME)]
    edges += [Edge(ME, "HOLDS_LH", KNIFE), Edge(ME, "FACING", COUCH), Edge(COUCH, "FACING", FRIDGE)]
    return Facts.of(EnvironmentGraph(nodes, tuple(edges)))


@pytest.mark.parametrize(
    ("text", "thing", "expected"),
    [
        ("close(a, o)", TABLE, True),
        ("close(a, o)", CUP, True),
        ("CLOSE(a, o)", CUP, False),
        ("close(a, o)", MILK, False),
        ("facing(a, o)", COUCH, True),
        ("facing(a, o)", FRIDGE, True),
        ("facing(a, o)", TABLE, False),
        ("hidden(o)", MILK, True),
        ("hidden(o)", CUP, False),
        ("hidden(o)", FRIDGE, False),
        ("holds(a, o)", KNIFE, True),
        ("free_right(a) & not free_left(a) & free_hand(a)", CUP, True),
        ("same_room(a, o)", MILK, True),
        ("has_room(o)", CUP, False),
        ("same(room(a), room(o))", CUP, False),
        ("room_to_sit(o)", COUCH, True),
        ("count x: INSIDE(x, o) < seat_limit(o)", FRIDGE, False),
        ("some k: holds(a, k) & class_contains(k, knife)", CUP, True),
        ("class(o, milk) & property(o, DRINKABLE) & not is_room(o)", MILK, True),
        ("state(o, CLOSED)", FRIDGE, True),
        ("came_from(o, ON) | some p: REMEMBERS(o, p)", CUP, False),
    ],
)
def test_what_a_formula_says_of_a_world(knowledge, world, text, thing, expected):
    assert holds(knowledge, world, parse_formula(text), {"a": ME, "o": thing}) is expected


def test_an_action_fails_with_the_first_check_that_does_not_hold(knowledge, world):
    def code(name, *things, options=()):
        binding = {"a": ME, **dict(zip("os", things, strict=False))}
        failed = first_failure(knowledge, world, knowledge.actions[name], binding, frozenset(options))
        return failed and failed.code.value

    assert code("Grab", MILK) == "NOT_CLOSE"
    assert code("Grab", TABLE) == "NOT_AFFORDED"
    assert code("Grab", CUP) is None
    assert code("Close", FRIDGE) == "NOT_CLOSE"
    assert code("PutBack", CUP, TABLE) == "NOT_HOLDING"
    assert code("PutObjBack", CUP) == "NO_ORIGIN"
    assert code("Sleep") == "NOT_SITTING_OR_LYING"
    assert code("Walk", CUP) == "NO_ROOM"


def test_an_action_changes_what_its_effects_say(knowledge, world):
    grab = changes(knowledge, world, knowledge.actions["Grab"], {"a": ME, "o": CUP})
    assert ("ON", CUP, TABLE) in grab.removed
    assert {("HOLDS_RH", ME, CUP), ("INSIDE", CUP, KITCHEN), ("CLOSE", ME, CUP), ("CLOSE", CUP, ME)} <= grab.added
    assert grab.remembered == {CUP: ("ON", TABLE)}
    after = world.after(grab)
    back = changes(knowledge, after, knowledge.actions["PutObjBack"], {"a": ME, "o": CUP})
    home = after.after(back)
    assert TABLE in home.targets("ON", CUP)
    assert home.origin(CUP) is None
    assert world.origin(CUP) is None, "the old world is as it was"


def test_a_state_ends_its_opposite(knowledge, world):
    opened = world.after(changes(knowledge, world, knowledge.actions["Open"], {"a": ME, "o": FRIDGE}))
    assert opened.states[FRIDGE] == frozenset({"OPEN"})
    assert not holds(knowledge, opened, parse_formula("hidden(o)"), {"a": ME, "o": MILK})


def test_walking_takes_along_what_is_held_and_leaves_the_rest(knowledge, world):
    walk = changes(knowledge, world, knowledge.actions["Walk"], {"a": ME, "o": MILK})
    after = world.after(walk)
    assert set(after.targets("CLOSE", ME)) == {MILK, FRIDGE, KNIFE}
    assert after.targets("INSIDE", KNIFE) == {KITCHEN}
    assert after.targets("FACING", ME) == frozenset()
