"""Checks of a dataset's folder besides its tables: unlisted files, the catalog, the manifest itself."""

import re
from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pyarrow.parquet as pq

from hearth.datasets import dataset_homes, dataset_knowledge
from hearth.datasets.dataset import Dataset
from hearth.datasets.format.catalog import CATALOG, SQL, make_catalog, published
from hearth.datasets.format.datasheet import STRENGTH
from hearth.kb.action_sets import LATEST
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.storage.duckdb_connections import limited, open_database
from hearth.storage.files import read_json, value_digest
from hearth.storage.input_files import read_input
from hearth.storage.manifest import NAME, TIMING
from hearth.storage.partitions import Counts

AGAIN = "fetch or publish the dataset again"

_PART = re.compile(r"(?:programs|executions)/[^/]+\.parquet")
"""Files that a part of the manifest names, in every dataset."""

_ASKED = ("stage", "code", "settings", "plan")
"""Fields of the manifest that its key is the digest of, with the inputs."""

EARLIER = {
    "181edd5cc9f6d9041001864f3d8da78cf4614790e5cfff2fb5a83af64476b645": "0.1.0",
    "53934e3b35899a28d8c5d0373a45c1863d1c252897e118800f4b15348f7c1d21": "0.2.0, format 1",
    "fde4c51c18a7817b793d00c2e1807c1d2f1d9037cc26136b0553878a33ec84ab": "0.2.0, before the rule made_bed",
    "298e0d888a53ccc95c0a554a961fa0bc5dc6656381d3c3b5be708e4955e014ff": "0.2.0, before the view originals",
}
"""SHA-256 of the catalog's SQL in earlier versions; add that of the last one when the SQL of the next differs."""

_FIELDS = {"format", "version", "action_set", *_ASKED, "key", "inputs", "counts", "parts", "files",
           dataset_homes.FIELD, dataset_knowledge.FIELD, STRENGTH}  # fmt: skip


def unknown(dataset: Dataset) -> Iterator[Diagnostic]:
    """Files and fields that no build of ours writes; tables are looked at elsewhere, since queries would read them."""
    listed = {*dataset.manifest["files"], NAME, TIMING, CATALOG}
    for path in sorted(dataset.folder.rglob("*")):
        name = path.relative_to(dataset.folder).as_posix()
        if (path.is_symlink() or not path.is_dir()) and name not in listed:
            message = "the folder has it, the manifest has not"
            yield Diagnostic(Code.UNSUPPORTED_FILE, message, str(path), suggestion="move it elsewhere")
    for field in sorted(dataset.manifest.keys() - _FIELDS):
        message = f"a field that no manifest has: `{field}`"
        yield Diagnostic(Code.BAD_JSON, message, str(dataset.folder / NAME), found=str(field))


def manifest_faults(dataset: Dataset) -> Iterator[Diagnostic]:
    """Fields of the manifest that contradict each other or the tables."""
    place = str(dataset.folder / NAME)
    try:
        found = list(_contradictions(dataset))
    except (HearthError, KeyError, TypeError, ValueError, AttributeError, IndexError, AssertionError, OSError) as error:
        found = [f"a field is missing or of another kind: {type(error).__name__} {error}"]
    yield from (Diagnostic(Code.BAD_JSON, message, place, suggestion=AGAIN) for message in found)


def _contradictions(dataset: Dataset) -> Iterator[str]:
    content = dataset.manifest
    asked = {name: content[name] for name in _ASKED}
    if content["key"] != value_digest([value_digest(asked), content["inputs"]]):
        yield f"its key is not that of {', '.join(_ASKED)} and inputs"
    for field, column in (("version", "dataset_version"), ("action_set", "action_set")):
        for (value,) in dataset.rows(f"SELECT DISTINCT {column} FROM executions ORDER BY 1")[1]:
            if value != content[field]:
                yield f"its {field} is {content[field]}, that of its executions {value}"
    counts = Counts.from_json(content["counts"])
    counts.check("its counts")
    ledger = dataset.read("SELECT * FROM ledger WHERE stage = 'publish'")
    expected = (counts.records_in, counts.through, counts.rejected, counts.partial, dict(counts.codes))
    for row in ledger:
        codes = {one["code"]: one["count"] for one in row["codes"]}
        found = [row[f"records_{name}"] for name in ("in", "through", "rejected")]
        differs = content["format"] > 1 and row["rows"] != counts.rows.total()
        if differs or expected != (*found, row["partial_rejects"], codes):
            yield "its counts differ from those of the ledger"
    yield from _other_parts(dataset.folder, content)


