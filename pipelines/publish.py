"""Stage 6: the published tables. An execution that its published row does not reproduce is refused."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from itertools import chain
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from hearth.datasets.format.action_set_tables import tables_of
from hearth.datasets.format.case_rows import difference_from, harm_row, rerun
from hearth.datasets.format.datasheet import STRENGTH
from hearth.datasets.format.ids import activity_id, stamp
from hearth.datasets.format.splits import BY_CASE, SHARES, share_of
from hearth.kb.action_sets import LATEST, USUAL
from hearth.pipelines.engine.build_homes import Homes
from hearth.pipelines.engine.final_tables import finish, strength_used
from hearth.pipelines.engine.runner import input_partitions
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.split_assignment import Assignment, assignment
from hearth.pipelines.engine.stage import Job, Partition, Stage
from hearth.pipelines.engine.user_overlays import overlays, overlays_used
from hearth.schemas.failures import Code
from hearth.schemas.published_rows import EnvironmentRow, ExecutionRow, PerturbedRow, ProgramRow, RepairedRow
from hearth.schemas.row_types import Row, columns_of
from hearth.schemas.stage_rows import CaseRow
from hearth.schemas.tables import TABLES
from hearth.storage.files import value_digest
from hearth.storage.partitions import read_rows
from hearth.storage.rejects import Reject


def _per_case(settings: Settings) -> dict[str, pa.Schema]:
    """Return the columns of the tables whose rows come from one case each, by the action set."""
    tables = tables_of(settings.action_set or USUAL)
    return {share_of(table, share): tables[table] for table in BY_CASE for share in SHARES}


PER_CASE = {share_of(table, share): TABLES[table] for table in BY_CASE for share in SHARES}
"""Tables whose rows come from one case each, by the part of its program; the others need all cases."""

GATHER = 2_048
"""Cases published in one file: a query opens every file's footer, so files should be few."""


class Context:
    """Homes, and the program and environment published last: both may be those of several cases."""

    def __init__(self, job: Job) -> None:
        self.homes, self._job = Homes(job.settings), job
        action_set = job.settings.action_set or USUAL
        self.versions, self.counts_harm = stamp(action_set), action_set == LATEST
        self.last = self.environment = ""

    @cached_property
    def assignment(self) -> Assignment:
        """The part of every program, made once and not by the workers."""
        files = [Path(path) for part in input_partitions(self._job) for path in part.payload]
        return assignment(files, self._job.settings.seed)


class SplitCaseRow(CaseRow):
    """A case with the part of its program in the split `activities`."""

    split: str | None


def partitions(job: Job) -> Iterator[Partition]:
    """Yield the parts of the stages before, each with the parts of its programs."""
    part_of = job.context.assignment.part_of
    for partition in input_partitions(job):
        mine = {name: part_of(name) for name in _programs(partition.payload)}
        payload = partition.payload, [*mine.values()]
        yield replace(partition, digest=value_digest([partition.digest, mine]), payload=payload)


def _programs(paths: Iterable[str]) -> list[str]:
    """Return the ids of the programs of some files, in order."""
    tables = (pq.read_table(path, columns=["program_id"])["program_id"].unique().to_pylist() for path in paths)
    return sorted({*chain.from_iterable(tables)})


def records(job: Job, partition: Partition) -> Iterator[SplitCaseRow]:
    """Yield the cases of a partition."""
    paths, parts = partition.payload
    part_of = dict(zip(_programs(paths), parts, strict=True))
    cases: Iterator[CaseRow] = chain.from_iterable(read_rows(Path(path)) for path in paths)
    for case in cases:
        yield {**case, "split": part_of[case["program_id"]]}


def process(case: SplitCaseRow, context: Context) -> Iterable[tuple[str, Row]] | Reject:
    """Return the rows of one case, if replaying it gives the same execution."""
    execution = rerun(case, context.homes)
    difference = difference_from(execution, case)
    if difference:
        return Reject.of(Code.REPLAY_DIFFERS, difference, file=case["place"], found=case["execution_id"])
    return _rows(case, context, harm_row(execution) if context.counts_harm else {})


def _rows(case: SplitCaseRow, context: Context, harm: Mapping[str, Any]) -> Iterator[tuple[str, Row]]:
    """Yield the rows of a case; the run of an original in a perturbed environment is published if it fails there."""
    perturbed, part = case["parent_id"] is None and bool(case["perturbations"]), case["split"]
    versions = context.versions
    if not perturbed and case["program_id"] != context.last:
        context.last = case["program_id"]
        yield share_of("programs", part), {**program_row(case), **versions}
    # The outcome of repairing: for an original, nothing.
    came: Any = {"program_id": None, "execution_id": None, "parent_id": case["program_id"]} if perturbed else {}
    if case["environment_id"] != context.environment:
        context.environment = case["environment_id"]
        yield (
            share_of("environments", part),
            {**columns_of(EnvironmentRow, {**case, **case["environment"]}), **versions},
        )
        for one in case["perturbations"]:
            yield (
                share_of("perturbations", part),
                {**columns_of(PerturbedRow, {**case, **came, **one}), **versions},
            )
    if not (perturbed and case["executable"]):
        yield share_of("executions", part), {**columns_of(ExecutionRow, case), **harm, **versions}
    for repair in case["repairs"]:
        yield share_of("repairs", part), {**columns_of(RepairedRow, {**case, **came, **repair}), **versions}


def program_row(case: SplitCaseRow) -> ProgramRow:
    """Return the program of a case."""
    place = case["place"] if case["line"] is None else f"{case['place']}:{case['line'] + 1}"
    return columns_of(ProgramRow, {**case, "place": place, "activity_id": activity_id(case["title"])})


STAGE = Stage(
    name="publish",
    tables=PER_CASE,
    tables_of=_per_case,
    process=process,
    reads=("sample", "augment"),
    needs=("ingest", "validate", "render"),
    settings=("seed", "action_set"),
    open=Context,
    prepare=overlays,
    partitions=partitions,
    records=records,
    gather=GATHER,
    exchanged=True,
    identify=lambda case: str(case["execution_id"]),
    finish=finish,
    facts=lambda job: {**overlays_used(job), STRENGTH: strength_used(job)},
)
