"""The loop that all stages share: read, process, count, reject, write, resume.

A stage's author writes `process(record, context)`: one record in; rows out, or a `Reject` with code and place. This
module does the rest. Every record ends in rows or in rejects, and an exception loses only its own record.
"""

from __future__ import annotations

import errno
import importlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain, islice
from pathlib import Path
from typing import Any

import pyarrow as pa

from hearth.pipelines.engine.dependencies import code_digest
from hearth.pipelines.engine.record_deadline import Deadline, OverTime
from hearth.pipelines.engine.settings import Settings
from hearth.schemas.failures import Code
from hearth.schemas.row_types import Row
from hearth.storage.batch_sizes import RECORDS_CONVERTED
from hearth.storage.files import value_digest
from hearth.storage.folder_exchange import beside
from hearth.storage.partitions import Counts, PartWriter, read_rows
from hearth.storage.rejects import Reject, as_text

Plan = dict[str, Any]

NOTE = "note"
"""Entry of a plan about records that are left out without being rejects; the ledger has it."""

Output = Row | Reject | tuple[str, Row]

BATCH = RECORDS_CONVERTED
"""Its name in 0.2."""


@dataclass(frozen=True, slots=True)
class Partition:
    """A share of a stage's input that is processed and written as one.

    Attributes:
        number: its place, from 0.
        digest: of its input's content.
        payload: input of `Stage.records`, small and picklable; by default the paths of parts.
        size: the number of records, if known.
        rows: the (first, end) rows of a part that several partitions share.
    """

    number: int
    digest: str
    payload: Any
    size: int | None = None
    rows: tuple[int, int] | None = None


@dataclass(frozen=True)
class Stage:
    """One stage of the pipeline, as its author defines it.

    Attributes:
        name: also the name of its folder and command.
        tables: columns by table; a stage with one table calls it "".
        process: one record to its rows (`(table, row)` if there are several tables) or its reject. A reject among
            rows refuses a part of the record.
        reads: the stages whose rows are its records, in order.
        needs: further stages that must be complete.
        settings: names of the options that its output depends on.
        open: makes the context for `process`, once a process.
        prepare: makes the plan from all of the input, before any record; the plan is part of the job's key.
        begin: prepares the folder, before the first partition.
        partitions: shares of the input; by default the parts of the stages it reads.
        records: the records of a partition; by default the rows of its part.
        select: whether a row of the input is a record.
        identify: the id of a record.
        columns: columns of the input to read; None for all.
        batch: the number of records whose rows are converted to Arrow together.
        labels: the labels under which a row is counted, once for each.
        finish: writes the tables that need all partitions, before the manifest.
        facts: further entries of the manifest.
        time_factor: multiplies the time limit of a record.
        share: rows of a part that make a partition, for parts too large to spread over workers; None for all.
        gather: rows up to which parts are gathered in one partition; 0 for one partition a part.
        exchanged: whether the folder is read during a build; it is then written elsewhere and replaced in one step.
        tables_of: columns by table where they depend on the settings; the tables are always those of `tables`.

    Workers find a stage by its module, which must name it `STAGE` and define `process`.
    """

    name: str
    tables: Mapping[str, pa.Schema]
    process: Callable[[Any, Any], Iterable[Output] | Reject]
    reads: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    settings: tuple[str, ...] = ()
    open: Callable[[Job], Any] = lambda job: job
    prepare: Callable[[Settings], Plan] = lambda settings: {}
    begin: Callable[[Job], None] | None = None
    partitions: Callable[[Job], Iterator[Partition]] | None = None
    records: Callable[[Job, Partition], Iterable[Any]] | None = None
    select: Callable[[Any, Plan], bool] = lambda record, plan: True
    identify: Callable[[Any], str] = lambda record: str(record["program_id"])
    columns: tuple[str, ...] | None = None
    batch: Callable[[Partition], int] = lambda partition: RECORDS_CONVERTED
    labels: Callable[[Any], Sequence[str]] = lambda row: ()
    finish: Callable[[Job, Counts], None] | None = None
    facts: Callable[[Job], dict[str, Any]] = lambda job: {}
    time_factor: int = 1
    share: int | None = None
    gather: int = 0
    exchanged: bool = False
    tables_of: Callable[[Settings], Mapping[str, pa.Schema]] | None = None

    def __reduce__(self) -> tuple[Callable[[str], Stage], tuple[str]]:
        """Pickle a stage as the name of the module that defines it."""
        return _stage_of, (self.process.__module__,)


