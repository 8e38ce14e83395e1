"""Linearity of cost and memory: `python benchmarks/build_scale.py [--sizes 3000 30000] [--workers 2]`.

Builds datasets of the given numbers of augmented programs, from sampling to publishing, from the embedded corpus and
synthetic programs, and prints for each: wall and processor seconds per program, the largest process, bytes on disk, and
the share of each stage. `--seed` draws other programs. 300,000 take hours: with `--keep FOLDER` the build stays there,
and the same command continues it after a stop (the times are then those of the last run only).
"""

from __future__ import annotations

import argparse
import contextlib
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from measurement import Figure, as_line, finish

CLI = Path(__file__).resolve().parents[1] / "cli.py"
EACH = 6
"""Approximate number of augmented programs per execution, requested as pairs."""
STAGES = ("ingest", "validate", "sample", "augment", "publish")


def main() -> None:
    """Build and report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", default=[3_000, 30_000])
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="build below this folder and leave it there")
    parser.add_argument("--json", type=Path, metavar="FILE")
    asked = parser.parse_args()
    figures: list[Figure] = []
    before: list[Figure] = []
    for size in asked.sizes:
        with place(asked.keep, size) as folder:
            found = measured(size, asked.workers, asked.seed, folder)
        found += growth(before, found)
        print(*map(as_line, found), sep="\n", flush=True)
        before, figures = found, figures + found
    finish(figures, asked.json)


def growth(before: Sequence[Figure], found: Sequence[Figure]) -> list[Figure]:
    """Processor time of an item, and memory, over those of the size before: 1 where time is linear and memory flat."""
    return [
        Figure(f"{other.name}, over that of {one.name.split(':')[0]}", other.value / one.value, "times", 1.2)
        for one, other in zip(before, found, strict=False)
        if other.unit in ("ms", "MB") and one.value
    ]


@contextlib.contextmanager
def place(keep: Path | None, size: int) -> Iterator[Path]:
    """The folder of one build: a temporary one, or that of this size below `keep`."""
    if keep is None:
        with tempfile.TemporaryDirectory() as folder:
            yield Path(folder)
        return
    (keep / str(size)).mkdir(parents=True, exist_ok=True)
    yield keep / str(size)


def measured(size: int, workers: int, seed: int, folder: Path) -> list[Figure]:
    """One build of about `size` augmented programs."""
    programs, corpus = folder / "synthetic.jsonl", CLI.parent / "data_raw/crowd"
    if not programs.exists():
        run("corpus", "synthesize", max(50, size // 6), "--seed", seed, "--out", programs)
    given = [corpus / "descriptions.csv", corpus / "programs.csv", programs]
    options = ["--seed", seed, "--workers", workers, "--homes-each", 2, "--per-program", EACH, "--target", size]
    with Watch() as watch:
        run("build", *given, "--out", folder / "out", *options, "--pictures", 0, "--videos", 0)
    whole = watch.between(0, float("inf"))
    count = augmented(folder / "out")
    bytes_ = sum(file.stat().st_size for file in (folder / "out/publish").rglob("*.parquet"))
    name = f"{count:,} programs"
    stages = list(by_stage(watch, folder / "out"))
    return [
        Figure(f"{name}: build by {workers} workers", whole.seconds, "s", 120 * count / 30_000),
        Figure(f"{name}: published on disk, a program", bytes_ / count, "bytes", 2_000),
        Figure(f"{name}: processor a program", 1e3 * whole.spent / count, "ms"),
        Figure(f"{name}: largest process", whole.bytes / 1e6, "MB", 2_000),
        *(figure for stage, used in stages for figure in of_stage(f"{name}: {stage}", used, count)),
    ]


def of_stage(name: str, used: Used, count: int) -> list[Figure]:
    """The cost of one stage."""
    return [
        Figure(f"{name}: wall", used.seconds, "s"),
        Figure(f"{name}: processor a program", 1e3 * used.spent / count, "ms"),
        Figure(f"{name}: largest process", used.bytes / 1e6, "MB", 2_000),
    ]


def run(*words: object) -> None:
    """Run a command quietly.

    Raises:
        CalledProcessError: it failed.
    """
    subprocess.run([sys.executable, str(CLI), *map(str, words)], check=True, capture_output=True)


def augmented(out: Path) -> int:
    """Number of augmented programs in a build."""
    import pyarrow.parquet as pq

    parents = (
        pq.read_table(file, columns=["parent_id"])["parent_id"] for file in (out / "augment").glob("part-*.parquet")
    )
    return sum(len(each) - each.null_count for each in parents)


@dataclass(frozen=True)
class Used:
    """Wall seconds, processor seconds of all processes, and memory of the largest in bytes."""

    seconds: float
    spent: float
    bytes: int


class Watch:
    """Samples the descendant processes, every half second unless said: memory of the largest, processor time of all.

    Workers are children of a process that is not waited for, so the system's counters for children miss them. What a
    process does after its last sample is not seen.
    """

    def __init__(self, every: float = 0.5) -> None:
        self._every = every
        self._looks: list[tuple[float, float, int]] = []
        self._spent: dict[int, float] = {}
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def __enter__(self) -> Watch:
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._over.set()
        self._thread.join()

    def between(self, start: float, end: float) -> Used:
        """The resources used between two times (seconds since 1970); zeros without samples."""
        looks = [look for look in self._looks if start <= look[0] < end]
        if not looks:
            return Used(0.0, 0.0, 0)
        (first, before, _), (last, after, _) = looks[0], looks[-1]
        return Used(last - first, after - before, max(size for _, _, size in looks))

    def _watch(self) -> None:
        while not self._over.wait(self._every):
            found = below()
            self._spent.update(found)
            largest = max(map(resident, found), default=0)
            self._looks.append((time.time(), sum(self._spent.values()), largest))


def by_stage(watch: Watch, out: Path) -> Iterator[tuple[str, Used]]:
    """The resources of each stage that ran meanwhile; a stage's manifest is the last file that it writes."""
    start = 0.0
    for stage in STAGES:
        end = (out / stage / "manifest.json").stat().st_mtime
        used = watch.between(start, end)
        if used.bytes:
            yield stage, used
        start = end


_TICKS = os.sysconf("SC_CLK_TCK")


def below() -> dict[int, float]:
    """All descendant processes, with the processor seconds of each."""
    parents: dict[int, list[int]] = {}
    spent: dict[int, float] = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        process = int(stat.parent.name)
        parents.setdefault(int(fields[1]), []).append(process)
        spent[process] = (int(fields[11]) + int(fields[12])) / _TICKS
    found: dict[int, float] = {}
    waiting = [os.getpid()]
    while waiting:
        children = parents.get(waiting.pop(), [])
        found.update((child, spent[child]) for child in children)
        waiting += children
    return found


def resident(process: int) -> int:
    """Bytes in memory; 0 for a process that has ended."""
    try:
        lines = Path(f"/proc/{process}/status").read_text().splitlines()
    except OSError:
        return 0
    return next((1024 * int(line.split()[1]) for line in lines if line.startswith("VmRSS:")), 0)


if __name__ == "__main__":
    main()
