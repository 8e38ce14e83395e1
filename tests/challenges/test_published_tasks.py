"""The published tasks: how many, in which homes, and that nothing of testing is seen in training."""

from __future__ import annotations

import json
from collections import Counter

import pytest

from hearth.challenges import published_tasks
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.household import household_task
from hearth.challenges.published_tasks import tasks
from hearth.challenges.task_files import read, read_suite, suite, suite_data, write
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

WAH = challenge("wah")
PUBLISHED = {
    "train": "8b9163217d31e679f48e05ceb9a9ce19",
    "test-1": "72ac7b1b8b1e7118caa418ab976e844a",
    "test-2": "c88558817d03191c941ad3505fda5e65",
    "demonstrations": "40e64135dcb0c212185306f7c4d106f6",
}


@pytest.mark.parametrize("split", PUBLISHED)
def test_the_published_tasks_stay_as_they_are(split):
    assert suite("wah", split).digest == PUBLISHED[split]


def test_the_numbers_are_the_thesis_s():
    numbers = [len(published_tasks.tasks("wah", split)) for split in PUBLISHED]
    assert numbers == [1011, 100, 100, 5303]


def test_no_goal_of_testing_is_among_those_of_training_and_demonstrations():
    seen = {task.goal for split in ("train", "demonstrations") for task in published_tasks.tasks("wah", split)}
    for split in ("test-1", "test-2"):
        for seed in (published_tasks.PUBLISHED, 0, 7):
            assert seen.isdisjoint({task.goal for task in published_tasks.tasks("wah", split, seed)})


def test_homes_are_held_out_and_demonstrations_are_elsewhere():
    for split in PUBLISHED:
        tasks = published_tasks.tasks("wah", split)
        assert {task.home for task in tasks} == set(WAH.test if split.startswith("test") else WAH.train)
        assert all(task.home != task.demonstration_home in WAH.train for task in tasks)
    assert len(WAH.test) == 2


def test_goal_sets_come_equally_often_and_test_2_has_two_at_once():
    assert set(Counter(task.sets for task in published_tasks.tasks("wah", "test-1")).values()) == {20}
    two = published_tasks.tasks("wah", "test-2")
    assert set(Counter(task.sets for task in two).values()) == {10}
    assert {len(task.sets) for task in two} == {2}
    assert max(WAH.grammar.size(task.goal) for task in two) <= 8
    assert len({task.goal for task in published_tasks.tasks("wah", "test-1")}) == 100


def test_a_seed_draws_other_tasks_and_a_limit_takes_the_first():
    assert published_tasks.tasks("wah", "train", limit=9) == published_tasks.tasks("wah", "train")[:9]
    published, other, again = (
        published_tasks.tasks("wah", "test-1", seed) for seed in (published_tasks.PUBLISHED, 4, 4)
    )
    assert other == again
    assert {task.seed for task in other}.isdisjoint({task.seed for task in published})
    assert {task.id for task in other}.isdisjoint({task.id for task in published})


def test_household_tasks_are_those_of_a_suite_and_of_their_ids():
    first, second = tasks("household", "valid_seen", limit=2)
    assert (first, second) == suite("household", "valid_seen", limit=2).tasks and first.challenge == "household"
    assert second.origin == household_task("household-valid_seen-00001")
    assert tasks("household", "train", 9, limit=1)[0].id == "household-train-9-00000"


def test_an_unknown_split_is_refused():
    with pytest.raises(HearthError) as raised:
        published_tasks.tasks("wah", "test-3")
    assert raised.value.diagnostics[0].code is Code.BAD_ARGUMENT


def test_tasks_are_read_as_they_were_written(tmp_path):
    found = suite("wah", "test-2", 3, 12)
    write(tmp_path / "tasks.json", found)
    assert read(tmp_path / "tasks.json") == found
    assert not found.published
    assert suite("wah", "test-2", limit=12).published


def changed(**values):
    """The data of two tasks, the first with other values; the digest is right."""
    data = json.loads(json.dumps(suite_data(suite("wah", "test-1", limit=2))))
    data["tasks"][0] |= values
    return data


@pytest.mark.parametrize(
    ("values", "code"),
    [
        ({"id": "../../etc/passwd"}, Code.BAD_JSON),
        ({"id": "wah-test-1-0002"}, Code.DUPLICATE),
        ({"home": "../maple"}, Code.BAD_JSON),
        ({"home": ["maple"]}, Code.BAD_JSON),
        ({"demonstration_home": "__import__('os')"}, Code.BAD_JSON),
        ({"sets": ["hack"]}, Code.BAD_JSON),
        ({"sets": [["read_book"]]}, Code.BAD_JSON),
        ({"seed": "1"}, Code.BAD_JSON),
        ({"seed": -5}, Code.BAD_JSON),
        ({"seed": 1 << 70}, Code.BAD_JSON),
        ({"seed": True}, Code.BAD_JSON),
        ({"goal": {"ON(plate, bed)": 1}}, Code.UNKNOWN_OBJECT),
        ({"goal": {"ON(plate, dinnertable)": 10**9}}, Code.SYNTAX),
        ({"goal": []}, Code.BAD_JSON),
        ({"seed": 12345}, Code.DAMAGED_FILE),
    ],
)
def test_a_task_of_others_is_checked(values, code):
    with pytest.raises(HearthError) as raised:
        read_suite(changed(**values), "theirs.json")
    assert raised.value.diagnostics[0].code is code
    assert "theirs.json" in str(raised.value)


@pytest.mark.parametrize(
    "data", [None, [], {}, {"format": "hearth-tasks-1"}, {"format": "hearth-tasks-1", "challenge": "x"}]
)
def test_what_is_not_a_file_of_tasks_is_refused(data):
    with pytest.raises(HearthError):
        read_suite(data, "theirs.json")


@pytest.mark.parametrize("values", [{"tasks": []}, {"tasks": 3}, {"split": "a/b"}, {"seed": "x"}, {"digest": "0"}])
def test_a_file_of_tasks_is_checked(values):
    with pytest.raises(HearthError):
        read_suite(changed() | values, "theirs.json")
