"""The interface's tasks for our own homes: proved goals, prompts with fingerprints, answers judged."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.datasets.export.pddl_domain import planning_domain
from hearth.grounding.grounded_run import attempt
from hearth.homes.library import load_graph
from hearth.interop.eai.own_scores import operator_counts, subgoal_verdict
from hearth.interop.eai.own_tasks import (
    ASKED,
    actions_of,
    fingerprint,
    interpretation_counts,
    own_task,
    plan_verdict,
    start_of,
)
from hearth.schemas.syntax import parse_programs, print_lines
from hearth.simulation.world.home import Home

MILK = "Milk\nI take the milk.\n\n\n[Walk] <fridge> (1)\n[Open] <fridge> (1)\n[Walk] <milk> (1)\n[Grab] <milk> (1)\n"


@pytest.fixture(scope="module")
def ran(knowledge):
    home = Home.from_graph(load_graph("maple", knowledge), "maple", knowledge)
    return attempt(parse_programs(MILK).programs[0], home, 0).execution


@pytest.fixture(scope="module")
def task(ran):
    return own_task(ran, "maple")


def test_a_goal_is_what_a_program_changed(task):
    assert task["goal"].startswith("HOLDS_RH(character.") and "OPEN(fridge.137)" in task["goal"]
    assert set(task["prompts"]) == set(ASKED)
    assert all(fingerprint(task["prompts"][name]) == mark for name, mark in task["fingerprints"].items())
    assert task["goal"] in task["prompts"]["action_sequencing"]
    assert task["goal"] not in task["prompts"]["goal_interpretation"]


def test_a_program_that_changes_nothing_makes_no_task(knowledge):
    home = Home.from_graph(load_graph("maple", knowledge), "maple", knowledge)
    program = parse_programs("Look\n\n\n\n[Walk] <fridge> (1)\n").programs[0]
    assert own_task(attempt(program, home, 0).execution, "maple") is None


def test_a_task_is_made_again_and_its_own_program_reaches_the_goal(task, ran, knowledge):
    assert start_of(task, knowledge).worlds[0].key() == ran.worlds[0].key()
    answer = json.dumps({"plan": list(print_lines(ran.program))})
    assert plan_verdict(task, answer, knowledge) == (True, True)
    short = json.dumps({"plan": list(print_lines(ran.program))[:2]})
    assert plan_verdict(task, short, knowledge) == (True, False)
    assert plan_verdict(task, "I would walk.", knowledge) == (False, False)


def test_answers_in_one_command(task, ran, tmp_path):
    facts = task["goal"].split(" and ")
    assert interpretation_counts(task, json.dumps({"goal": [facts[0], "ON(fridge.137)"]})) == (1, 1, len(facts) - 1)
    (tmp_path / "own.json").write_text(json.dumps([task]))
    plan = list(print_lines(ran.program))
    rows = [
        {"id": task["id"], "ability": "goal_interpretation", "answer": json.dumps({"goal": facts})},
        {"id": task["id"], "ability": "action_sequencing", "answer": json.dumps({"plan": plan})},
        {"id": task["id"], "ability": "subgoal_decomposition", "answer": json.dumps({"output": SUBGOALS})},
        {"id": task["id"], "ability": "transition_modeling", "answer": json.dumps({"output": OPERATORS})},
        {"id": task["id"], "ability": "cooking", "answer": ""},
    ]  # fmt: skip
    (tmp_path / "answers.jsonl").write_text("\n".join(map(json.dumps, rows)))
    result = CliRunner().invoke(
        app, ["challenge", "eai", "score", str(tmp_path / "own.json"), str(tmp_path / "answers.jsonl"), "--json"]
    )
    found = json.loads(result.output)
    assert (found["goal_f1"], found["plans_that_reach_the_goal"], found["not_scored"]) == (100.0, 100.0, 1)
    assert (found["subgoals_that_run"], found["subgoals_that_reach_the_goal"]) == (100.0, 100.0)
    assert found["operator_precision"] == 100.0 and 0 < found["operator_recall"] < 100


SUBGOALS = ["CLOSE(character.367, fridge.137)", "OPEN(fridge.137)", "HOLDS_RH(character.367, milk.142)"]
OPERATORS = "(:action Open :parameters (?a ?o) :precondition (close-to ?a ?o) :effect (and (is-open ?o)))"


@pytest.mark.parametrize(
    ("subgoals", "verdict"),
    [
        (SUBGOALS, (True, True)),
        (SUBGOALS[:2], (True, False)),
        (["HOLDS_RH(character.367, milk.142)"], (False, False)),  # the fridge is closed
        (["OPEN(fridge.137) or ON(fridge.137)", SUBGOALS[2]], (True, True)),
        (["OPEN(fridge.9999)"], (False, False)),
        (["OPEN fridge"], (False, False)),
        ([], (False, False)),
    ],
)
def test_subgoals_are_brought_about_in_their_order(task, knowledge, subgoals, verdict):
    assert subgoal_verdict(task, json.dumps({"output": subgoals}), knowledge) == verdict


def test_operators_are_compared_with_the_engines_own(task, knowledge):
    domain = planning_domain(knowledge, actions_of(task), loose=False)
    right = operator_counts(task, domain[domain.index("(:action") :], knowledge)
    assert right.right > 10 and (right.wrong, right.missed) == (0, 0)
    assert operator_counts(task, "(((", knowledge) == (0, 0, right.right)
    assert "(is-open ?x - object)" in task["prompts"]["transition_modeling"]
