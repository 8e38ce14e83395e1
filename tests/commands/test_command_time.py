"""Commands that work through a whole dataset end in their time, whatever is in it."""

from __future__ import annotations

import shutil
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.commands.bounded_process import in_time
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.databases import open_database
from hearth.storage.parallel import spread

ROOT = Path(__file__).resolve().parents[2]

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there are no timers on Windows")

WORDS = {
    "report": ("report", "{data}", "--out", "{out}", "--workers", "1"),
    "report in processes": ("report", "{data}", "--out", "{out}", "--workers", "2"),
    "diff": ("diff", "{data}", "{other}"),
    "export": ("export", "{data}", "--format", "release", "--out", "{out}"),
    "mine": ("kb", "mine", "{data}"),
    "verify": ("verify", "{data}", "--workers", "1"),
}


@pytest.mark.parametrize("name", WORDS)
def test_a_command_ends_in_its_time(made, tmp_path, name):
    data = made.out / "publish"
    words = [word.format(data=data, other=data, out=tmp_path / "out") for word in WORDS[name]]
    before = time.monotonic()
    result = CliRunner().invoke(cli.app, [*words, "--within", "0.0001"])
    assert result.exit_code == 1 and "TIMED_OUT" in result.stderr and "--within" in result.stderr, result.output
    assert time.monotonic() - before < 10


def test_a_limit_that_is_none_is_refused(made):
    for seconds in ("-1", "nan", "inf", "1e400"):
        result = CliRunner().invoke(cli.app, ["diff", str(made.out), str(made.out), "--within", seconds])
        assert result.exit_code in (1, 2) and ("--within" in result.output or "BAD_ARGUMENT" in result.output)


def loop():
    while True:
        with suppress(Exception):
            sum(range(1000))


def query():
    open_database().execute("SELECT count(*) FROM range(10_000_000_000) a, range(1_000_000) b").fetchall()


@pytest.mark.parametrize("does", [loop, query, lambda: [*spread(time.sleep, [60.0, 61.0], 2)], lambda: time.sleep(60)])
def test_loops_queries_and_processes_are_stopped(does):
    before = time.monotonic()
    with pytest.raises(HearthError) as found, in_time(1.0):
        does()
    assert found.value.diagnostics[0].code == Code.TIMED_OUT
    assert time.monotonic() - before < 8


def test_what_is_done_in_time_is_not_touched():
    with in_time(0.3):
        pass
    time.sleep(0.5)
    with pytest.raises(KeyError), in_time(5):
        raise KeyError
    with in_time(0):
        time.sleep(0.01)


def test_a_difference_of_a_hundred_thousand_equal_keys_ends_in_its_time(made, tmp_path):
    """A join of equal keys has ten thousand million rows; its file has some kilobytes."""
    data = tmp_path / "data"
    shutil.copytree(made.out / "publish", data)
    (part,) = (data / "descriptions").glob("*.parquet")
    row = pq.read_table(part).slice(0, 1)
    pq.write_table(pa.concat_tables([row] * 100_000), part)
    words = [sys.executable, str(ROOT / "cli.py"), "diff", str(data), str(data), "--within", "2"]
    before = time.monotonic()
    done = subprocess.run(words, check=False, capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and "TIMED_OUT" in done.stderr, done.stderr
    assert time.monotonic() - before < 20
