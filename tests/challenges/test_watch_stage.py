"""Demonstrations that are worth watching, what is inferred from them, and their tables."""

from __future__ import annotations

import pytest

from hearth.agents.demonstration_goals import agreement
from hearth.challenges.challenge_dataset import TABLES, ChallengeData, publish
from hearth.challenges.demonstration_episodes import Wish, demonstrate
from hearth.challenges.published_tasks import tasks
from hearth.challenges.watch_stage import inferred
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.simulation.goals import Progress

FEW = tasks("wah", "test-1", limit=10)


@pytest.mark.parametrize("rate", [0.0, 1.0])
def test_demonstrations_reach_their_goal_and_are_done_again_equally(knowledge, rate):
    for task in FEW[:3]:
        shown = demonstrate(Wish(task, rate, default))
        ticks = shown.ticks(knowledge)
        home = ticks[0].before.home
        assert Progress.at(task.goal_in(home), ticks[-1].world).satisfied
        assert not any(Progress.at(task.goal_in(home), ticks[0].before).counts)
        assert demonstrate(Wish(task, rate, default)) == shown
        assert bool(shown.habits) <= bool(rate)


def test_counting_infers_every_clean_goal_and_at_most_half_of_the_others():
    def exact(rate):
        found = inferred(FEW, "actions", default, rate)
        return sum(dict(goal) == dict(task.goal) for goal, task in zip(found, FEW, strict=True))

    assert exact(0.0) == len(FEW)
    assert exact(1.0) <= len(FEW) / 2


def test_nothing_wanted_is_missed_by_counting():
    for goal, task in zip(inferred(FEW[:5], "actions", default), FEW, strict=False):
        assert agreement(goal, task.goal).recall == 1


def test_an_unknown_way_of_reading_is_refused():
    with pytest.raises(HearthError):
        inferred(FEW, "tea leaves", default)


def test_tables_are_published_and_answer_queries(tmp_path):
    counts = publish(tmp_path / "wah", "wah", default, limit=1)
    assert counts == {"tasks": 4, "demonstrations": 4, "episodes": 0, "trajectories": 0, "posteriors": 0}
    data = ChallengeData.found(tmp_path / "wah")
    assert data is not None
    _, rows = data.rows("SELECT count(*) FROM tasks JOIN demonstrations USING (task_id) WHERE ticks > 0")
    assert rows == [(4,)]
    _, steps = data.rows("SELECT count(*) FROM demonstration_steps")
    assert steps[0][0] > 20
    with pytest.raises(HearthError):
        data.rows("COPY tasks TO 'x.csv'")
    before = {table: (tmp_path / "wah" / f"{table}.parquet").read_bytes() for table in TABLES}
    publish(tmp_path / "wah", "wah", default, limit=1)
    assert before == {table: (tmp_path / "wah" / f"{table}.parquet").read_bytes() for table in TABLES}
