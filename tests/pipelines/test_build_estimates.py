"""The estimate before a long build, and its progress."""

from __future__ import annotations

import io
import json
from collections import namedtuple

import pytest

from hearth.pipelines.build import build
from hearth.pipelines.engine.build_estimates import estimate, forecast
from hearth.pipelines.engine.progress import JsonLines
from hearth.pipelines.engine.settings import Settings
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.partitions import Counts


def test_a_target_bounds_what_is_augmented():
    free = estimate(100, Settings(homes_each=2, variants=5, pictures=0), 1, 7)
    bound = estimate(100, Settings(homes_each=2, variants=5, target=300, pictures=0), 1, 7)
    assert (free.executions, bound.executions) == (200 + 1000, 200 + 300)
    assert bound.size < free.size


def test_more_workers_take_less_time():
    one, four = (estimate(1000, Settings(), workers, 7) for workers in (1, 4))
    assert one.seconds == pytest.approx(4 * four.seconds) and one.size == four.size


def test_short_builds_are_not_worth_a_word(tmp_path):
    assert forecast(10, Settings(out=str(tmp_path), pictures=0), 2) == ""
    assert "executions" in forecast(100_000, Settings(out=str(tmp_path), pictures=0), 2, force=True)


def test_a_disk_that_is_too_small_is_reported_before_the_work(built, inputs, monkeypatch, tmp_path):
    usage = namedtuple("usage", "total used free")
    monkeypatch.setattr("shutil.disk_usage", lambda path: usage(10, 9, 1))
    with pytest.raises(HearthError) as error:
        build([str(inputs / "programs")], str(tmp_path / "out"), pictures=0)
    (fault,) = error.value.diagnostics
    assert fault.code is Code.UNWRITABLE and "MB are free" in fault.message and "--force" in fault.suggestion
    assert not (tmp_path / "out/sample").exists()


def test_progress_as_json():
    now = iter(range(100, 200))
    stream = io.StringIO()
    log = JsonLines(stream, clock=lambda: next(now))
    log.start("sample", 10)
    log.seen(4, 1)
    log.end("sample", Counts(10, 9, 1), 2.5, fresh=True)
    start, progress, end = map(json.loads, stream.getvalue().splitlines())
    assert (start["event"], start["stage"], start["total"]) == ("start", "sample", 10)
    assert (progress["done"], progress["rejects"]) == (4, 1) and progress["seconds_left"] > 0
    assert (end["records_in"], end["through"], end["rejected"], end["fresh"]) == (10, 9, 1, True)