def _stage_of(module: str) -> Stage:
    stage: Stage = importlib.import_module(module).STAGE
    return stage


@dataclass(frozen=True)
class Job:
    """A stage, its settings and its plan: all that a worker needs."""

    stage: Stage
    settings: Settings
    plan: Plan = field(default_factory=dict)

    def __reduce__(self) -> tuple[type[Job], tuple[Stage, Settings, Plan]]:
        """Pickle without the context: each process opens its own."""
        return Job, (self.stage, self.settings, self.plan)

    @property
    def folder(self) -> Path:
        """Return the folder of the stage."""
        folder = self.settings.folder(self.stage.name)
        return beside(folder) if self.stage.exchanged else folder

    @cached_property
    def tables(self) -> Mapping[str, pa.Schema]:
        """Return the columns by table."""
        return self.stage.tables_of(self.settings) if self.stage.tables_of else self.stage.tables

    @cached_property
    def context(self) -> Any:
        """Return the context that the stage opened in this process."""
        return self.stage.open(self)

    @cached_property
    def key(self) -> str:
        """Digest of everything that decides the output but the input."""
        return value_digest(self.asked())

    def asked(self) -> dict[str, Any]:
        """Stage, code, options and plan, as stored in the manifest."""
        return {
            "stage": self.stage.name,
            "code": code_digest(self.stage.process.__module__, __name__, "hearth.version"),
            "settings": self.settings.chosen(self.stage.settings),
            "plan": self.plan,
        }

    def part_key(self, partition: Partition) -> str:
        """Digest of everything that decides a partition's bytes."""
        return value_digest([self.key, partition.number, partition.digest])


RecordsSeen = Callable[[int, int], None]
"""Called with the numbers of further records and of further rejects."""

Done = tuple[Partition, Counts]
"""A written partition and its counts."""


def run_partition(job: Job, partition: Partition, seen: RecordsSeen) -> Counts:
    """Process one partition and write it."""
    stage = job.stage
    writer = PartWriter(job.folder, job.tables, partition.number, job.part_key(partition))
    deadline = Deadline(job.settings.time_limit * stage.time_factor)
    try:
        sink = _Sink(job, partition, writer)
        for record in records_of(job, partition):
            before = sink.counts.rejected
            sink.take(_name(stage, record), _attempt(stage, record, job.context, deadline))
            seen(1, sink.counts.rejected - before)
        sink.flush()
        sink.counts.check(f"{stage.name}, partition {partition.number}")
        writer.finish(sink.counts)
    except BaseException:
        writer.abandon()
        raise
    finally:
        deadline.close()
    return sink.counts


def records_of(job: Job, partition: Partition) -> Iterable[Any]:
    """Return the records of a partition, as the stage has them."""
    return (job.stage.records or rows_of)(job, partition)


def rows_of(job: Job, partition: Partition) -> Iterator[Any]:
    """Yield the rows of a partition that the stage selects."""
    stage = job.stage
    columns = list(stage.columns) if stage.columns is not None else None
    rows: Iterable[Any] = chain.from_iterable(read_rows(Path(path), columns) for path in partition.payload)
    if partition.rows is not None:
        rows = islice(rows, *partition.rows)
    return (row for row in rows if stage.select(row, job.plan))


def _name(stage: Stage, record: Any) -> str:
    """Return the id of a record, or "" if it has none."""
    try:
        return as_text(stage.identify(record))
    except Exception:
        return ""


def _place(record: Any) -> str:
    return as_text(record.get("place")) if isinstance(record, dict) else ""


def _attempt(stage: Stage, record: Any, context: Any, deadline: Deadline) -> list[Output]:
    """Return the outputs of a record; after an exception or a time-out, a reject alone."""
    try:
        with deadline:
            outputs = stage.process(record, context)
            return [outputs] if isinstance(outputs, Reject) else list(outputs)
    except OverTime:
        message = f"took longer than {deadline.seconds:g} s"
        remedy = "give it more time with --time-limit"
        return [Reject.of(Code.TIMED_OUT, message, file=_place(record), suggestion=remedy)]
    except (KeyboardInterrupt, SystemExit, GeneratorExit):
        raise
    except BaseException as error:  # compiled libraries panic with errors that are not an `Exception`
        if _stops_the_stage(error):
            raise
        return [Reject.caused(error, _place(record))]


