"""`kill -9` during a long job: `python benchmarks/killed_builds.py [--job build] [--times 200] [--chain 5]`.

Does the job undisturbed, then again and again in another folder, each time killing all of its processes at a random
moment; the same command goes on from what is there. Whenever one gets to its end its bytes are compared with those of
the undisturbed one. The status is 1 when they differ or anything half-written is left. The jobs are those of `JOBS`.
"""

from __future__ import annotations

import argparse
import os
import random
import re
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

MEASURED = re.compile(rb"(\bminutes['\"]?: )[0-9.]+")
"""The time of a training, which its checkpoint reports."""

STUDY = """
name: short
title: A short study
room: play
seed: 3
people: 4
consent: You may stop.
tasks: {challenge: owah, split: test, number: 4}
conditions: [{name: alone, title: Alone}, {name: hp_rg, title: HP_RG, helper: hp_random, goal: random}]
questions: [{name: helpful, text: How was it, scale: {from: 1, to: 7}}]
"""

MINI = ("build", "--tier", "mini", "--pictures", "1", "--workers", "2", "--out")

DEMOS = ("build", "--tier", "demos", "--demonstrations", "4", "--limit", "12", "--workers", "2", "--out")

JOBS: dict[str, tuple[str, ...]] = {
    "build": (*MINI, "{out}"),
    "clips": ("build", "--tier", "clips", "--clips", "3", "--limit", "40", "--workers", "2", "--out", "{out}"),
    "demos": (*DEMOS, "{out}"),
    "run": ("challenge", "run", "{given}/tasks.json", "--helper", "hp_true", "--seeds", "2", "--out", "{out}/r.jsonl"),
    "challenge": ("challenge", "build", "wah", "--limit", "40", "--workers", "2", "--out", "{out}"),
    "train": ("model", "train", "unaries", "{given}/dataset", "--epochs", "4", "--out", "{out}"),
    "demo2sketch": (
        "model",
        "train",
        "demo2sketch",
        "{given}/dataset",
        "--epochs",
        "3",
        "--set",
        "hidden=32",
        "--out",
        "{out}",
    ),
    "learn": ("challenge", "learn", "wah", "--limit", "24", "--epochs", "4", "--workers", "2", "--out", "{out}"),
    "help": (
        "challenge",
        "learn",
        "wah",
        "--what",
        "subgoals",
        "--limit",
        "6",
        "--epochs",
        "1",
        "--workers",
        "2",
        "--out",
        "{out}",
    ),
    "tables": (
        "model",
        "tables",
        "{given}/dataset",
        "--table",
        "5.4",
        "--seeds",
        "1",
        "--minutes",
        "0.0001",
        "--most",
        "8",
        "--out",
        "{out}",
    ),
    "study": ("study", "simulate", "{given}/study.yaml", "--workers", "2", "--out", "{out}"),
}
"""Commands, by the names of jobs; `{given}` is a folder with what they read, `{out}` the one that they write to."""

GIVEN: dict[str, tuple[str, ...]] = {
    "demos": (*DEMOS, "{out}"),
    "run": ("challenge", "tasks", "wah", "--limit", "20", "--out", "{given}/tasks.json"),
    "train": (*MINI, "{given}/dataset"),
    "tables": (*MINI, "{given}/dataset"),
    "demo2sketch": (*DEMOS, "{given}/dataset"),
}
"""Commands that make what a job reads."""


def contents(out: Path) -> dict[str, bytes]:
    """The contents of a build's deterministic files, by name."""
    return {
        path.relative_to(out).as_posix(): MEASURED.sub(rb"\1", path.read_bytes())
        for path in sorted(out.rglob("*"))
        if path.is_file() and path.name not in VARYING
    }


def started(words: Sequence[str], out: Path) -> subprocess.Popen[bytes]:
    """Start a command in a new process group."""
    out.mkdir(parents=True, exist_ok=True)
    given = out.parent / "given"
    command = [
        sys.executable,
        str(CLI),
        *(word.replace("{out}", str(out)).replace("{given}", str(given)) for word in words),
    ]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)


def finished(words: Sequence[str], out: Path) -> None:
    """Do a job to its end.

    Raises:
        SystemExit: it failed.
    """
    status = started(words, out).wait()
    if status:
        raise SystemExit(f"{words[0]} ended with status {status} in {out}")


def given(job: str, folder: Path) -> None:
    """Make what a job reads."""
    folder.mkdir()
    (folder / "study.yaml").write_text(STUDY)
    if job in GIVEN:
        finished(GIVEN[job], folder.parent / "whole")
        shutil.rmtree(folder.parent / "whole")


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
        raise SystemExit(f"the undisturbed job ended with status {process.returncode}")
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
        print(f"{kills} killed, {ends} got to their end, {len(faults)} files differed", *found, flush=True)
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
        raise SystemExit(f"{options[0]} ended with status {process.returncode} in {out}")
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
    parser.add_argument("--job", choices=list(JOBS), default="build")
    parser.add_argument("--times", type=int, default=200)
    parser.add_argument("--chain", type=int, default=5, help="kills before a build may go on to its end")
    parser.add_argument("--limit", type=int, help="of a build: programs read")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    words = [*JOBS[asked.job], *(["--limit", str(asked.limit)] if asked.limit else [])]
    with tempfile.TemporaryDirectory() as folder:
        given(asked.job, Path(folder) / "given")
        kills, ends, faults = killed(words, Path(folder), asked.times, asked.seed, asked.chain)
    print(f"{asked.job}: {kills} killed, {ends} got to their end, {len(faults)} files differed", *faults, sep="\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
