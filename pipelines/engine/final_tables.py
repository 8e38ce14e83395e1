"""The tables that need all cases, the pictures and the catalog, published last."""

import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from hearth.datasets.dataset_homes import copy_homes
from hearth.datasets.dataset_knowledge import copy_overlay
from hearth.datasets.format import splits
from hearth.datasets.format.card import write_card
from hearth.datasets.format.catalog import write_catalog
from hearth.datasets.format.croissant import write_croissant
from hearth.datasets.format.ids import stamp
from hearth.datasets.format.image_tables import write_images
from hearth.datasets.format.row_conversion import node_row
from hearth.datasets.format.split_runs import Run, Runs
from hearth.datasets.format.split_summary import summary
from hearth.datasets.tensors import EDGE_TYPES
from hearth.kb.action_sets import USUAL, states_of_set
from hearth.kb.knowledge import Knowledge
from hearth.pipelines.engine.activity_tables import COUNTED, Activities
from hearth.pipelines.engine.annotated_sketches import ANNOTATED, Annotations, fitting, inherited_annotations
from hearth.pipelines.engine.build_homes import Homes
from hearth.pipelines.engine.stage import Job
from hearth.pipelines.engine.stages import STAGES, record_of
from hearth.pipelines.engine.tables_by_part import write_split_rows
from hearth.schemas import published_rows, stage_rows
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.row_types import Row
from hearth.schemas.tables import TABLES
from hearth.schemas.vocabulary import PROPERTIES, RELATIONS
from hearth.simulation.world.world import World
from hearth.storage.batch_sizes import ROWS_OF_A_FINAL_TABLE
from hearth.storage.files import replacing, sync_folder, write_json
from hearth.storage.manifest import Manifest, read_manifest
from hearth.storage.partitions import Counts, part_path, read_rows, write_batches
from hearth.storage.repeated_ids import repeated

BATCH = ROWS_OF_A_FINAL_TABLE
"""Its name in 0.2."""


def finish(job: Job, counts: Counts) -> None:
    """Write every table that needs all cases, then the catalog over them.

    Raises:
        HearthError: DUPLICATE, when two rows have one id.
    """
    _check_unique(job.folder)
    _write_activities(job)
    homes = job.context.homes
    annotated = _annotated(job)
    counts.partial += len(annotated.rejects)
    makers: dict[str, Callable[[], Iterable[Row]]] = {
        "homes": lambda: _homes(job, homes),
        "home_nodes": lambda: _home_nodes(job, homes),
        "home_edges": lambda: _home_edges(job, homes),
        "splits": lambda: _splits(job),
        "vocabulary": lambda: _vocabulary(homes.knowledge),
        "rejects": lambda: (*_rejects(job), *annotated.rejects),
        "ledger": lambda: _ledger(job, counts),
    }
    for table, rows in makers.items():
        write_rows(part_path(job.folder, table, 0), TABLES[table], rows(), _versions(job))
    _write_split(job, annotated.rows)
    _copy_pictures(job)
    write_images(job.folder)
    copy_overlay(job.settings.kb_folder, job.folder)
    copy_homes(job.settings.homes_folder, job.folder)
    strength = strength_used(job)
    action_set = job.settings.action_set or USUAL
    write_card(job.folder, strength, action_set)
    write_croissant(job.folder, strength, action_set)
    write_catalog(job.folder, action_set)


def _versions(job: Job) -> dict[str, str]:
    return stamp(job.settings.action_set or USUAL)


def write_rows(path: Path, schema: pa.Schema, rows: Iterable[Row], versions: Mapping[str, str]) -> None:
    """Write a table from rows, each stamped with the versions it belongs to."""
    path.parent.mkdir(parents=True, exist_ok=True)
    stamped = ({**row, **versions} for row in rows)
    shares = iter(lambda: list(islice(stamped, ROWS_OF_A_FINAL_TABLE)), [])
    write_batches(path, schema, (pa.RecordBatch.from_pylist(share, schema) for share in shares))


_KEYS = {"programs": "program_id", "environments": "environment_id", "executions": "execution_id"}


def _check_unique(folder: Path) -> None:
    for table, key in _KEYS.items():
        twice = repeated(folder / table, key)
        if twice is not None:
            message = f"two rows of `{table}` have the {key} `{twice}`"
            raise HearthError.of(Code.DUPLICATE, message, file=str(folder))


def _write_activities(job: Job) -> None:
    """Write the activities, and the descriptions, which are in memory no longer than that."""
    found = Activities(lambda columns: _rows(job, "ingest", columns=columns), _programs(job, COUNTED))
    for table, rows in (("activities", found.activity_rows()), ("descriptions", found.description_rows())):
        write_rows(part_path(job.folder, table, 0), TABLES[table], rows, _versions(job))


