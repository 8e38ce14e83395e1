"""Times of the stages per record, and for 30,000 augmented programs: `python benchmarks/stages_speed.py`.

Builds a small dataset as the tier `full` is built (the embedded corpus and as many synthetic programs, two homes each),
then runs records drawn from all over each stage's input again and again by themselves; and turns their rows into
Parquet and back. From the sums it says how long two processors would take for the tier, from sampling to publishing,
were they never taken away; `build_scale.py` builds it whole and says how long it took.
"""

from __future__ import annotations

import gc
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import plain_reference
import pyarrow as pa
import pyarrow.parquet as pq
from measurement import Figure, Passes, as_line, finish, parser, passes, rate, seconds

from hearth.pipelines.build import stage
from hearth.pipelines.engine.option_presets import TIERS
from hearth.pipelines.engine.runner import input_partitions
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.stage import Job, records_of
from hearth.storage.batch_sizes import ROWS_READ
from hearth.storage.partitions import read_rows, write_table

ROOT = Path(__file__).resolve().parents[1]
CORPUS = (ROOT / "data_raw/crowd/descriptions.csv", ROOT / "data_raw/crowd/programs.csv")
STAGES = ("sample", "augment", "publish")
RECORDS = 60
TIMES = 7

WHOLE, ALLOWED = 30_000, 120.0
"""Number of augmented programs, and the target in seconds on two processors."""

TARGET = 4_500
"""Augmented programs of the small dataset: as many per execution as in the tier, about five per program."""


@dataclass(frozen=True)
class Cost:
    """Seconds per record of one stage: of processing it, and of writing and reading its rows.

    `written` is the yardstick of the latter: the same rows as lines of JSON.
    """

    process: Passes
    storage: Passes
    written: plain_reference.Yardstick
    records: int

    @property
    def undisturbed(self) -> float:
        """Seconds per record."""
        return (self.process.least + self.storage.least) / self.records


def main() -> None:
    """Build, measure, print."""
    arguments = parser(__doc__)
    arguments.add_argument("--programs", type=int, default=300, help="synthetic programs besides the corpus")
    arguments.add_argument("--out", type=Path, help="a build's folder, to measure instead of building one")
    asked = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        out = asked.out or built(Path(folder), asked.programs)
        found = []
        for figure in figures(out, Path(folder)):
            found.append(figure)
            print(as_line(figure), flush=True)
    finish(found, asked.json)


def built(folder: Path, programs: int) -> Path:
    """A small dataset of the tier."""
    more, out = folder / "synthetic.jsonl", folder / "out"
    words = [
        ["corpus", "synthesize", programs, "--out", more],
        ["build", *CORPUS, more, "--out", out, "--tier", "full"],
    ]
    for command in words:
        subprocess.run([sys.executable, ROOT / "cli.py", *map(str, command)], check=True, capture_output=True)
    return out


def figures(out: Path, folder: Path) -> Iterator[Figure]:
    """A record's cost by stage, and the extrapolation to the tier."""
    settings = Settings(out=str(out), **{**TIERS["full"], "target": TARGET})
    costs, counts = {}, {}
    sampled_runs = plain_reference.sampled_runs()
    for name in STAGES:
        job = Job(stage(name), settings, stage(name).prepare(settings))
        costs[name] = cost(job, folder)
        counts[name] = sum(1 for _ in records(job))
        own = costs[name]
        ratio = sampled_runs.ratio(own.records, own.process)
        yield rate(f"{name}: records processed", own.records, own.process, "records/s", ratio=ratio)
        ratio = own.written.ratio(1, own.storage)
        yield rate(f"{name}: their rows written and read", own.records, own.storage, "records/s", ratio=ratio)
    augmented = sum(1 for _ in rows(out / "augment"))
    every = sum(costs[name].undisturbed * counts[name] for name in STAGES)
    share = Passes([every * WHOLE / augmented / 2], every * WHOLE / augmented / 2)
    yield seconds(f"{WHOLE:,} augmented programs on two processors, undisturbed", share, target=ALLOWED)


def cost(job: Job, folder: Path) -> Cost:
    """The cost of records drawn evenly from a stage's input."""
    every = list(records(job))
    some = every[:: max(1, len(every) // RECORDS)][:RECORDS]
    context = job.stage.open(job)
    outputs: list[Any] = []
    for record in some:
        outputs.append(list(job.stage.process(record, context)))
    gc.collect()
    gc.freeze()
    process = passes(lambda record: list(job.stage.process(record, context)), some, TIMES)
    storage = [passes(lambda step: step(), list(steps), TIMES) for steps in stores(job, outputs, folder)]
    whole = Passes(
        [sum(totals) for totals in zip(*(part.totals for part in storage), strict=True)], sum(p.least for p in storage)
    )
    written = plain_reference.lines_of_json([row for output in outputs for row in output])
    return Cost(process, whole, written, len(some))


def stores(job: Job, outputs: list[Any], folder: Path) -> Iterator[Iterator[Callable[[], object]]]:
    """For each table, the steps of writing and reading the rows of as many records as in the stages."""
    for table, schema in job.tables.items():
        found = [row for output in outputs for to, row in map(_addressed, output) if to == table]
        if found:
            yield _stored(found, schema, folder / "rows.parquet")


def _addressed(output: Any) -> tuple[str, Any]:
    if isinstance(output, tuple):
        return output
    return ("", output) if isinstance(output, dict) else ("rejected", output)


def _stored(found: list[Any], schema: pa.Schema, path: Path) -> Iterator[Callable[[], object]]:
    shares = [found[at : at + ROWS_READ] for at in range(0, len(found), ROWS_READ)]
    batches = [pa.RecordBatch.from_pylist(share, schema) for share in shares]
    table = pa.Table.from_batches(batches)
    yield from (lambda share=share: pa.RecordBatch.from_pylist(share, schema) for share in shares)
    yield lambda: write_table(path, table)
    yield lambda: list(pq.ParquetFile(path).iter_batches(batch_size=ROWS_READ))
    yield from (batch.to_pylist for batch in batches)


def records(job: Job) -> Iterator[Any]:
    """All records of a stage."""
    for partition in (job.stage.partitions or input_partitions)(job):
        yield from records_of(job, partition)


def rows(folder: Path) -> Iterator[Any]:
    """All rows of a stage's first table."""
    for path in sorted(folder.glob("part-*.parquet")):
        yield from read_rows(path)


if __name__ == "__main__":
    main()
