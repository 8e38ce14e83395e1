"""Tasks can be done by one agent that sees everything."""

from __future__ import annotations

import pytest

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.published_tasks import tasks
from hearth.challenges.solvability import Solved, solved
from hearth.kb.loading.load import default


def test_a_task_is_done_in_the_ticks_that_it_takes():
    (found,) = solved(tasks("wah", "test-1", limit=1), default)
    assert found.success and 0 < found.ticks < challenge("wah").ticks and not found.fault


@pytest.mark.parametrize(("ticks", "fault"), [(0, "at the start"), (250, "not done in 250 ticks")])
def test_what_is_done_before_it_begins_and_what_never_is_are_no_tasks(ticks, fault):
    assert fault in Solved("wah-test-1-0001", not ticks, ticks).fault


@pytest.mark.slow
@pytest.mark.parametrize(("name", "splits"), [("wah", ["train", "test-1", "test-2"]), ("owah", ["test"])])
def test_every_published_task_can_be_done(name, splits):
    every = [task for split in splits for task in tasks(name, split)]
    assert not [each.fault for each in solved(every, default, 2) if each.fault]
