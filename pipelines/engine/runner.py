"""Runs one stage: an up-to-date stage and complete partitions are kept; the manifest is written last."""

import os
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from hearth.pipelines.engine.build_context import set_used
from hearth.pipelines.engine.engines import Engine
from hearth.pipelines.engine.progress import Progress
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.source_labels import source_digests
from hearth.pipelines.engine.stage import Job, Partition, Stage
from hearth.pipelines.engine.workers import Workers
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.tables import REJECTED
from hearth.storage.files import drop_temporary, value_digest, write_json
from hearth.storage.folder_exchange import put_in_place, recover, start_from, tidy
from hearth.storage.lock import locked
from hearth.storage.manifest import NAME, TIMING, Manifest, describe, read_manifest
from hearth.storage.partitions import Counts, part_path, part_state, rejects_path, write_table
from hearth.storage.remote_build_folders import store

REJECTS = "rejects.parquet"


@dataclass(frozen=True, slots=True)
class Result:
    """A complete stage; `fresh` is False if it was up to date."""

    manifest: Manifest
    fresh: bool


def run_stage(
    stage: Stage, settings: Settings, workers: Engine | None = None, progress: Progress | None = None
) -> Result:
    """Bring a stage's folder up to date.

    Raises:
        HearthError: a stage that it reads is missing, another build uses the folder, or it cannot be written.
    """
    progress = progress or Progress()
    try:
        with locked(Path(settings.out)):
            return _run(stage, settings, workers or Workers(), progress)
    except OSError as error:
        raise HearthError.of(
            Code.UNWRITABLE,
            f"cannot write: {error.strerror or error}",
            file=str(error.filename or settings.folder(stage.name)),
            suggestion="free some space, or choose a folder you may write to with --out; complete parts are kept",
        ) from error


def _run(stage: Stage, settings: Settings, workers: Engine, progress: Progress) -> Result:
    inputs = _inputs(stage, settings)
    job = Job(stage, settings, stage.prepare(settings))
    key = value_digest([job.key, inputs])
    recover(settings.folder(stage.name))
    known = read_manifest(settings.folder(stage.name))
    if known and known.key == key and known.intact() and not known.counts.codes[Code.TIMED_OUT]:
        _tidy(job)
        os.utime(known.folder / NAME)
        progress.end(stage.name, known.counts, 0.0, fresh=False)
        return Result(known, fresh=False)
    began = time.monotonic()
    _clear(job)
    progress.start(stage.name, _total(stage, settings))
    if stage.begin:
        stage.begin(job)
    numbers, counts = _partitions(job, workers, progress)
    _gather_rejects(job, numbers)
    _drop_stale(job, numbers)
    _drop_leftovers(job.folder)
    if stage.finish:
        stage.finish(job, counts)
    counts.check(stage.name)
    facts = {**_set_of(job), **stage.facts(job), "counts": counts.to_json(), "parts": list(_parts(job, numbers))}
    manifest = describe(job.folder, job.asked(), inputs, key, **facts)
    seconds = time.monotonic() - began
    write_json(job.folder / TIMING, {"seconds": round(seconds, 3), "workers": workers.count})
    manifest.write()
    _put_in_place(job)
    progress.end(stage.name, counts, seconds, fresh=True)
    return Result(replace(manifest, folder=settings.folder(stage.name)), fresh=True)


def _set_of(job: Job) -> dict[str, str]:
    """Return the action set of a stage's rows, where they depend on it."""
    return set_used(job.settings) if "action_set" in job.stage.settings else {}


def _inputs(stage: Stage, settings: Settings) -> dict[str, str]:
    """Return the digest of each input of a stage, by name."""
    digests = {}
    for name in (*stage.reads, *stage.needs):
        manifest = read_manifest(settings.folder(name))
        if manifest is None:
            raise HearthError.of(
                Code.MISSING_FILE,
                f"stage `{stage.name}` reads the output of stage `{name}`, which is missing",
                file=str(settings.folder(name)),
                suggestion=f"run `{name}` first, or `build` for all stages",
            )
        digests[name] = manifest.digest
    return digests or source_digests(settings.sources)


def _total(stage: Stage, settings: Settings) -> int | None:
    if stage.partitions is not None and not stage.gather:  # it reads something else than all rows of those stages
        return None
    manifests = [read_manifest(settings.folder(name)) for name in stage.reads]
    return sum(int(part["rows"]) for manifest in manifests if manifest for part in manifest.parts)


def _clear(job: Job) -> None:
    """Remove the manifest, which marks a complete stage, and files written in part; a folder in use is kept."""
    if job.stage.exchanged:
        folder = job.settings.folder(job.stage.name)
        if job.settings.store and not job.folder.exists():
            store(job.settings.store).tidy(job.stage.name)
        start_from(folder, [*folder.rglob("part-*.parquet"), *folder.glob(REJECTS), *folder.glob(".rejects-*.parquet")])
    elif job.settings.store:
        store(job.settings.store).begin(job.stage.name)
    job.folder.mkdir(parents=True, exist_ok=True)
    (job.folder / NAME).unlink(missing_ok=True)
    _drop_leftovers(job.folder)


