"""The time limit of a record."""

from __future__ import annotations

import time

import pytest

from hearth.pipelines.engine.record_deadline import Deadline, OverTime


@pytest.fixture
def deadline():
    made = Deadline(0.1)
    yield made
    made.close()


def hang(seconds: float = 5.0) -> None:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        pass


def test_what_hangs_is_interrupted_even_where_all_exceptions_are_kept(deadline):
    def guarded():
        try:
            hang()
        except Exception:
            pytest.fail("a guard kept it")

    with pytest.raises(OverTime), deadline:
        guarded()


def test_each_record_has_the_whole_time():
    deadline = Deadline(2.0)
    for _ in range(3):
        with deadline:
            hang(0.8)
    deadline.close()


def test_what_is_done_in_time_is_left_alone_afterwards(deadline):
    with deadline:
        pass
    hang(0.4)


def test_after_one_that_hung_the_next_is_watched_too(deadline):
    for _ in range(2):
        with pytest.raises(OverTime), deadline:
            hang()


def test_no_limit_watches_nothing():
    deadline = Deadline(0)
    with deadline:
        hang(0.05)