def _programs(job: Job, columns: list[str]) -> Iterator[Any]:
    """Yield the programs that are published."""
    for path in sorted((job.folder / "programs").glob("part-*.parquet")):
        yield from read_rows(path, columns)


def _write_split(job: Job, annotated: Iterable[stage_rows.SketchRow]) -> None:
    """Write the tables that descend from programs, each row to its program's part; a clip to the part that it names."""
    part_of = job.context.assignment.part_of
    sketches = ((part_of(row["program_id"]), row) for row in _sketches(job, annotated))
    write_split_rows(job.folder, "sketches", TABLES["sketches"], sketches, _versions(job))
    for table in splits.DRAWN:
        write_split_rows(job.folder, table, TABLES[table], _filmed(job, table), _versions(job))


def _sketches(job: Job, annotated: Iterable[stage_rows.SketchRow]) -> Iterator[stage_rows.SketchRow]:
    """Yield inferred and inherited sketches, annotated ones, and those that augmented programs inherit of these."""
    yield from _rows(job, "augment", "sketches")
    yield from annotated
    of_program = {row["program_id"]: row for row in annotated}
    if of_program:
        yield from inherited_annotations(_programs(job, ["program_id", "parent_id", "steps"]), of_program)


def _annotated(job: Job) -> Annotations:
    """Annotated sketches of published programs."""
    given = (row for row in _rows(job, "ingest", columns=list(ANNOTATED)) if row["kind"] == "sketch")
    return fitting(given, lambda names: _steps_of(job, names))


def _steps_of(job: Job, names: list[str]) -> dict[str, int]:
    """Return how many steps these programs have, by id, as far as they are published."""
    found: dict[str, int] = {}
    for path in sorted((job.folder / "programs").glob("part-*.parquet")):
        table = pq.read_table(path, columns=["program_id", "steps"], filters=[("program_id", "in", names)])
        found.update((row["program_id"], len(row["steps"])) for row in table.to_pylist())
    return found


def strength_used(job: Job) -> str:
    """Return the strength by which programs were augmented."""
    return str(_manifest(job, "augment").content["settings"]["strength"])


def _manifest(job: Job, stage: str) -> Manifest:
    manifest = read_manifest(job.settings.folder(stage))
    assert manifest is not None
    return manifest


def _rows(job: Job, stage: str, table: str = "", columns: list[str] | None = None) -> Iterator[Any]:
    """Yield the rows of one table of a stage."""
    folder = job.settings.folder(stage)
    for path in (folder / file for part in _manifest(job, stage).parts for file in part["files"]):
        if path.parent == folder / table:
            yield from read_rows(path, columns)


def _used_homes(job: Job) -> list[str]:
    names: set[str] = set()
    for path in (job.folder / "environments").glob("part-*.parquet"):
        names.update(pq.read_table(path, columns=["home"])["home"].unique().to_pylist())
    return sorted(names)


def _homes(job: Job, homes: Homes) -> Iterator[published_rows.HomeRow]:
    for name in _used_homes(job):
        home = homes.home(name)
        rooms = [node for node in map(home.node, range(len(home))) if home.rooms >> home.index[node.id] & 1]
        yield {
            "home": name,
            "origin": "catalog" if homes.in_catalog(name) else "derived",
            "rooms": sorted(node.class_name for node in rooms),
            "nodes": len(home),
            "edges": len(homes.edges(name)),
            "has_geometry": bool(rooms) and all(node.box for node in rooms),
        }


def _home_nodes(job: Job, homes: Homes) -> Iterator[published_rows.HomeNodeRow]:
    for name in _used_homes(job):
        for node in World.start(homes.home(name)).graph().nodes:
            yield {"home": name, **node_row(node)}


def _home_edges(job: Job, homes: Homes) -> Iterator[published_rows.HomeEdgeRow]:
    for name in _used_homes(job):
        for edge in sorted(homes.edges(name)):
            yield {"home": name, "source": edge.source, "relation": edge.relation, "target": edge.target}


def _filmed(job: Job, table: str) -> Iterator[tuple[str | None, Row]]:
    """Yield the rows of pictures and films of published executions, with the part of their programs or clips."""
    kind, part_of = "" if table == "frames" else table, job.context.assignment.part_of
    run_of = _runs_of(job, {row["execution_id"] for row in _rows(job, "render", kind, ["execution_id"])})
    for row in _rows(job, "render", kind):
        if row["execution_id"] in run_of:
            program_id, home = run_of[row["execution_id"]]
            yield row.get("part") or part_of(program_id), {**row, "home": home}


