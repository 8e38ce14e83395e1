"""Verification of a dataset: files, columns, counts, references, and a replay of every execution from disk."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import islice
from math import ceil
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from hearth.datasets.damage_faults import reading
from hearth.datasets.dataset import Dataset
from hearth.datasets.dataset_homes import own_homes
from hearth.datasets.dataset_knowledge import other_base
from hearth.datasets.format.action_set_tables import tables_of_dataset
from hearth.datasets.format.catalog import earlier
from hearth.datasets.format.image_tables import other_images
from hearth.datasets.format.stored_cases import stored_cases
from hearth.datasets.verify_folder import AGAIN, manifest_faults, other_files, unknown
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.short_repr import brief
from hearth.schemas.tables import KEYS, REFERENCES, TABLES
from hearth.simulation.world.home import Home
from hearth.storage.files import file_digest
from hearth.storage.manifest import NAME
from hearth.storage.names import leaves
from hearth.storage.parallel import Seen, spread, unseen

SHARE = 1_000
"""Executions per unit of replay work."""

SHOWN = 20
"""Faults of one kind that are listed; further ones are counted."""

COUNTED = (
    ("homes", "nodes", "SELECT home, count(*) AS found FROM home_nodes GROUP BY 1"),
    ("homes", "edges", "SELECT home, count(*) AS found FROM home_edges GROUP BY 1"),
    ("activities", "programs", "SELECT activity_id, count(*) AS found FROM programs GROUP BY 1"),
    ("activities", "descriptions", "SELECT activity_id, count(*) AS found FROM descriptions GROUP BY 1"),
)
"""Columns that count rows of other tables, and the query that counts them."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """The result of a verification.

    Attributes:
        files: number of hashed files.
        rows: number of rows in all tables.
        executions: number of replayed executions.
        faults: all faults; empty for a valid dataset.
        note: a remark on its knowledge, or "".
        unknown: files and fields that no build writes; they change no answer.
    """

    files: int
    rows: int
    executions: int
    faults: tuple[Diagnostic, ...]
    note: str = ""
    unknown: tuple[Diagnostic, ...] = ()

    __repr__ = brief


def verify(path: str | Path, workers: int = 1, seen: Seen = unseen) -> Verdict:
    """Check a dataset from its folder alone; the result is the same for any number of workers.

    Files are checked first: if a file is missing, differs from the manifest or has other columns, the other checks,
    which depend on it, are skipped.

    Args:
        path: of the dataset.
        workers: number of processes.
        seen: reports the progress of replays.

    Raises:
        HearthError: the path is not a dataset, or a newer version wrote it.

    Examples:
        >>> verdict = hearth.verify(folder)
        >>> verdict.executions > 4, verdict.faults
        (True, ())
    """
    opened.cache_clear()
    dataset = Dataset.open(path, remembers=False)
    files = len(dataset.manifest["files"])
    note = other_base(dataset.manifest)
    odd = tuple(unknown(dataset))
    faults = tuple(_files(dataset)) or (*_schemas(dataset), *_overlays(dataset))
    faults = faults or tuple(other_files(dataset.folder))
    if faults:
        return Verdict(files, 0, 0, faults, note, odd)
    rows = sum(_count(dataset, table) for table in TABLES if (dataset.folder / table).is_dir())
    wrong = [*_keys(dataset), *_references(dataset), *_counts(dataset), *_split(dataset), *_sketches(dataset)]
    wrong = wrong or [*_images(dataset), *manifest_faults(dataset)]
    if wrong:
        return Verdict(files, rows, 0, tuple(wrong), note, odd)
    return Verdict(files, rows, _count(dataset, "executions"), tuple(_replays(dataset, workers, seen)), note, odd)


def _files(dataset: Dataset) -> Iterator[Diagnostic]:
    files = dataset.manifest["files"]
    for name, entry in files.items():
        path = dataset.folder / name
        if leaves(name) or not _is_entry(entry):
            message = f"it does not say which file of the folder `{name[:80]!a}` is, and its bytes and SHA-256"
            yield Diagnostic(Code.BAD_JSON, message, str(dataset.folder / NAME), suggestion=AGAIN)
        elif not _is_file(path):
            yield Diagnostic(Code.MISSING_FILE, "the manifest has it, the folder has not", str(path), suggestion=AGAIN)
        elif path.stat().st_size != entry["bytes"]:
            message = f"{path.stat().st_size:,} bytes where the manifest says {entry['bytes']:,}"
            yield Diagnostic(Code.DAMAGED_FILE, message, str(path), suggestion=AGAIN)
        elif file_digest(path) != entry["sha256"]:
            yield Diagnostic(Code.DAMAGED_FILE, "other bytes than the manifest says", str(path), suggestion=AGAIN)
    for table in TABLES:
        for path in sorted((dataset.folder / table).glob("*.parquet")):
            if path.relative_to(dataset.folder).as_posix() not in files:
                message = "the folder has it, the manifest has not: queries would read it"
                yield Diagnostic(Code.UNSUPPORTED_FILE, message, str(path), suggestion="move it elsewhere")


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:  # a name that is longer than any
        return False


def _is_entry(entry: object) -> bool:
    if not isinstance(entry, dict):
        return False
    return isinstance(entry.get("bytes"), int) and isinstance(entry.get("sha256"), str)


def _overlays(dataset: Dataset) -> Iterator[Diagnostic]:
    try:
        _ = dataset.knowledge
        own_homes(dataset.folder, dataset.manifest)
    except HearthError as error:
        yield from error.diagnostics


def _schemas(dataset: Dataset) -> Iterator[Diagnostic]:
    for table, schema in tables_of_dataset(dataset.manifest).items():
        then = earlier(dataset.manifest["format"]).get(table, {})
        paths = sorted((dataset.folder / table).glob("*.parquet"))
        if not paths and not then.get("absent"):
            yield Diagnostic(Code.MISSING_FILE, f"no table `{table}`", str(dataset.folder / table), suggestion=AGAIN)
        expected = pa.schema([field for field in schema if field.name not in then.get("lacks", ())])
        for path in paths:
            try:
                every = pq.read_schema(path)
            except (pa.ArrowException, OSError, ValueError) as error:
                yield Diagnostic(Code.DAMAGED_FILE, f"not Parquet: {error}", str(path), suggestion=AGAIN)
                continue
            if twice := sorted({name for name in every.names if every.names.count(name) > 1}):
                yield Diagnostic(Code.BAD_TABLE, f"columns twice: {', '.join(twice)}", str(path), suggestion=AGAIN)
                continue
            found = pa.schema([field for field in every if field.name not in then.get("has", ())])
            if not found.equals(expected) or not {*then.get("has", ())} <= {*every.names}:
                odd = sorted({*every.names} ^ {*expected.names, *then.get("has", ())}) or [
                    name for name in expected.names if found.field(name).type != expected.field(name).type
                ]
                message = f"other columns than the table's: {', '.join(odd) or 'in another order'}"
                yield Diagnostic(Code.BAD_TABLE, message, str(path), suggestion=AGAIN)


def _split(dataset: Dataset) -> Iterator[Diagnostic]:
    """Check that `splits` assigns each program to the part that `programs.split` names, and no execution that fails."""
    differs = "s.part IS DISTINCT FROM p.split"
    if dataset.manifest["format"] == 1:  # by execution, and some of none
        differs = "NOT starts_with(s.part, p.split)"
    query = f"""SELECT DISTINCT program_id FROM splits s JOIN programs p USING (program_id)
        WHERE s.split = 'activities' AND {differs} ORDER BY 1"""
    yield from _listed(dataset, Code.BAD_TABLE, "splits", query, "{value} has another split than in `programs`")
    if dataset.manifest["format"] > 1:
        query = """SELECT DISTINCT execution_id FROM splits JOIN executions USING (execution_id)
            WHERE NOT executable ORDER BY 1"""
        yield from _listed(dataset, Code.BAD_TABLE, "splits", query, "{value} fails, and is in a split")


def _sketches(dataset: Dataset) -> Iterator[Diagnostic]:
    """Check that a sketch says of each step of its program whether it keeps it."""
    query = """SELECT DISTINCT program_id FROM sketches s JOIN programs p USING (program_id)
        WHERE len(s.keep) IS DISTINCT FROM len(p.steps) ORDER BY 1"""
    yield from _listed(
        dataset, Code.BAD_TABLE, "sketches", query, "that of {value} has not a flag for each of its steps"
    )


def _images(dataset: Dataset) -> Iterator[Diagnostic]:
    """Check that pictures as values are those of the files."""
    for path, message in other_images(dataset.folder, dataset.manifest["files"]):
        yield Diagnostic(Code.BAD_TABLE, message, str(path), suggestion=AGAIN)


def _count(dataset: Dataset, table: str) -> int:
    return int(dataset.rows(f"SELECT count(*) FROM {table}")[1][0][0])


def _listed(dataset: Dataset, code: Code, table: str, query: str, message: str) -> Iterator[Diagnostic]:
    """Yield a fault of the table for each value that a query finds."""
    values = [value for (value,) in dataset.rows(query)[1]]
    for value in values[:SHOWN]:
        yield Diagnostic(code, message.format(value=value), str(dataset.folder / table), found=str(value))
    if len(values) > SHOWN:
        yield Diagnostic(code, f"and {len(values) - SHOWN:,} more like it", str(dataset.folder / table))


def _keys(dataset: Dataset) -> Iterator[Diagnostic]:
    for table, (key, *more) in KEYS.items():
        if not more:
            query = f'SELECT "{key}" FROM {table} GROUP BY 1 HAVING count(*) > 1 ORDER BY 1'
            yield from _listed(dataset, Code.DUPLICATE, table, query, f"two rows have the {key} {{value}}")


def _references(dataset: Dataset) -> Iterator[Diagnostic]:
    for table, column, other, key in REFERENCES:
        query = f"""SELECT DISTINCT t.{column} FROM {table} t WHERE t.{column} IS NOT NULL
            AND NOT EXISTS (SELECT 1 FROM {other} o WHERE o.{key} = t.{column}) ORDER BY 1"""
        yield from _listed(dataset, Code.UNKNOWN_ID, table, query, f"its {column} {{value}} is not in `{other}`")


def _counts(dataset: Dataset) -> Iterator[Diagnostic]:
    counts = dataset.manifest.get("counts")
    rows = counts.get("rows") if isinstance(counts, dict) else None  # whatever else is wrong there is reported later
    for table, number in rows.items() if isinstance(rows, dict) else ():
        if table not in TABLES or not isinstance(number, int):
            message = f"it counts {str(number)[:20]} rows of a table `{table[:80]!a}`"
            yield Diagnostic(Code.BAD_JSON, message, str(dataset.folder / NAME), suggestion=AGAIN)
        elif number != _count(dataset, table):
            message = f"{_count(dataset, table):,} rows where the manifest counts {number:,}"
            yield Diagnostic(Code.BAD_TABLE, message, str(dataset.folder / table))
    for table, column, query in COUNTED:
        (key,) = KEYS[table]
        ask = f"""SELECT t.{key} FROM {table} t LEFT JOIN ({query}) q USING ({key})
            WHERE t.{column} IS DISTINCT FROM coalesce(q.found, 0) ORDER BY 1"""
        yield from _listed(dataset, Code.BAD_TABLE, table, ask, f"wrong number of {column} for {{value}}")
    query = "SELECT stage FROM ledger WHERE records_in <> records_through + records_rejected ORDER BY 1"
    yield from _listed(dataset, Code.BAD_TABLE, "ledger", query, "the records of stage {value} do not add up")


class StoredHomes:
    """The homes of a dataset by name, built from its tables."""

    def __init__(self, dataset: Dataset) -> None:
        self._dataset = dataset
        self.home = cache(self._home)

    def _home(self, name: str) -> Home:
        """Return the home of that name.

        Raises:
            KeyError: the name is unknown.
        """
        return Home.from_graph(self._dataset.home(name), name, self._dataset.knowledge)


def _replays(dataset: Dataset, workers: int, seen: Seen) -> Iterator[Diagnostic]:
    place, wrong = str(dataset.folder / "executions"), 0
    for found in _replayed(dataset, workers, seen):
        for execution_id, difference in found:
            wrong += 1
            if wrong <= SHOWN:
                yield Diagnostic(Code.REPLAY_DIFFERS, f"{execution_id}: {difference}", place)
    if wrong > SHOWN:
        yield Diagnostic(Code.REPLAY_DIFFERS, f"and {wrong - SHOWN:,} more like it", place)


Wrong = list[tuple[str, str]]
"""Executions whose replay differs from their rows, with the difference."""


def _replayed(dataset: Dataset, workers: int, seen: Seen) -> Iterator[Wrong]:
    return spread(_replay, Shares(dataset), workers, seen)


class Shares(Collection[tuple[str, list[str]]]):
    """The ids of all executions, `SHARE` at a time, with the dataset's folder.

    They come in file order, which is the same for environments and programs: a share lies in few row groups of each.
    """

    def __init__(self, dataset: Dataset) -> None:
        self._folder = dataset.folder
        self._count = ceil(_count(dataset, "executions") / SHARE)

    def __len__(self) -> int:
        return self._count

    def __iter__(self) -> Iterator[tuple[str, list[str]]]:
        names = self._names()
        while share := list(islice(names, SHARE)):
            yield str(self._folder), share

    def __contains__(self, share: object) -> bool:
        return any(share == each for each in self)

    def _names(self) -> Iterator[str]:
        for path in sorted((self._folder / "executions").glob("*.parquet")):
            with reading(self._folder), pq.ParquetFile(path) as file:
                yield from file.read(["execution_id"])["execution_id"].to_pylist()


def _replay(job: tuple[str, list[str]]) -> Wrong:
    from hearth.datasets.format.case_rows import HARM, difference_on_replay

    folder, names = job
    dataset, homes = opened(folder)
    wrong: Wrong = []
    missing = dict.fromkeys(names)
    columns = tables_of_dataset(dataset.manifest)["executions"].names
    harm = [name for name in HARM if name in columns]
    for case in stored_cases(dataset, names, ("ticks", "failure", *harm)):
        missing.pop(case["execution_id"], None)
        try:
            difference = difference_on_replay(case, homes)
        except Exception as error:  # of values that no build writes
            difference = f"it cannot be run: {type(error).__name__} {error}"
        if difference:
            wrong.append((case["execution_id"], difference))
    # A file's statistics decide which of its rows are read.
    return wrong + [(name, "it is not read: the statistics of its file say that it has no such id") for name in missing]


@lru_cache(maxsize=1)
def opened(folder: str) -> tuple[Dataset, StoredHomes]:
    """Return a dataset and its homes, cached per process."""
    dataset = Dataset.open(folder, remembers=False)
    return dataset, StoredHomes(dataset)
