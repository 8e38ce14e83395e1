"""The table of helpers and kinds of people: harm of the helper, and the speedup that a veto keeps."""

from __future__ import annotations

import pytest

from hearth.agents.human_population import PEOPLE
from hearth.analysis import helper_harm
from hearth.analysis.helper_harm import helped_people
from hearth.challenges.task_files import suite
from hearth.kb.loading.load import default


@pytest.fixture
def few(monkeypatch):
    monkeypatch.setattr(helper_harm, "PEOPLE", {name: PEOPLE[name] for name in ("careless", "changes_mind")})


def test_rows_by_kind_the_worst_and_all_of_them_with_the_harm_of_the_helper(few, tmp_path):
    tasks = suite("owah_consequences", "test", limit=1)
    rows = list(helped_people(tasks, ["expected_time", "expected_time_veto"], 1, tmp_path, default))
    assert [row["kind"].partition(":")[0] for row in rows] == ["careless", "changes_mind", "worst", "all"] * 2
    plain, veto = rows[3], rows[7]
    for name in ("speedup", "success", "hazards", "helper_harm"):
        assert plain[name] == pytest.approx(sum(row[name] for row in rows[:2]) / 2)
    assert veto["helper_harm"] == 0 and veto["harmful_episodes"] == "0 of 2"
    assert veto["speedup_kept"] == pytest.approx(veto["speedup"] / plain["speedup"]) and "speedup_kept" not in plain
    assert veto["speedup_kept_ci"] >= 0


def test_where_acts_have_no_consequences_there_are_no_columns_of_harm(few, tmp_path):
    rows = list(helped_people(suite("owah", "test", limit=1), ["expected_time"], 1, tmp_path, default))
    assert all("helper_harm" not in row and "speedup_kept" not in row for row in rows) and rows[-1]["kind"] == "all"


def test_the_interval_of_the_kept_speedup_is_that_of_a_ratio():
    plain = {"a": 1.0, "b": 2.0, "c": 3.0}
    found = helper_harm._kept(plain, {task: value * 0.9 for task, value in plain.items()}, "nopa_veto")
    assert found["speedup_kept"] == pytest.approx(0.9) and found["speedup_kept_ci"] == pytest.approx(0, abs=1e-9)
    other = helper_harm._kept(plain, {"a": 1.5, "b": 1.5, "c": 2.4}, "nopa_veto")
    assert other["speedup_kept"] == pytest.approx(0.9) and other["speedup_kept_ci"] > 0.1
    assert helper_harm._kept(plain, plain, "nopa") == helper_harm._kept({"a": 0.0}, {"a": 0.0}, "nopa_veto") == {}
