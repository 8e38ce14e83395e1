"""Subgoals of the Embodied Agent Interface by its rules and ours, and its temporal logic, on a wheel of ours."""

from __future__ import annotations

import json

import pytest

from hearth.commands.challenge_eai import _difference
from hearth.interop.eai import subgoal_decomposition
from hearth.interop.eai.model_table import _add_chances
from hearth.interop.eai.operator_repair import names_in, read, repaired, with_constants
from hearth.interop.eai.subgoal_acts import ways
from hearth.interop.eai.task_worlds import task_world
from hearth.interop.eai.temporal_logic import Atom, Run, fulfilled, read_formula
from hearth.interop.eai.wheel import Answer, Wheel
from hearth.simulation.engine import act
from hearth.simulation.rules import EVOLVING_GRAPH
from tests.interop.test_eai import written

ME = "character.65"
GOAL = f"(exists x0. (TOUCH(x0) or WATCH(x0)) then HOLDS_RH({ME}, cup.12))"


@pytest.fixture
def wheel(tmp_path):
    return Wheel(written(tmp_path / "small.whl", goals={"2_1": GOAL, "1_1": "ON(television.10)"}))


@pytest.fixture
def walked(wheel, knowledge):
    """The run of a walk to the cup, and of grabbing it."""
    there = task_world(wheel, "2_1", knowledge)
    worlds = [there.start]
    for name in ("WALK", "GRAB"):
        step = subgoal_decomposition._step(name, ("cup.12",), knowledge)
        worlds.append(act(worlds[-1], step, EVOLVING_GRAPH))
    return Run(worlds, [("WALK", ("cup.12",)), ("GRAB", ("cup.12",))])


@pytest.mark.parametrize(
    ("text", "worlds"),
    [
        (f"NEXT_TO({ME}, cup.12)", 2),
        (f"NEXT_TO({ME}, cup.12) then HOLDS_RH({ME}, cup.12)", 3),
        (f"HOLDS_RH({ME}, cup.12) then NEXT_TO({ME}, sofa.11)", 0),
        ("WALK(cup.12)", 1),
        ("GRAB(cup.12) then WALK(cup.12)", 0),
        ("exists x. (GRAB(x) or TOUCH(x))", 2),
        (f"exists x. (WALK(x)) then HOLDS_RH({ME}, cup.12)", 3),
        (f"not NEXT_TO({ME}, cup.12) and ONTOP(cup.12, table.13)", 1),
        (f"HOLDS_RH({ME}, cup.99) or HOLDS_RH({ME}, cup.12)", 3),
        (f"HOLDS_RH({ME}, plate.12)", 0),
        ("SITTING(television.10)", 0),
    ],
)
def test_formulas_on_a_run(walked, text, worlds):
    assert fulfilled(read_formula(text), walked) == worlds


@pytest.mark.parametrize("text", ["", "ON", "ON(", "ON(a) then", "ON(a) ON(b)", "and ON(a)", "(" * 300, "ON(a", "?"])
def test_what_is_no_formula_is_refused(text):
    with pytest.raises(ValueError, match=r"expected|unexpected|deep"):
        read_formula(text)


def test_acts_of_subgoals(wheel, knowledge):
    start = task_world(wheel, "2_1", knowledge).start
    assert ways(Atom("ONTOP", (ME, "sofa.11")), start, ME) == [
        [("FIND", ("sofa.11",)), ("SIT", ("sofa.11",))], [("FIND", ("sofa.11",)), ("LIE", ("sofa.11",))],
    ]  # fmt: skip
    (put,) = ways(Atom("ONTOP", ("cup.12", "table.13")), start, ME)
    assert [name for name, _ in put] == ["FIND", "GRAB", "FIND", "PUTBACK"]
    assert ways(Atom("SITTING", (ME,)), start, ME) == []
    assert [name for name, _ in ways(Atom("READ", ("cup.12",)), start, ME)[0]] == ["FIND", "GRAB", "READ"]