def _runs_of(job: Job, names: set[str]) -> dict[str, tuple[str, str]]:
    """Return the program and the home of executions, by id, as far as they are published."""
    found: dict[str, tuple[str, str]] = {}
    columns = ["execution_id", "program_id", "home"]
    for path in (job.folder / "executions").glob("part-*.parquet") if names else ():
        table = pq.read_table(path, columns=columns, filters=[("execution_id", "in", names)])
        found.update((row["execution_id"], (row["program_id"], row["home"])) for row in table.to_pylist())
    return found


def _splits(job: Job) -> Iterable[published_rows.SplitRow]:
    programs, seed = job.context.assignment.programs, job.settings.seed
    runs = Runs(programs, _runs(job))
    rows = splits.SplitRows(programs, runs, seed, _parts_of_sources(job))
    write_json(job.folder / "splits.json", summary(programs, runs, rows, seed))
    return rows


def _runs(job: Job) -> Iterator[Run]:
    for path in sorted((job.folder / "executions").glob("part-*.parquet")):
        table = pq.read_table(path, columns=["execution_id", "program_id", "home"], filters=[("executable", "=", True)])
        yield from zip(*(table[name].to_pylist() for name in table.column_names), strict=True)


def _parts_of_sources(job: Job) -> dict[str, dict[str, str | None]]:
    """Return the parts of originals in splits of their sources' own; many have the same, and share them."""
    found: dict[str, dict[str, str | None]] = {}
    different: dict[tuple[tuple[str, str | None], ...], dict[str, str | None]] = {}
    for row in _rows(job, "ingest", columns=["program_id", "parts"]):
        if row["parts"]:
            parts = tuple((each["split"], each["part"]) for each in row["parts"])
            found[row["program_id"]] = different.setdefault(parts, dict(parts))
    return found


def _copy_pictures(job: Job) -> None:
    """Copy the pictures next to the tables, and remove those of an earlier build."""
    for name in ("frames", "films"):
        _copy_folder(job.settings.folder("render") / name, job.folder / name)


def _copy_folder(source: Path, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    wanted = {path.relative_to(source) for path in source.rglob("*") if path.is_file()} if source.exists() else set()
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.suffix != ".parquet" and path.relative_to(folder) not in wanted:
            path.unlink()
    for name in sorted(wanted):
        target = folder / name
        if name.suffix != ".parquet" and not name.name.startswith("."):
            target.parent.mkdir(parents=True, exist_ok=True)
            with replacing(target) as temporary:
                shutil.copyfile(source / name, temporary)
    if wanted:
        sync_folder(folder)


def _vocabulary(knowledge: Knowledge) -> Iterator[published_rows.NameRow]:
    for action in sorted(knowledge.actions.values(), key=lambda action: action.id):
        yield _name("action", action.id, action.name, action.arity, action.executed)
    for thing in sorted(knowledge.objects.values(), key=lambda thing: thing.id):
        yield _name("class", thing.id, thing.name)
    graphs = {
        "state": states_of_set(knowledge.action_set),
        "property": PROPERTIES,
        "relation": RELATIONS,
        "edge_type": EDGE_TYPES,
    }
    for kind, names in graphs.items():
        yield from (_name(kind, number, name) for number, name in enumerate(names))
    for code in sorted(Code, key=lambda code: code.number):
        yield _name("failure", code.number, str(code))


def _name(
    kind: str, number: int, name: str, arity: int | None = None, simulated: bool | None = None
) -> published_rows.NameRow:
    return {"kind": kind, "id": number, "name": name, "arity": arity, "simulated": simulated}


def _rejects(job: Job) -> Iterator[stage_rows.RejectRow]:
    for stage in STAGES:
        folder = job.folder if stage == job.stage.name else job.settings.folder(stage)
        for row in read_rows(folder / "rejects.parquet"):
            del row["partition"]
            yield row


def _ledger(job: Job, counts: Counts) -> Iterator[published_rows.LedgerRow]:
    for order, stage in enumerate(STAGES):
        stage_counts = counts if stage == job.stage.name else _manifest(job, stage).counts
        codes = sorted(stage_counts.codes.items(), key=lambda item: (-item[1], item[0]))
        yield {
            "stage": stage,
            "record": record_of(stage, job.plan if stage == job.stage.name else _manifest(job, stage).content["plan"]),
            "order": order,
            "records_in": stage_counts.records_in,
            "records_through": stage_counts.through,
            "records_rejected": stage_counts.rejected,
            "partial_rejects": stage_counts.partial,
            "rows": stage_counts.rows.total(),
            "codes": [{"code": code, "count": count} for code, count in codes],
            "fuzzy": stage_counts.tally["fuzzy"],
        }
