"""`kill -9` at random moments of a build: `python benchmarks/kills.py [--times 200] [--limit 40]`.

Builds the first programs of the embedded corpus undisturbed, then again and again in another folder, each time killing
all of the build's processes at a random moment; the next build goes on from what is there. Whenever one gets to its end
its bytes are compared with the undisturbed build's. The status is 1 when they differ or anything half-written is left.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

CLI = Path(__file__).resolve().parents[1] / "cli.py"
VARYING = {"timing.json", "catalog.duckdb", ".lock"}
"""Seconds, a database file whose bytes DuckDB does not fix, and who builds."""


def contents(out: Path) -> dict[str, bytes]:
    """All bytes that a build fixes, by name."""
    return {
        path.relative_to(out).as_posix(): path.read_bytes()
        for path in sorted(out.rglob("*"))
        if path.is_file() and path.name not in VARYING
    }


def started(options: Sequence[str], out: Path) -> subprocess.Popen[bytes]:
    """A build in a group of processes of its own."""
    command = [sys.executable, str(CLI), "build", *options, "--out", str(out)]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)


def finished(options: Sequence[str], out: Path) -> float:
    """Build to the end; the seconds it took.

    Raises:
        SystemExit: the build failed.
    """
    began = time.monotonic()
    status = started(options, out).wait()
    if status:
        raise SystemExit(f"a build ended with status {status} in {out}")
    return time.monotonic() - began


def differing(one: Path, other: Path) -> list[str]:
    """Names of files that only one build has, or that differ."""
    expected, found = contents(one), contents(other)
    names = sorted(expected.keys() | found.keys())
    return [name for name in names if expected.get(name) != found.get(name)]


def killed(options: Sequence[str], folder: Path, times: int, seed: int) -> tuple[int, int, list[str]]:
    """Kill builds.

    Returns:
        Kills that met a running build, builds that got to their end, and what differed in them.
    """
    whole, out = folder / "undisturbed", folder / "killed"
    longest = finished(options, whole)
    moments = random.Random(seed)
    kills = ends = 0
    faults: list[str] = []
    while kills < times:
        process = started(options, out)
        try:
            process.wait(timeout=moments.uniform(0.05, 1.1) * longest)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            kills += 1
            continue
        ends += 1
        faults += differing(whole, out)
        shutil.rmtree(out)
    finished(options, out)
    return kills, ends + 1, faults + differing(whole, out)


def main() -> int:
    """Kill, and tell."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--times", type=int, default=200)
    parser.add_argument("--limit", type=int, default=40, help="programs read")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    options = ["--limit", str(asked.limit), "--home", "maple", "--pictures", "1", "--videos", "0", "--workers", "2"]
    with tempfile.TemporaryDirectory() as folder:
        kills, ends, faults = killed(options, Path(folder), asked.times, asked.seed)
    print(f"{kills} builds killed, {ends} got to their end, {len(faults)} files differed", *faults, sep="\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
