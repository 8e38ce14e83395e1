"""Counts of tuples that two graphs share, and whose step failed."""

from __future__ import annotations

from collections import Counter

from hypothesis import given
from hypothesis import strategies as st

from hearth.schemas.failures import Code, Failure
from hearth.schemas.syntax import parse_steps
from hearth.scoring.metrics.executability import _failed_step
from hearth.scoring.metrics.precision_recall import Match, matched

BAGS = st.dictionaries(st.sampled_from("abcd"), st.integers(1, 4))


@given(BAGS, BAGS)
def test_two_multisets_share_the_lesser_count_of_each(one, other):
    both = Counter(one) & Counter(other)
    assert matched(one, other) == Match(both.total(), sum(one.values()), sum(other.values()))


def test_of_a_tick_the_step_of_the_agent_that_failed():
    text = "<char0> [Walk] <cup> (1)\n<char0> [Grab] <cup> (1) | <char1> [Walk] <bed> (1)\n<char1> [Lie] <bed> (1)"
    lines = [step for line in text.split("\n") for step in parse_steps(line)]
    assert [step.joins for step in lines] == [False, False, True, False]
    failed = {(tick, agent): _failed_step(lines, Failure(Code.NOT_CLOSE, tick=tick, agent=agent))
              for tick in range(3) for agent in (0, 1)}  # fmt: skip
    assert failed == {(0, 0): 0, (0, 1): 0, (1, 0): 1, (1, 1): 2, (2, 0): 3, (2, 1): 3}