def _put_in_place(job: Job) -> None:
    """Move a complete stage to its place, here and in the store."""
    name = job.stage.name
    if job.stage.exchanged:
        put_in_place(job.settings.folder(name))
    _drop_gathered(job.settings.folder(name))
    if job.settings.store:
        remote = store(job.settings.store)
        (remote.replace if job.stage.exchanged else remote.end)(name)


def _tidy(job: Job) -> None:
    """Remove files that a build left if it was stopped just after its end."""
    folder = job.settings.folder(job.stage.name)
    _drop_gathered(folder)
    if job.stage.exchanged:
        tidy(folder)
        if job.settings.store:
            store(job.settings.store).tidy(job.stage.name)


def _drop_gathered(folder: Path) -> None:
    """Remove the rejects of single partitions, once the manifest lists the file that holds them all."""
    for path in folder.glob(".rejects-*.parquet"):
        path.unlink(missing_ok=True)


def _drop_leftovers(folder: Path) -> None:
    """Remove files that lost workers wrote in part."""
    drop_temporary(folder.rglob(".*"))


def input_partitions(job: Job) -> Iterator[Partition]:
    """Yield the parts of the stages that a stage reads, one partition each, unless the stage splits or gathers them."""
    waiting: list[Partition] = []
    number = 0
    for part in _input_parts(job):
        if waiting and sum(each.size or 0 for each in waiting) + (part.size or 0) > job.stage.gather:
            yield _gathered(number, waiting)
            number += 1
            waiting = []
        waiting.append(part)
    if waiting:
        yield _gathered(number, waiting)


def _gathered(number: int, parts: list[Partition]) -> Partition:
    if len(parts) == 1:
        return replace(parts[0], number=number)
    paths = tuple(path for part in parts for path in part.payload)
    return Partition(
        number, value_digest([part.digest for part in parts]), paths, sum(part.size or 0 for part in parts)
    )


def _input_parts(job: Job) -> Iterator[Partition]:
    """Yield the parts of the first table of the stages that a stage reads, or shares of them."""
    for name in job.stage.reads:
        folder = job.settings.folder(name)
        manifest = read_manifest(folder)
        assert manifest is not None
        for part in manifest.parts:
            file = part["files"][0]
            digest = manifest.content["files"][file]["sha256"]
            for rows in _shares(part["rows"], job.stage.share):
                content = digest if rows is None else f"{digest} {rows}"
                size = part["rows"] if rows is None else rows[1] - rows[0]
                yield Partition(0, content, (str(folder / file),), size, rows)


def _shares(rows: int, share: int | None) -> list[tuple[int, int] | None]:
    """Return the rows of a part for each partition, as (first, end); None for all of them."""
    if share is None or rows <= share:
        return [None]
    return [(first, min(first + share, rows)) for first in range(0, rows, share)]


def _partitions(job: Job, workers: Engine, progress: Progress) -> tuple[list[int], Counts]:
    """Run the partitions that are not complete."""
    numbers: list[int] = []
    counts = Counts()

    def missing() -> Iterator[Partition]:
        for partition in (job.stage.partitions or input_partitions)(job):
            numbers.append(partition.number)
            state = part_state(job.folder, job.stage.tables, partition.number)
            if state and state[0] == job.part_key(partition) and _is_whole(job, partition.number, state[1]):
                counts.add(state[1])
                progress.seen(state[1].records_in, state[1].rejected)
            else:
                _forget(job, partition.number)
                yield partition

    for _, done in workers.run(job, missing(), progress.seen):
        counts.add(done)
    return numbers, counts


def _forget(job: Job, number: int) -> None:
    """Remove a partition that is to be run again, its commit point first."""
    for table in reversed([*job.stage.tables]):
        part_path(job.folder, table, number).unlink(missing_ok=True)


def _is_whole(job: Job, number: int, counts: Counts) -> bool:
    """Return whether a partition's rejects are stored and none of its records timed out."""
    if not counts.rejected and not counts.partial:
        return True
    if counts.codes[Code.TIMED_OUT]:
        return False
    return rejects_path(job.folder, number).exists() or (job.folder / REJECTS).exists()


def _gather_rejects(job: Job, numbers: list[int]) -> None:
    """Put the rejects of all partitions into one file, in order."""
    folder = job.folder
    whole = folder / REJECTS
    earlier = pq.read_table(whole) if whole.exists() else REJECTED.empty_table()
    tables = []
    for number in numbers:
        path = rejects_path(folder, number)
        state = part_state(folder, job.stage.tables, number)
        if path.exists():
            tables.append(pq.read_table(path))
        elif state and (state[1].rejected or state[1].partial):
            tables.append(earlier.filter(pc.equal(earlier["partition"], number)))
    write_table(whole, pa.concat_tables(tables) if tables else REJECTED.empty_table())


def _drop_stale(job: Job, numbers: list[int]) -> None:
    """Remove parts of partitions that no longer exist."""
    kept = {part_path(job.folder, table, number) for table in job.stage.tables for number in numbers}
    for path in job.folder.rglob("part-*.parquet"):
        if path not in kept:
            path.unlink()


def _parts(job: Job, numbers: list[int]) -> Iterator[dict[str, object]]:
    for number in numbers:
        paths = [part_path(job.folder, table, number) for table in job.stage.tables]
        rows = sum(pq.read_metadata(path).num_rows for path in paths)
        yield {"files": [path.relative_to(job.folder).as_posix() for path in paths], "rows": rows}