def _stops_the_stage(error: BaseException) -> bool:
    """Return whether the disk is full.

    The stage stops, complete parts are kept, and the next run continues from there.
    """
    return isinstance(error, OSError) and error.errno in _FULL


_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EFBIG)


@dataclass(slots=True)
class _Outcome:
    """The outputs of one record, ready to be written.

    Attributes:
        rows: each with its table.
        rejects: number of refused parts; without rows, the whole record is refused.
        faults: rows of the table of rejects.
        code: the code of the first fault.
        labels: labels by which its rows are counted.
    """

    rows: list[tuple[str, Row]]
    rejects: int
    faults: list[Row]
    code: str
    labels: list[str]


class _Sink:
    """Counts the outputs of records and writes them in batches."""

    def __init__(self, job: Job, partition: Partition, writer: PartWriter) -> None:
        self.stage, self.number, self.writer, self.tables = job.stage, partition.number, writer, job.tables
        self.batch = job.stage.batch(partition)
        self.counts = Counts()
        self._waiting: list[tuple[str, _Outcome]] = []

    def take(self, record_id: str, outputs: list[Output]) -> None:
        """Add the outputs of one record."""
        self.counts.records_in += 1
        try:
            outcome = self._sorted(outputs)
        except Exception as error:
            outcome = self._refused(error)
        self._waiting.append((record_id, outcome))
        if len(self._waiting) >= self.batch:
            self.flush()

    def _sorted(self, outputs: list[Output]) -> _Outcome:
        """Sort outputs.

        Raises:
            TypeError: a row is neither of a table that the stage has nor a reject with a fault.
        """
        rows: list[tuple[str, Row]] = []
        rejects: list[Reject] = []
        for output in outputs:
            if isinstance(output, Reject):
                rejects.append(output)
                continue
            table, row = output if isinstance(output, tuple) else ("", output)
            if table not in self.stage.tables or not isinstance(row, dict):
                raise TypeError(f"a {type(row).__name__} for table `{table}`, where a row of a known table is expected")
            rows.append((table, row))
        if not all(reject.diagnostics for reject in rejects):
            raise TypeError("a reject without a fault")
        if not outputs:
            raise AssertionError("this record gave neither rows nor a reject")
        faults = [fault for reject in rejects for fault in reject.rows()]
        labels = [label for _, row in rows for label in self.stage.labels(row)]
        return _Outcome(rows, len(rejects), faults, rejects[0].code if rejects else "", labels)

    def _refused(self, error: Exception) -> _Outcome:
        reject = Reject.caused(error)
        return _Outcome([], 1, reject.rows(), reject.code, [])

    def flush(self) -> None:
        """Write the waiting records. If a row does not fit its table, only its record is refused."""
        try:
            self._write(self._waiting)
        except Exception as error:
            if isinstance(error, OSError):
                raise
            for one in self._waiting:
                try:
                    self._write([one])
                except Exception as own:
                    self._write([(one[0], self._refused(own))])
        self._waiting.clear()

    def _write(self, records: list[tuple[str, _Outcome]]) -> None:
        batches = [
            (table, self._batch(schema, [row for _, outcome in records for to, row in outcome.rows if to == table]))
            for table, schema in self.tables.items()
        ]
        for table, batch in batches:
            if len(batch):
                self.writer.write(table, batch)
                self.counts.rows[table.partition(".")[0]] += len(batch)
        for record_id, outcome in records:
            self._count(record_id, outcome)

    def _batch(self, schema: pa.Schema, rows: list[Row]) -> pa.RecordBatch:
        names = frozenset(schema.names)
        for columns in {tuple(row) for row in rows}:
            if not names.issuperset(columns):
                raise TypeError(f"columns that the table lacks: {', '.join(sorted(map(str, {*columns} - names)))}")
        return pa.RecordBatch.from_pylist(rows, schema)

    def _count(self, record_id: str, outcome: _Outcome) -> None:
        counts, partial = self.counts, bool(outcome.rows)
        counts.through += partial
        counts.rejected += not partial
        counts.tally.update(outcome.labels)
        if partial:
            counts.partial += outcome.rejects
        else:
            counts.codes[outcome.code] += 1
        for number, fault in enumerate(outcome.faults):
            origin = {"stage": self.stage.name, "record_id": record_id, "partial": partial, "partition": self.number}
            self.writer.reject([{**fault, **origin, "fault": number}])
