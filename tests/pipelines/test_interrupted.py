"""A killed worker and a build stopped at the keyboard: the remedy is printed, and nothing is lost."""

from __future__ import annotations

import importlib
import os
import signal
import subprocess
import sys
import time

import pytest

from hearth.pipelines.engine.runner import run_stage
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.workers import Workers
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

DEADLY = """
import os, signal
import pyarrow as pa
from pathlib import Path
from hearth.pipelines.engine.stage import Partition, Stage

DEAD = Path(__file__).with_name("dead")

def process(record, context):
    if record["number"] == 70 and not DEAD.exists():
        DEAD.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return [record]

def partitions(job):
    return (Partition(n, str(n), range(25 * n, 25 * n + 25), 25) for n in range(4))

def records(job, partition):
    return ({"program_id": str(n), "number": n} for n in partition.payload)

SCHEMA = pa.schema([("program_id", pa.string()), ("number", pa.int32())])
STAGE = Stage("count", {"": SCHEMA}, process, partitions=partitions, records=records)
"""


def test_a_worker_that_is_killed_is_named_and_its_partition_made_again(tmp_path, monkeypatch):
    (tmp_path / "deadly_stage.py").write_text(DEADLY)
    (tmp_path / "numbers.txt").write_text("0 to 99")
    monkeypatch.syspath_prepend(tmp_path)
    stage = importlib.import_module("deadly_stage").STAGE
    settings = Settings((str(tmp_path / "numbers.txt"),), str(tmp_path / "out"))
    with Workers(2) as workers:
        with pytest.raises(HearthError) as stopped:
            run_stage(stage, settings, workers)
        (fault,) = stopped.value.diagnostics
        assert fault.code == Code.CONFLICT and "killed" in fault.message and "--workers" in fault.suggestion
        assert not (tmp_path / "out/count/manifest.json").exists()
        assert run_stage(stage, settings, workers).manifest.counts.through == 100


ORPHANS = """
import os, sys, time
from pathlib import Path
from hearth.storage.parallel import spread

def work(name):
    Path(name).write_text(str(os.getpid()))
    time.sleep(600)

if __name__ == "__main__":
    list(spread(work, sys.argv[1:], 2))
"""


def test_workers_end_with_a_build_that_is_killed(tmp_path):
    (tmp_path / "orphans.py").write_text(ORPHANS)
    files = [tmp_path / "one", tmp_path / "two"]
    build = subprocess.Popen([sys.executable, str(tmp_path / "orphans.py"), *map(str, files)])
    assert soon(lambda: all(path.exists() and path.read_text() for path in files))
    build.kill()
    build.wait()
    assert soon(lambda: not any(alive(int(path.read_text())) for path in files))


def soon(holds):
    """Return whether something comes true within a minute."""
    return any(holds() or time.sleep(0.05) for _ in range(1200))


def alive(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.slow
@pytest.mark.usefixtures("interruptible")
def test_a_build_stopped_at_the_keyboard_goes_on(made, module, tmp_path):
    homes = ["--homes", made.settings.homes_folder, "--home", "cabin"]
    options = [
        *homes,
        "--out",
        str(tmp_path),
        "--action-set",
        "2",
        "--pictures",
        "0",
        "--videos",
        "0",
        "--workers",
        "2",
    ]
    command = [sys.executable, "-m", "hearth.cli", "build", *made.settings.sources, *options]
    build = subprocess.Popen(command, stderr=subprocess.PIPE, start_new_session=True, text=True)
    for _ in range(6000):
        if (tmp_path / "ingest/manifest.json").exists() or build.poll() is not None:
            break
        time.sleep(0.01)
    os.killpg(build.pid, signal.SIGINT)
    message = build.communicate(timeout=120)[1]
    assert build.returncode == 130, message
    assert "continues from there" in message and "Traceback" not in message
    assert not (tmp_path / "publish/manifest.json").exists()
    assert subprocess.run(command, check=False, capture_output=True).returncode in (0, 1)
    assert module("benchmarks/killed_builds.py").differing(made.out, tmp_path) == []
