"""The same inputs give the same bytes, whoever builds, however often it is stopped."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from hearth.pipelines.stages import STAGES

BUILD = """
import sys
from hearth.pipelines.build import build

if __name__ == "__main__":
    out, workers, engine, homes, *sources = sys.argv[1:]
    build(sources, out, workers=int(workers), engine=engine, homes=("cabin",), homes_folder=homes, pictures=0)
"""

VARYING = {"timing.json", "catalog.duckdb", ".lock"}
"""Seconds, a database file whose bytes DuckDB does not fix, and who builds."""


def contents(out: Path) -> dict[str, bytes]:
    return {
        path.relative_to(out).as_posix(): path.read_bytes()
        for path in sorted(out.rglob("*"))
        if path.is_file() and path.name not in VARYING
    }


def started(out: Path, made, tmp_path: Path, workers: int = 1, hash_seed: str = "0", engine: str = "local"):
    script = tmp_path / "build_it.py"
    script.write_text(BUILD)
    asked = [str(out), str(workers), engine, made.settings.homes_folder, *made.settings.sources]
    command = [sys.executable, str(script), *asked]
    return subprocess.Popen(command, env={**os.environ, "PYTHONHASHSEED": hash_seed}, start_new_session=True)


@pytest.mark.parametrize(
    ("workers", "hash_seed"),
    [(2, "1"), pytest.param(7, "2", marks=pytest.mark.slow), pytest.param(1, "3", marks=pytest.mark.slow)],
)
def test_for_any_number_of_workers_and_any_hash_seed(made, tmp_path, workers, hash_seed):
    out = tmp_path / "again"
    assert started(out, made, tmp_path, workers, hash_seed).wait(timeout=900) == 0
    assert_same(made.out, out)


def assert_same(one: Path, other: Path) -> None:
    expected, found = contents(one), contents(other)
    assert found.keys() == expected.keys()
    assert [name for name in expected if found[name] != expected[name]] == []


@pytest.mark.tools
def test_on_a_dask_cluster(made, tmp_path):
    pytest.importorskip("distributed")
    out = tmp_path / "again"
    assert started(out, made, tmp_path, workers=2, engine="dask").wait(timeout=900) == 0
    assert_same(made.out, out)


def test_a_second_build_does_nothing(made):
    def times():
        touched = ("manifest.json", ".lock")
        return {path: path.stat().st_mtime_ns for path in made.out.rglob("*") if path.name not in touched}

    before = times()
    made.run(*STAGES)
    assert not made.result.fresh
    assert times() == before


@pytest.mark.slow
def test_killed_at_random_moments_and_taken_up_again(made, tmp_path):
    """`kill -9` of the whole build, ten times, then one that is left alone."""
    out = tmp_path / "killed"
    moments = random.Random(0)
    for _ in range(10):
        process = started(out, made, tmp_path, workers=2)
        time.sleep(moments.uniform(0.5, 6.0))
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    assert started(out, made, tmp_path, workers=2).wait(timeout=900) == 0
    assert_same(made.out, out)