def _other_parts(folder: Path, content: dict[str, Any]) -> Iterator[str]:
    named = [name for part in content["parts"] for name in part["files"]]
    tables = {name for name in content["files"] if _PART.fullmatch(name)}
    if left := sorted(tables - {*named}):
        yield f"none of its parts names `{left[0]}`"
    if len({*named}) < len(named):
        yield "two of its parts name one file"
    for part in content["parts"]:
        if not {*part["files"]} <= content["files"].keys():
            yield "its parts name files that are not listed"
        elif part["rows"] != sum(pq.read_metadata(folder / name).num_rows for name in part["files"]):
            yield f"its parts count {part['rows']} rows where `{part['files'][0]}` and the others have another number"


def other_files(folder: Path) -> Iterator[Diagnostic]:
    """Yield the faults of the catalog, which is made again and compared, and of the timing."""
    path, timing = folder / CATALOG, folder / TIMING
    if not path.is_file():
        yield Diagnostic(Code.MISSING_FILE, "a dataset has it, the folder has not", str(path), suggestion=AGAIN)
    elif (sql := _known_sql(folder)) is None:
        message = "not the SQL of any version, so that the catalog cannot be made again and compared"
        yield Diagnostic(Code.DAMAGED_FILE, message, str(folder / SQL), suggestion=f"do not run it; {AGAIN}")
    elif _holds(path) != _expected(folder, sql):
        message = "other views or macros than those of its SQL"
        yield Diagnostic(Code.DAMAGED_FILE, message, str(path), suggestion=f"do not open it; {AGAIN}")
    said = read_json(timing)
    if timing.exists() and (not isinstance(said, dict) or said.keys() != {"seconds", "workers"}):
        yield Diagnostic(Code.BAD_JSON, "not the seconds and workers of a build", str(timing), suggestion=AGAIN)


def _known_sql(folder: Path) -> str | None:
    """Return the SQL that the catalog was made by, if it is ours: that of strangers is never run."""
    try:
        text = read_input(folder / SQL).decode()
    except (HearthError, UnicodeDecodeError):
        return None
    return text if text in (published(), published(LATEST)) or sha256(text.encode()).hexdigest() in EARLIER else None


def _expected(folder: Path, sql: str) -> list[Any]:
    with TemporaryDirectory() as aside:
        path = Path(aside) / "again.duckdb"  # under the name of a catalog it would look for tables in its own folder
        make_catalog(path, folder, sql)
        return _holds(path)


_HOLDS = (
    "SELECT view_name, sql, comment FROM duckdb_views() WHERE NOT internal ORDER BY ALL",
    "SELECT table_name, column_name, comment FROM duckdb_columns() WHERE NOT internal ORDER BY ALL",
    "SELECT table_name, sql FROM duckdb_tables() WHERE NOT internal ORDER BY ALL",
    "SELECT function_name, parameters, macro_definition, comment FROM duckdb_functions() WHERE NOT internal ORDER BY 1",
    "SELECT sequence_name FROM duckdb_sequences() ORDER BY ALL",
    "SELECT type_name FROM duckdb_types() WHERE NOT internal ORDER BY ALL",
    "SELECT schema_name, sql FROM duckdb_schemas() WHERE NOT internal ORDER BY ALL",
)


def _holds(path: Path) -> list[Any]:
    """All that a catalog defines; its error, where DuckDB cannot open it. Nothing in it is run."""
    import duckdb

    try:
        with open_database(path, {"access_mode": "READ_ONLY"}) as connection:
            limited(connection)
            return [connection.execute(query).fetchall() for query in _HOLDS]
    except duckdb.Error as error:
        return [str(error)]
