"""`kill -9` at random moments of a build: `python benchmarks/kills.py [--times 200] [--chain 5] [--limit N]`.

Builds the tier `mini` undisturbed, then again and again in another folder, each time killing
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
from contextlib import suppress
from itertools import pairwise
from math import inf
from pathlib import Path

CLI = Path(__file__).resolve().parents[1] / "cli.py"
VARYING = {"timing.json", "catalog.duckdb", ".lock"}
"""Files with varying bytes: times, DuckDB's database, and the lock."""


def contents(out: Path) -> dict[str, bytes]:
    """The contents of a build's deterministic files, by name."""
    return {
        path.relative_to(out).as_posix(): path.read_bytes()
        for path in sorted(out.rglob("*"))
        if path.is_file() and path.name not in VARYING
    }


def started(options: Sequence[str], out: Path) -> subprocess.Popen[bytes]:
    """Start a build in a new process group."""
    command = [sys.executable, str(CLI), "build", *options, "--out", str(out)]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)


def finished(options: Sequence[str], out: Path) -> None:
    """Build to the end.

    Raises:
        SystemExit: the build failed.
    """
    status = started(options, out).wait()
    if status:
        raise SystemExit(f"a build ended with status {status} in {out}")


def differing(one: Path, other: Path) -> list[str]:
    """Names of files that only one build has, or that differ."""
    expected, found = contents(one), contents(other)
    names = sorted(expected.keys() | found.keys())
    return [name for name in names if expected.get(name) != found.get(name)]


def killed(options: Sequence[str], folder: Path, times: int, seed: int, chain: int = 5) -> tuple[int, int, list[str]]:
    """Kill builds, `chain` times before each may finish.

    The moment of a kill is a number of written files, not seconds: machines can stand still for longer than a build
    takes. The moments of one build are spread over all of it.

    Returns:
        Number of kills of a running build, number of finished builds, and the files that differed in them.
    """
    whole, out = folder / "undisturbed", folder / "killed"
    process = started(options, whole)
    total, numbers = written(process, whole), random.Random(seed)
    if process.wait():
        raise SystemExit(f"the undisturbed build ended with status {process.returncode}")
    kills = ends = 0
    faults: list[str] = []
    while kills < times:
        moments = [0, *sorted(numbers.randint(0, total) for _ in range(min(chain, times - kills)))]
        kills += sum(hit(options, out, after - before, numbers) for before, after in pairwise(moments))
        finished(options, out)
        ends += 1
        found = differing(whole, out)
        shutil.rmtree(out)
        faults += found
        print(f"{kills} builds killed, {ends} got to their end, {len(faults)} files differed", *found, flush=True)
    return kills, ends, faults


def hit(options: Sequence[str], out: Path, files: int, numbers: random.Random) -> bool:
    """Kill a build shortly after it has written `files` files; returns whether it was still running."""
    process = started(options, out)
    if written(process, out, files) >= files:
        time.sleep(numbers.uniform(0, LATER))
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return True
    if process.returncode:
        raise SystemExit(f"a build ended with status {process.returncode} in {out}")
    return False


LATER = 0.3
"""Greatest seconds from a file's appearance to the kill, so that kills also happen between two files."""


def written(process: subprocess.Popen[bytes], out: Path, upto: float = inf) -> int:
    """Number of files that a build has written, partial ones included, once it has ended or has written `upto`."""
    before, number = files(out), 0
    while number < upto and process.poll() is None:
        time.sleep(0.01)
        now = files(out)
        number += len(now - before)
        before = now
    return number


def files(out: Path) -> set[tuple[str, int, int]]:
    """All files by name, inode and time of change."""
    found = set()
    for folder, _, names in os.walk(out):
        for name in names:
            path = os.path.join(folder, name)  # noqa: PTH118 - thousands a second
            with suppress(FileNotFoundError):
                info = os.stat(path)  # noqa: PTH116
                found.add((path, info.st_ino, info.st_mtime_ns))
    return found


def main() -> int:
    """Kill builds and report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--times", type=int, default=200)
    parser.add_argument("--chain", type=int, default=5, help="kills before a build may go on to its end")
    parser.add_argument("--limit", type=int, help="programs read; as many as the tier has if not given")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    options = ["--tier", "mini", "--pictures", "1", "--workers", "2"]
    if asked.limit:
        options += ["--limit", str(asked.limit)]
    with tempfile.TemporaryDirectory() as folder:
        kills, ends, faults = killed(options, Path(folder), asked.times, asked.seed, asked.chain)
    print(f"{kills} builds killed, {ends} got to their end, {len(faults)} files differed", *faults, sep="\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
