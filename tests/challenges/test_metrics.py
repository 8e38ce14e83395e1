"""Metrics: against plain formulas, and by hand."""

from __future__ import annotations

import math
import statistics
from random import Random

import pytest

from hearth.challenges.behavior_counts import Columns
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.metrics import by_task, mean, outcome, paired, speedups, summary

WAH = challenge("wah")


def episodes(lengths):
    return by_task((task, outcome(WAH, length < 250, length, Columns()).as_json()) for task, length in lengths)


def test_rewards_run_from_minus_one_to_one():
    assert outcome(WAH, False, 250, Columns()).reward == -1
    assert outcome(WAH, False, 3, Columns()).reward == -1
    assert outcome(WAH, True, 0, Columns()).reward == 1
    assert outcome(WAH, True, 100, Columns()).reward == 0.6


def test_speedups_are_of_mean_lengths_over_seeds_and_means_over_tasks():
    alone = episodes([("a", 100), ("a", 60), ("b", 50), ("b", 50)])
    helped = episodes([("a", 40), ("a", 40), ("b", 25), ("b", 75)])
    assert speedups(alone, helped) == {"a": 1.0, "b": 0.0}
    found = summary(alone, helped)
    assert (found["speedup"], found["speedup_se"]) == (0.5, 0.5)
    assert found["episodes"] == 4
    assert found["saving"] == pytest.approx(0.25)


def test_an_episode_that_fails_counts_as_all_its_ticks():
    alone, helped = episodes([("a", 125)]), episodes([("a", 250)])
    assert summary(alone, helped)["speedup"] == -0.5
    assert summary(alone, helped)["success"] == 0


def test_alone_is_its_own_speedup_of_nothing():
    alone = episodes([("a", 100), ("b", 30)])
    assert summary(alone, {})["speedup"] == 0
    assert summary(alone, {})["episodes"] == 2


def test_means_and_standard_errors_are_the_textbook_s():
    values = [Random(3).random() for _ in range(40)]
    found = mean(values)
    assert found.value == pytest.approx(statistics.mean(values))
    assert found.error == pytest.approx(statistics.stdev(values) / math.sqrt(40))
    assert mean([2.0]).error is None


def test_paired_tests_are_scipy_s_with_the_effect_in_deviations():
    from scipy import stats

    chooser = Random(1)
    one = {str(n): chooser.random() for n in range(30)}
    other = {task: value + 0.1 * chooser.random() for task, value in one.items()}
    found = paired(one, other)
    expected = stats.ttest_rel(list(one.values()), list(other.values()))
    assert (found.t, found.p, found.freedom) == (expected.statistic, expected.pvalue, 29)
    assert found.effect == pytest.approx(found.t / math.sqrt(30))
    assert paired(one, one).t is None
