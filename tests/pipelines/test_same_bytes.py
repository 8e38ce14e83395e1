"""The same inputs give the same bytes, whoever builds, however often it is stopped."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from hearth.pipelines.engine.stages import STAGES

BUILD = """
import sys
from hearth.pipelines.build import build

if __name__ == "__main__":
    out, workers, engine, homes, *sources = sys.argv[1:]
    build(sources, out, workers=int(workers), engine=engine, homes=("cabin",), homes_folder=homes, pictures=0,
          action_set=2)
"""


FILM = """
import sys
from hearth.pipelines.build import build

if __name__ == "__main__":
    out, workers, *sources = sys.argv[1:]
    build(sources, out, workers=int(workers), homes=("maple",), clips=3, demonstrations=3, pictures=0, variants=0)
"""


@pytest.fixture(scope="module")
def kills(module):
    """Kills builds, and compares the results."""
    return module("benchmarks/killed_builds.py")


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
def test_for_any_number_of_workers_and_any_hash_seed(made, kills, tmp_path, workers, hash_seed):
    out = tmp_path / "again"
    assert started(out, made, tmp_path, workers, hash_seed).wait(timeout=900) == 0
    assert kills.differing(made.out, out) == []


@pytest.mark.slow
def test_clips_and_demonstrations_are_the_same_for_any_number_of_workers(kills, tmp_path):
    pytest.importorskip("open3d", exc_type=ImportError)
    (tmp_path / "film.py").write_text(FILM)
    sources = [tmp_path / f"{name}.txt" for name in ("bed", "sofa", "fridge")]
    for source, (action, thing) in zip(sources, (("Lie", "bed"), ("Sit", "sofa"), ("Open", "fridge")), strict=True):
        source.write_text(f"Do\n{action} it.\n\n[Walk] <{thing}> (1)\n[{action}] <{thing}> (1)\n")
    for workers in (1, 2):
        asked = [str(tmp_path / "film.py"), str(tmp_path / str(workers)), str(workers), *map(str, sources)]
        subprocess.run([sys.executable, *asked], check=True, timeout=900)
    found = kills.contents(tmp_path / "2")
    for name in ("clips.npz", "above.npz"):
        assert sum(path.endswith(f"/{name}") for path in found) >= 3
    assert kills.differing(tmp_path / "1", tmp_path / "2") == []


@pytest.mark.tools
def test_on_a_dask_cluster(made, kills, tmp_path):
    pytest.importorskip("distributed")
    out = tmp_path / "again"
    assert started(out, made, tmp_path, workers=2, engine="dask").wait(timeout=900) == 0
    assert kills.differing(made.out, out) == []


def test_a_second_build_does_nothing(made):
    def times():
        touched = ("manifest.json", ".lock")
        return {path: path.stat().st_mtime_ns for path in made.out.rglob("*") if path.name not in touched}

    before = times()
    made.run(*STAGES)
    assert not made.result.fresh
    assert times() == before


@pytest.mark.parametrize("times", [1, pytest.param(10, marks=pytest.mark.slow)])
def test_killed_at_random_moments_and_taken_up_again(made, kills, inputs, tmp_path, times):
    """`kill -9` of whole builds; `python benchmarks/killed_builds.py` does it two hundred times."""
    options = [
        "--homes",
        made.settings.homes_folder,
        "--home",
        "cabin",
        "--pictures",
        "0",
        "--videos",
        "0",
        "--workers",
        "2",
    ]
    words = ["build", str(inputs / "programs"), *options, "--out", "{out}"]
    done, ends, faults = kills.killed(words, tmp_path, times, seed=times)
    assert done == times and ends >= 1
    assert faults == []
