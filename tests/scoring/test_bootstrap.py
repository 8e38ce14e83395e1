import pytest

from hearth.scoring.bootstrap import Interval, intervals

VALUES = [0.0, 0.1, 0.2, 0.9, 1.0, 0.4, 0.4, 0.7]


def test_an_interval_holds_its_mean():
    found = intervals({"a": VALUES}, seed=1)["a"]
    assert found.mean == pytest.approx(sum(VALUES) / len(VALUES))
    assert min(VALUES) < found.low < found.mean < found.high < max(VALUES)


def test_the_seed_decides():
    assert intervals({"a": VALUES}, seed=1) == intervals({"a": VALUES}, seed=1)
    assert intervals({"a": VALUES}, seed=1) != intervals({"a": VALUES}, seed=2)


def test_a_column_is_resampled_the_same_whatever_stands_beside_it():
    alone = intervals({"a": VALUES}, seed=1)["a"]
    assert intervals({"b": [1.0] * 8, "a": VALUES}, seed=1) == {"b": Interval(1.0, 1.0, 1.0), "a": alone}


def test_rows_without_a_score_are_left_out():
    found = intervals({"a": [1.0, None, 0.5], "b": [None, None, None]}, seed=0)
    assert found.keys() == {"a"}
    assert found["a"].mean == 0.75
    assert 0.5 <= found["a"].low <= found["a"].high <= 1


def test_more_values_are_surer():
    few, many = intervals({"a": VALUES}, seed=0)["a"], intervals({"a": VALUES * 50}, seed=0)["a"]
    assert many.high - many.low < (few.high - few.low) / 4


def test_nothing_and_one():
    assert intervals({}, seed=0) == {}
    assert intervals({"a": []}, seed=0) == {}
    assert intervals({"a": [0.3]}, seed=0) == {"a": Interval(0.3, 0.3, 0.3)}


def test_memory_does_not_decide_the_draws(monkeypatch):
    whole = intervals({"a": VALUES}, seed=0)
    monkeypatch.setattr("hearth.scoring.bootstrap._CHUNK", 24)
    assert intervals({"a": VALUES}, seed=0) == whole
