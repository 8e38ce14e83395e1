"""The catalog: views and macros over a dataset's files, as a DuckDB file and as SQL."""

from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.files import replacing, write_bytes

CATALOG = "catalog.duckdb"
SQL = "catalog.sql"


def statements(root: str = "") -> str:
    """The SQL of the catalog; `root` is the prefix of every path."""
    text = (files("hearth.datasets.format") / "catalog.sql").read_text("utf-8")
    return text.format(root=root.replace("'", "''"))


def _reading(root: str, table: str) -> str:
    quoted = root.replace("'", "''")
    return f"read_parquet('{quoted}{table}/*.parquet')"


def write_catalog(folder: Path) -> None:
    """Write `catalog.duckdb` and its SQL, with relative paths that stay valid when the folder is moved."""
    write_bytes(folder / SQL, statements().encode())
    with replacing(folder / CATALOG) as temporary:
        temporary.unlink(missing_ok=True)
        make_catalog(temporary, folder, statements())


def make_catalog(path: Path, folder: Path, sql: str) -> None:
    """Make the catalog of a folder's tables as a DuckDB file, by `statements` of this version or of an earlier one."""
    import duckdb

    with TemporaryDirectory() as aside:
        # The search path is separated by commas, which a folder's name may contain; the link's name does not.
        link = Path(aside) / "dataset"
        link.symlink_to(folder.resolve())
        with duckdb.connect(str(path)) as connection:
            connection.execute(f"SET file_search_path = '{link}'")
            connection.execute(sql)


_CLOSED = (
    "autoinstall_known_extensions = false",
    "autoload_known_extensions = false",
    "python_enable_replacements = false",
    "enable_external_access = false",
    "lock_configuration = true",
)
"""Settings that keep queries from other files, the network and Python's variables; the last one locks them."""


def attach(folder: Path, absent: Sequence[str] = ()) -> Any:
    """A connection with the dataset's views, limited to this folder.

    DuckDB cannot forbid writing: queries of strangers go through `check_question` first.

    Args:
        folder: of the dataset.
        absent: tables without files; their views are empty.
    """
    import duckdb

    from hearth.schemas.tables import TABLES

    root = f"{folder.resolve()}/"
    connection = duckdb.connect()
    connection.execute("SET parquet_metadata_cache = true")
    text = statements(root)
    for table in absent:
        connection.register(f"no_{table}", TABLES[table].empty_table())
        text = text.replace(_reading(root, table), f"no_{table}")
    connection.execute(text)
    quoted = root.replace("'", "''")
    connection.execute(f"SET allowed_directories = ['{quoted}']")
    for setting in _CLOSED:
        connection.execute(f"SET {setting}")
    return connection


def absent_tables(folder: Path, content: dict[str, Any]) -> list[str]:
    """The tables that a dataset never had, because an earlier version wrote it.

    Raises:
        HearthError: MISSING_FILE, where the manifest has a table and the folder has not: said before a query says so in
            DuckDB's words.
    """
    from hearth.schemas.tables import TABLES

    missing = [table for table in TABLES if not any((folder / table).glob("*.parquet"))]
    published = {name.partition("/")[0] for name in content["files"]}
    lost = [f"`{table}`" for table in missing if table in published]
    if lost:
        message = f"it has no table {', '.join(lost)}; it was written by {content['version']}"
        remedy = "fetch the dataset again, or publish it again with this version"
        raise HearthError.of(Code.MISSING_FILE, message, file=str(folder), suggestion=remedy)
    return missing


def without_zones(relation: Any) -> Any:
    """A relation whose times in a zone are text: DuckDB gives them to Python by a library that is not needed else."""
    zoned = ["WITH TIME ZONE" in str(kind) for kind in relation.types]
    if not any(zoned):
        return relation
    names = ['"' + name.replace('"', '""') + '"' for name in relation.columns]
    cells = (f"CAST(#{n} AS VARCHAR)" if is_zoned else f"#{n}" for n, is_zoned in enumerate(zoned, 1))
    return relation.project(", ".join(f"{cell} AS {name}" for cell, name in zip(cells, names, strict=True)))
