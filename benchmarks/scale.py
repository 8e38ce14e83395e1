"""Does the cost stay linear and the memory flat? `python benchmarks/scale.py [--sizes 3000 30000] [--workers 2]`.

Builds datasets of so many augmented programs, from sampling to publishing, from the embedded corpus and synthetic
programs, and prints for each: wall and processor seconds a program, the largest process, bytes on disk. 300,000 take a
while; `--seed` draws others.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

from measuring import Figure, finish, tell

CLI = Path(__file__).resolve().parents[1] / "cli.py"
EACH = 6
"""Augmented programs of an execution, about; so many pairs are asked for."""


def main() -> None:
    """Build and tell."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", default=[3_000, 30_000])
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path, metavar="FILE")
    asked = parser.parse_args()
    figures = []
    for size in asked.sizes:
        with tempfile.TemporaryDirectory() as folder:
            found = measured(size, asked.workers, asked.seed, Path(folder))
        print(*map(tell, found), sep="\n", flush=True)
        figures += found
    finish(figures, asked.json)


def measured(size: int, workers: int, seed: int, folder: Path) -> list[Figure]:
    """One build of about `size` augmented programs."""
    programs, corpus = folder / "synthetic.jsonl", CLI.parent / "data_raw/crowd"
    run("corpus", "synthesize", max(50, size // 6), "--seed", seed, "--out", programs)
    given = [corpus / "descriptions.csv", corpus / "programs.csv", programs]
    options = ["--seed", seed, "--workers", workers, "--homes-each", 2, "--per-program", EACH, "--target", size]
    began = time.monotonic()
    with Watch() as watch:
        run("build", *given, "--out", folder / "out", *options, "--pictures", 0, "--videos", 0)
    seconds = time.monotonic() - began
    count = augmented(folder / "out")
    bytes_ = sum(file.stat().st_size for file in (folder / "out/publish").rglob("*.parquet"))
    name = f"{count:,} augmented programs, {workers} workers"
    shutil.rmtree(folder / "out")
    return [
        Figure(f"{name}: build", seconds, "s", 120 * size / 30_000),
        Figure(f"{name}: processor a program", 1e3 * watch.seconds / count, "ms"),
        Figure(f"{name}: largest process", watch.bytes / 1e6, "MB", 2_000),
        Figure(f"{name}: published on disk, a program", bytes_ / count, "bytes", 2_000),
    ]


def run(*words: object) -> None:
    """Run a command quietly.

    Raises:
        CalledProcessError: it failed.
    """
    subprocess.run([sys.executable, str(CLI), *map(str, words)], check=True, capture_output=True)


def augmented(out: Path) -> int:
    """How many augmented programs a build holds."""
    import pyarrow.parquet as pq

    return sum(pq.read_metadata(file).num_rows for file in (out / "augment").glob("part-*.parquet"))


class Watch:
    """Watches the processes below this one, every half second: the memory of the largest, the processor time of all.

    Workers are children of a process that nobody waits for, so that what the system counts for children leaves them
    out. What a process does in its last half second is not seen.
    """

    def __init__(self) -> None:
        self.bytes = 0
        self._spent: dict[int, float] = {}
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)

    @property
    def seconds(self) -> float:
        """Of processor, of all processes seen."""
        return sum(self._spent.values())

    def __enter__(self) -> Watch:
        self._thread.start()
        return self

    def __exit__(self, *error: object) -> None:
        self._over.set()
        self._thread.join()

    def _watch(self) -> None:
        while not self._over.wait(0.5):
            for process, spent in below().items():
                self._spent[process] = spent
                self.bytes = max(self.bytes, resident(process))


_TICKS = os.sysconf("SC_CLK_TCK")


def below() -> dict[int, float]:
    """All processes below this one, children and theirs, and the seconds of processor that each used itself."""
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