@pytest.mark.parametrize(
    ("subgoals", "theirs", "ours", "fault"),
    [
        ([f"HOLDS_RH({ME}, cup.12)", "TOUCH(cup.12)"], (True, True), (True, True), ""),
        # The formula says nothing of grabbing, which the goal wants before touching.
        (["TOUCH(cup.12)", f"HOLDS_RH({ME}, cup.12)"], (True, True), (True, False), ""),
        ([f"HOLDS_RH({ME}, cup.12)"], (True, False), (True, False), ""),
        (["TOUCH(cup.12)", "SITTING(sofa.11)"], (True, False), (False, False), ""),
        (["FLY(cup.12)"], (False, False), (False, False), "hallucination"),
        (["TOUCH(cup.12, sofa.11)"], (False, False), (False, False), "hallucination"),
        (["TOUCH(cup.99)"], (False, False), (False, False), "hallucination"),
        (["TOUCH(cup)"], (False, False), (False, False), "parsing"),
        (["not ON(television.10)"], (False, False), (True, False), "parsing"),
        (["ON(television.10)"], (False, False), (False, False), "missing step"),  # it is not plugged in
    ],
)
def test_verdicts_on_subgoals(wheel, knowledge, subgoals, theirs, ours, fault):
    answer = Answer("2_1", json.dumps({"output": subgoals}))
    found = subgoal_decomposition.judged(wheel, answer, knowledge)
    assert (found.executed, found.succeeds) == theirs
    assert (found.runs, found.reaches) == ours
    assert found.fault == fault


@pytest.mark.parametrize("text", ["no JSON", '{"output": 3}', '{"output": []}', "{" * 50])
def test_an_answer_without_subgoals(wheel, knowledge, text):
    found = subgoal_decomposition.judged(wheel, Answer("1_1", text), knowledge)
    assert not found.executed and not found.runs and found.fault == "parsing"
    assert subgoal_decomposition.shares([found]) == (0.0, 0.0, 0.0, 0.0)


def test_operators_are_read_as_earlier_planners_read_them():
    found = repaired(
        "(?c - character ?o - object)",
        "(and (near ?c ?o) (inside ?o ?room))",
        "(and (held ?o) (not (inside ?o ?room)))",
    )
    assert found == ("(?c - character ?o - object)", "(and (near ?c ?o) (hearth-never))", "(and (held ?o))")
    assert repaired("(?o)", "(not (near ?o ?any))", "(when (near ?any ?o) (held ?o))")[1:] == (
        "(not (hearth-never))", "(when (hearth-never) (held ?o))",
    )  # fmt: skip
    bound = "(exists (?r - object) (inside ?o ?r))"
    assert repaired("(?o)", bound, "(held ?o)") == ("(?o)", bound, "(held ?o)")
    for condition in ("(inside ?o ?room - object)", "((near ?o) (near ?any))", "(and ((near ?any)))"):
        assert repaired("(?o)", condition, condition)[1:] == (condition, condition)
    assert repaired("(?o", "(a)", "(b)") == ("(?o", "(a)", "(b)")
    assert list(names_in(read("(and (inside ?c bathroom) (forall (?x - object) (near ?x sink)))"))) == [
        "bathroom", "sink",
    ]  # fmt: skip
    domain, problem = with_constants("(define (:predicates (a)))", "(:objects cup - object)", ["cup", "moon"])
    assert "(:constants cup - object moon - object)" in domain and problem == "(:objects)"


def test_what_the_interface_leaves_to_chance(wheel, knowledge):
    text = json.dumps({"output": ["ON(moon.1) or PLUGGED_IN(television.10)", "ON(television.10)"]})
    answer = Answer("1_1", text)
    assert subgoal_decomposition.judged(wheel, answer, knowledge)[1:3] == (False, False)
    assert subgoal_decomposition.outcomes(wheel, answer, knowledge) == {(False, False), (True, True)}
    rows = [{"measure": "success"}, {"measure": "execution"}]
    sure = Answer("1_1", json.dumps({"output": ["PLUGGED_IN(television.10)", "ON(television.10)"]}))
    verdicts = {name: subgoal_decomposition.outcomes(wheel, each, knowledge)
                for name, each in (("a", answer), ("b", sure))}  # fmt: skip
    _add_chances(rows, verdicts)
    assert all((row["low"], row["high"], row["by_chance"]) == (50.0, 100.0, ["a"]) for row in rows)
    row = {**rows[0], "model": "M", "published": 80.0, "theirs": 50.0}
    assert _difference(row).endswith("which gives 50.0 to 100.0; it decides the tasks a")
