"""The interface's tasks for our own homes: proved goals, prompts with fingerprints, answers judged."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.grounding.grounded_run import attempt
from hearth.homes.library import load_graph
from hearth.interop.eai.own_tasks import ASKED, fingerprint, interpretation_counts, own_task, plan_verdict, start_of
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
        {"id": task["id"], "ability": "transition_modeling", "answer": ""},
    ]  # fmt: skip
    (tmp_path / "answers.jsonl").write_text("\n".join(map(json.dumps, rows)))
    result = CliRunner().invoke(
        app, ["challenge", "eai", "score", str(tmp_path / "own.json"), str(tmp_path / "answers.jsonl"), "--json"]
    )
    found = json.loads(result.output)
    assert (found["goal_f1"], found["plans_that_reach_the_goal"], found["not_scored"]) == (100.0, 100.0, 1)
