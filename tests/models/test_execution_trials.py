"""A reward for running is the executability that `score dataset` measures, by the rules of the execution."""

from __future__ import annotations

import pytest

import hearth
from hearth.models.execution_trials import Trial, trials
from hearth.models.text_examples import examples
from hearth.schemas.program import Program
from hearth.scoring.dataset_scores import score_steps
from hearth.simulation.rules import DEFAULT, REPLAY
from tests.models.conftest import steps_of

WATCHING = ("[Walk] <television> (1)", "[TurnTo] <television> (1)", "[Watch] <television> (1)")


def test_what_runs_is_what_scores_say(dataset):
    known = examples(dataset, "activities", "train", originals=True)[:12]
    names = sorted({each.executions[0] for each in known})
    programs = [steps for each in known for steps in (each.steps, each.steps[::-1])]
    tried = trials(dataset, names)
    pairs = [(name, steps) for name in names for steps in programs]
    found = [tried[name].runs(steps) for name, steps in pairs]
    assert found == [each.execution.executable for each in score_steps(dataset, pairs)]
    assert {True, False} == {*found}


@pytest.mark.parametrize(("rules", "runs"), [(DEFAULT, False), (REPLAY, True)])
def test_the_rules_of_the_execution_count(rules, runs):
    """By those of the release, what is off may be watched."""
    world = hearth.World.start(hearth.home("maple"))
    assert Trial(world, Program(), rules).runs(steps_of(*WATCHING)) == runs


def test_the_reference_guides_the_binding():
    """Of several chairs the one of the reference is meant."""
    world = hearth.World.start(hearth.home("maple"))
    last = [node.id for node in world.graph().nodes if node.class_name == "chair"][-1]
    asked = steps_of("[Walk] <chair> (1)", f"[Touch] <chair> (2.{last})")
    reference = Program(steps=steps_of(f"[Walk] <chair> (1.{last})"))
    assert not Trial(world, Program(), DEFAULT).runs(asked)
    assert Trial(world, reference, DEFAULT).runs(asked)


def test_the_empty_program_is_not_rewarded():
    assert not Trial(hearth.World.start(hearth.home("maple")), Program(), DEFAULT).runs(())
