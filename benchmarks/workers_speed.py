"""Speedup by a second worker, and the cost of an empty partition.

    python benchmarks/workers_speed.py [--rounds N] [--json FILE]

Programs of the embedded corpus are augmented as in the tier `full`, by one worker and by two in turn, with processes
started before; the figure is the median of the rounds' ratios. On a shared machine single rounds vary widely.
"""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Any

import pyarrow as pa
from measurement import Figure, as_line, finish, parser, spread

from hearth.pipelines.build import stage
from hearth.pipelines.engine.option_presets import TIERS
from hearth.pipelines.engine.runner import run_stage
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.stage import Job, Partition, Stage, run_partition
from hearth.pipelines.engine.workers import Workers
from hearth.storage.parallel import unseen

ROOT = Path(__file__).resolve().parents[1]
CORPUS = tuple(str(ROOT / "data_raw/crowd" / name) for name in ("descriptions.csv", "programs.csv"))
PROGRAMS = 240
"""Enough for several partitions of sixty programs; a single one could not be shared."""

PARTITIONS = 200


def main() -> None:
    """Print a table."""
    known = parser(__doc__)
    known.add_argument("--rounds", type=int, default=5)
    asked = known.parse_args()
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for figure in (*speedup(Path(folder) / "corpus", asked.rounds), empty(Path(folder) / "empty")):
            found.append(figure)
            print(as_line(figure), flush=True)
    finish(found, asked.json)


def speedup(out: Path, rounds: int) -> Iterator[Figure]:
    """Seconds of one worker over those of two, for the same programs."""
    settings = Settings(CORPUS, str(out), **{**TIERS["full"], "target": 0, "limit": PROGRAMS})
    with Workers(1) as one, Workers(2) as two:
        for name in ("ingest", "validate", "sample", "augment"):
            run_stage(stage(name), settings, two)
        taken: dict[Workers, list[float]] = {one: [], two: []}
        for _ in range(rounds):
            for workers, times in taken.items():
                shutil.rmtree(out / "augment")
                began = time.perf_counter()
                run_stage(stage("augment"), settings, workers)
                times.append(time.perf_counter() - began)
    ratios = [a / b for a, b in zip(taken[one], taken[two], strict=True)]
    yield Figure("augment: two workers against one", median(ratios), "times", 1.7, spread=spread(ratios))


SCHEMA = pa.schema([("program_id", pa.string())])


def partitions(job: Job) -> Iterator[Partition]:
    """Many empty partitions."""
    return (Partition(number, str(number), (), 0) for number in range(PARTITIONS))


def records(job: Job, partition: Partition) -> Iterator[Any]:
    """None."""
    return iter(())


def process(record: Any, context: object) -> list[Any]:
    """Never called."""
    return [record]


EMPTY = Stage("empty", {"": SCHEMA}, process, partitions=partitions, records=records)


def empty(out: Path) -> Figure:
    """Milliseconds per empty partition: to read, to write, to sync."""
    job = Job(EMPTY, Settings((CORPUS[0],), str(out)), {})
    job.folder.mkdir(parents=True)
    taken = []
    for partition in partitions(job):
        began = time.perf_counter()
        run_partition(job, partition, unseen)
        taken.append(1e3 * (time.perf_counter() - began))
    return Figure("a partition of no work", median(taken), "ms", 20.0, spread=spread(taken), undisturbed=min(taken))


if __name__ == "__main__":
    main()
