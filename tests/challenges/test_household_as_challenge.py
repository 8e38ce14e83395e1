"""Household tasks in `challenge run`, `score`, `verify`: as tasks of a challenge with one agent."""

from __future__ import annotations

from dataclasses import replace

import orjson
import pytest

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.household_as_challenge import SEVERAL
from hearth.challenges.household_definition import NAME, RULES, settings
from hearth.challenges.result_files import read
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import Suite, read_suite, suite, suite_data
from hearth.challenges.verification import verify
from hearth.commands.challenge_output import _figures
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

AGENTS = ("random", "admissible_random", "oracle", "human_like")


@pytest.fixture(scope="module")
def some():
    return suite(NAME, "test_unseen", limit=3)


@pytest.fixture(scope="module")
def results(some, tmp_path_factory):
    folder = tmp_path_factory.mktemp("household")
    return {main: run(some, Lineup(main), 1, folder / f"{main}.jsonl", default) for main in AGENTS}


def test_the_challenge_is_as_its_file_says(knowledge):
    which = challenge(NAME)
    assert (which.agents, which.partial, which.messages, which.ticks) == (1, True, False, settings()["ticks"])
    assert which.rules == RULES and which.allowed(knowledge) == knowledge.group(settings()["actions"])


def test_agents_do_the_tasks_and_every_episode_is_verified(results):
    for main, found in results.items():
        assert verify(found, main, default) == [] and len(found.records) == 3, main
    solved = {main: sum(each.metrics["success"] for each in found.records) for main, found in results.items()}
    assert solved["oracle"] == 3 and solved["human_like"] == 3 and solved["random"] == 0


def test_an_agent_at_random_tries_what_cannot_be_done(results):
    failed = {main: sum(each.metrics["failed"] for each in found.records) for main, found in results.items()}
    assert failed["random"] > 100 and failed["oracle"] == 0


def test_a_run_is_the_same_every_time(some, results, tmp_path):
    for main in ("random", "admissible_random"):
        again = run(some, Lineup(main), 1, tmp_path / f"{main}.jsonl", default)
        assert list(again.records) == list(results[main].records)


def test_figures_are_by_family_and_do_not_make_the_tasks_anew(results, monkeypatch):
    monkeypatch.setattr("hearth.challenges.household_as_challenge.household_task", None)
    figures = _figures(results["human_like"])
    assert {row["goals"] for row in figures["by_set"]} == {
        task.sets[0] for task in results["oracle"].header.suite.tasks
    }
    assert figures["published"] is None and figures["success"] == 1.0


def test_tasks_are_for_one_agent(some, tmp_path):
    with pytest.raises(HearthError, match="one agent") as caught:
        run(some, Lineup("human_like", "hp"), 1, tmp_path / "x.jsonl", default)
    assert caught.value.diagnostics[0].code is Code.BAD_ARGUMENT and caught.value.diagnostics[0].suggestion


def test_a_suite_is_read_back_and_is_published(some):
    data = orjson.loads(orjson.dumps(suite_data(some)))
    found = read_suite(data, "file")
    assert found == some and found.digest == some.digest and found.published


@pytest.mark.parametrize(("part", "value"), [("family", "find"), ("min_ticks", 1), ("activity", "x"), ("seed", 3)])
def test_a_changed_task_is_noticed(some, part, value):
    data = orjson.loads(orjson.dumps(suite_data(some)))
    data["tasks"][0][part] = value
    with pytest.raises(HearthError) as caught:
        read_suite(data, "file")
    assert caught.value.diagnostics[0].code is Code.DAMAGED_FILE


def test_other_tasks_are_not_the_published_ones(some):
    first, *others = some.tasks
    changed = replace(first, origin=replace(first.origin, instruction="Do nothing."))
    assert not replace(some, tasks=(changed, *others)).published
    assert not replace(some, tasks=(replace(first, id="mine"), *others)).published


def test_a_file_holds_tasks_of_several_splits(some):
    (other,) = suite(NAME, "train", limit=1).tasks
    both = Suite(NAME, SEVERAL, -1, (*some.tasks, other))
    assert read_suite(orjson.loads(orjson.dumps(suite_data(both))), "file") == both


def test_a_task_has_other_wordings_and_reads_them(some, knowledge):
    task = some.tasks[1]
    texts = {task.worded(knowledge, number) for number in range(12)}
    assert len(texts) >= 3 and all(task.read(text, knowledge) == task.goal for text in texts)
    with pytest.raises(HearthError, match="no demonstration"):
        task.demonstration_start(knowledge)


@pytest.mark.parametrize("count", [0, 20_001])
def test_a_file_has_some_tasks_and_not_too_many(some, count):
    data = {**orjson.loads(orjson.dumps(suite_data(some))), "tasks": [{}] * count}
    with pytest.raises(HearthError, match="1 to 20,000 tasks"):
        read_suite(data, "file")


def test_a_task_is_in_a_file_once(some):
    data = orjson.loads(orjson.dumps(suite_data(some)))
    data["tasks"].append(data["tasks"][0])
    with pytest.raises(HearthError) as caught:
        read_suite(data, "file")
    assert caught.value.diagnostics[0].code is Code.DUPLICATE


def test_results_name_their_tasks(results):
    path = results["oracle"].records._path
    assert read(path).header.suite == results["oracle"].header.suite
