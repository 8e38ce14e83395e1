"""Household tasks in `challenge run`, `score`, `verify`: as tasks of a challenge with one agent."""

from __future__ import annotations

from dataclasses import replace

import orjson
import pytest

from hearth.analysis import household_table
from hearth.analysis.household_table import AGENTS as ROWS
from hearth.analysis.household_table import ALL, household_rows, household_runs, household_suite
from hearth.challenges import challenge_dataset
from hearth.challenges.challenge_dataset import ChallengeData, publish
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.household import household_task
from hearth.challenges.household_as_challenge import SEVERAL, as_task
from hearth.challenges.household_definition import NAME, RULES, settings
from hearth.challenges.metrics import share_interval
from hearth.challenges.result_files import read
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import Suite, read_suite, suite, suite_data
from hearth.challenges.verification import verify
from hearth.commands import challenge_household
from hearth.commands.challenge_infer_and_people import people
from hearth.commands.challenge_learning import learn
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


def test_nobody_learns_to_help_in_household(tmp_path):
    for refused in (
        lambda: learn(NAME, "subgoals", out=tmp_path / "x"),
        lambda: people(NAME, split="train", out=tmp_path / "y"),
    ):
        with pytest.raises(HearthError, match="one agent") as caught:
            refused()
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


def asked(found, query):
    """The rows of a query, by column."""
    columns, rows = found.rows(query)
    return [dict(zip(columns, row, strict=True)) for row in rows]


def test_tables_have_the_tasks_of_runs_their_experts_and_their_episodes(some, results, tmp_path):
    runs = [results["human_like"], results["random"]]
    counts = publish(tmp_path / "out", NAME, default, runs)
    assert (counts["tasks"], counts["demonstrations"], counts["episodes"], counts["posteriors"]) == (3, 3, 6, 0)
    found = ChallengeData.found(tmp_path / "out")
    rows = asked(found, "SELECT * FROM tasks ORDER BY task_id")
    for row, task in zip(rows, some.tasks, strict=True):
        assert (row["instruction"], row["expert_ticks"]) == (task.instruction, task.origin.min_ticks)
        assert row["sets"] == [task.origin.family] and bool(row["activity"]) == (task.origin.family == "activity")
        assert " and ".join(each["predicate"] for each in row["goal"]).split(" and ")[0] in str(task.goal)
    joined = "trajectories JOIN episodes USING (episode_id) JOIN tasks USING (task_id)"
    assert asked(found, f"SELECT count(*) AS n FROM {joined}")[0]["n"] == counts["trajectories"] > 750
    shown = {row["task_id"]: row["ticks"] for row in asked(found, "SELECT task_id, ticks FROM demonstrations")}
    assert shown == {task.id: task.origin.min_ticks for task in some.tasks}


def test_a_limit_draws_tasks_of_every_split(tmp_path, monkeypatch):
    monkeypatch.setattr(challenge_dataset, "settings", lambda: {"splits": ["train", "test_seen"]})
    counts = publish(tmp_path / "out", NAME, default, limit=1)
    assert (counts["tasks"], counts["demonstrations"], counts["episodes"]) == (2, 2, 0)


def test_a_part_that_forbids_is_a_predicate_of_its_row(knowledge):
    task = as_task(household_task("household-train-00009", knowledge=knowledge))
    row = challenge_dataset._task(task)
    assert row["goal"][-1] == {"predicate": "not ([Open](chest_of_drawers))", "count": 1}


def test_the_table_has_intervals_by_split_and_family(some, results, tmp_path):
    found = household_runs(some, 1, tmp_path / "runs", default)
    rows = household_rows(found)
    whole = {row["agent"]: row for row in rows if row["kind"] == ALL}
    assert set(whole) == set(ROWS) and whole["expert"]["success"] == 1.0 and whole["random"]["success"] == 0.0
    assert whole["expert"]["success_from"] == pytest.approx(0.438, abs=0.001) and whole["expert"]["success_to"] == 1.0
    assert len(rows) == 4 * (1 + 1 + 3) and {row["kind"] for row in rows} == {ALL, "split", "family"}
    assert household_rows(household_runs(some, 1, tmp_path / "runs", default)) == rows
    assert list(found["random"].records) == list(results["random"].records)


def test_the_tasks_of_a_table_are_the_first_of_each_split():
    found = household_suite("valid_words", 1, default)
    assert [task.id for task in found.tasks] == ["household-valid_words-00000"] and found.split == "valid_words"


@pytest.mark.parametrize(
    ("share", "number", "low", "high"), [(0.0, 10, 0.0, 0.278), (1.0, 10, 0.722, 1.0), (0.5, 100, 0.404, 0.596)]
)
def test_the_interval_of_a_share_is_wilsons(share, number, low, high):
    assert share_interval(share, number) == (pytest.approx(low, abs=0.001), pytest.approx(high, abs=0.001))


def test_the_command_prints_the_table(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(household_table, "AGENTS", {"expert": "oracle"})
    challenge_household.print_table("test_unseen", 1, tmp_path / "t", 1, 1, True)
    (row, *_) = orjson.loads(capsys.readouterr().out)
    assert (row["agent"], row["tasks"], row["success"]) == ("expert", 1, 1.0)
