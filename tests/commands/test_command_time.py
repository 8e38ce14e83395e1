"""Commands that work through a whole dataset end in their time, whatever is in it."""

from __future__ import annotations

import shutil
import subprocess
import sys
import time
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.commands.bounded_process import in_time

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


def ended(*words):
    """Run a command in a process of its own: what heeds no interrupt in time is ended with its process."""
    before = time.monotonic()
    done = subprocess.run([sys.executable, *map(str, words)], check=False, capture_output=True, text=True, timeout=90)
    return done, time.monotonic() - before


@pytest.mark.parametrize("name", WORDS)
def test_a_command_ends_in_its_time(made, tmp_path, name):
    data = made.out / "publish"
    words = [word.format(data=data, other=data, out=tmp_path / "out") for word in WORDS[name]]
    done, _ = ended(ROOT / "cli.py", *words, "--within", "0.0001")
    assert done.returncode == 1 and "TIMED_OUT" in done.stderr and "--within" in done.stderr, done


def test_a_limit_that_is_none_is_refused(made):
    for seconds in ("-1", "nan", "inf", "1e400"):
        result = CliRunner().invoke(cli.app, ["diff", str(made.out), str(made.out), "--within", seconds])
        assert result.exit_code in (1, 2) and ("--within" in result.output or "BAD_ARGUMENT" in result.output)


SLOW = {
    "a loop": """
while True:
    with suppress(Exception):
        sum(range(1000))
""",
    "a query": """
open_database().execute("SELECT count(*) FROM range(10_000_000_000) a, range(1_000_000) b").fetchall()
""",
    "processes": "list(spread(time.sleep, [60.0, 61.0], 2))",
    "sleep": "time.sleep(60)",
}
BOUNDED = """
import time
from contextlib import suppress

from hearth.commands.bounded_process import in_time
from hearth.schemas.diagnostics import HearthError
from hearth.storage.duckdb_connections import open_database
from hearth.storage.parallel import spread

if __name__ == "__main__":
    try:
        with in_time(1.0):
            exec({code!r})
    except HearthError as error:
        print(error.diagnostics[0].code)
"""


@pytest.mark.parametrize("name", SLOW)
def test_loops_queries_and_processes_are_stopped(tmp_path, name):
    file = tmp_path / "slow.py"
    file.write_text(BOUNDED.format(code=SLOW[name]))
    done, seconds = ended(file)
    assert "TIMED_OUT" in done.stdout + done.stderr and seconds < 60, done


def test_what_is_done_in_time_is_not_touched():
    with in_time(2):
        pass
    time.sleep(2.2)
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
