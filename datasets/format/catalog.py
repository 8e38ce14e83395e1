"""The catalog: views and macros over a dataset's files, as a DuckDB file and as SQL."""

import errno
import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import cache
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hearth.datasets.format.action_set_tables import tables_of
from hearth.kb.action_sets import LATEST, USUAL
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.tables import TABLES, comment_of, nested
from hearth.schemas.yaml_limits import packaged
from hearth.storage.duckdb_connections import identifier, limited, open_database, pattern_of, quoted, without_patterns
from hearth.storage.files import replacing, write_bytes
from hearth.storage.manifest import FORMAT

CATALOG = "catalog.duckdb"
SQL = "catalog.sql"

VIEWS = ("steps", "ticks", "execution_kinds", "originals", "start_relations")
"""Views that are not of one table's files."""


_BESIDE = (
    r"regexp_replace(regexp_extract(current_setting('temp_directory'), '^(.*[/\\])catalog\.duckdb\.tmp$', 1), "
    r"'([*?\[])', '[\1]', 'g')"
)
"""The folder of the opened database.

DuckDB sets its folder for temporary files next to the database, and gives no other path.
"""


def statements(root: str = "") -> str:
    """Return the SQL of the catalog; `root` is the prefix of every path, by default found when it is opened."""
    text = (files("hearth.datasets.format") / "catalog.sql").read_text("utf-8")
    return text.format(folder=quoted(root) if root else _BESIDE)


def comments(action_set: int = LATEST) -> Iterator[str]:
    """Statements that comment views and macros; a column's comment has those of its nested fields, one a line."""
    yield from (files("hearth.datasets.format") / "comments.sql").read_text("utf-8").splitlines(keepends=True)
    for table, schema in tables_of(action_set).items():
        yield f"COMMENT ON VIEW {table} IS {quoted(comment_of(schema))};\n"
        for column in schema:
            _, *within = nested(column)
            lines = (comment_of(column), *(f"{path}: {comment_of(field)}" for path, field in within))
            yield f"COMMENT ON COLUMN {table}.{column.name} IS {quoted(chr(10).join(lines))};\n"


def published(action_set: int = USUAL) -> str:
    """Return the SQL of the catalog of a dataset of an action set."""
    return "\n".join((statements(), "".join(comments(action_set))))


def describe(connection: Any) -> None:
    """Comment the tables and columns of a connection of `attach`.

    A step of its own, for it takes as long as all the views.
    """
    import duckdb

    for statement in comments():
        with suppress(duckdb.Error):  # a dataset of an earlier version does not have every column
            connection.execute(statement)


def _reading(table: str, root: str = "") -> str:
    folder = quoted(root) if root else "dataset_folder()"
    return f"read_parquet({folder} || '{table}/*.parquet')"


@cache
def earlier(format: int) -> dict[str, Any]:
    """Return how tables of a format differ from today's, by table: see `earlier.yaml`."""
    if format >= FORMAT:
        return {}
    return dict(packaged("hearth.datasets.format", "earlier.yaml")[format])


def reading(table: str, format: int = FORMAT, root: str = "") -> str:
    """Return the expression for a table: its files, or, in a dataset of an earlier format, a query over them.

    Args:
        table: its name.
        format: of the dataset.
        root: the prefix of every path, by default that of the catalog.
    """
    query = earlier(format).get(table, {}).get("query")
    return f"({query.format(**{name: _reading(name, root) for name in TABLES})})" if query else _reading(table, root)


def write_catalog(folder: Path, action_set: int = USUAL) -> None:
    """Write `catalog.duckdb` and its SQL, with relative paths that stay valid when the folder is moved."""
    write_bytes(folder / SQL, published(action_set).encode())
    with replacing(folder / CATALOG) as temporary:
        temporary.unlink(missing_ok=True)
        make_catalog(temporary, folder, published(action_set))


def make_catalog(path: Path, folder: Path, sql: str) -> None:
    """Make the catalog of a folder's tables as a DuckDB file, by `statements` of this version or of an earlier one.

    Raises:
        OSError: it cannot be written.
    """
    import duckdb

    with TemporaryDirectory() as aside:
        # The search path is separated by commas, which a folder's name may contain; the link's name does not.
        link = Path(aside) / "dataset"
        link.symlink_to(folder.resolve())
        try:
            with open_database(path) as connection:
                connection.execute(f"SET file_search_path = '{link}'")
                connection.execute(sql)
                connection.execute("CHECKPOINT")  # closing does the same, but says nothing of a full disk
        except (duckdb.IOException, duckdb.FatalException) as error:
            raise OSError(errno.EIO, str(error).split("\n", 1)[0], str(path)) from error


def attach(folder: Path, absent: Sequence[str] = (), format: int = FORMAT, remembers: bool = True) -> Any:
    """Return a connection with the dataset's views, limited to this folder.

    DuckDB cannot forbid writing: queries of strangers go through `check_question` first.

    Args:
        folder: of the dataset.
        absent: tables without files; their views are empty, unless the format has a query for them.
        format: of the dataset.
        remembers: whether footers of files stay in memory.
    """
    connection = open_database()
    connection.execute(f"SET parquet_metadata_cache = {remembers}")
    connection.execute("SET enable_external_file_cache = false")  # the system keeps files in memory, once for all
    define(connection, Path(without_patterns(folder)), absent, format)
    return limited(connection, f"{folder.resolve()}/")


def define(connection: Any, folder: Path, absent: Sequence[str] = (), format: int = FORMAT, database: str = "") -> None:
    """Define the dataset's views and macros in the database that a connection uses; `attach` has the arguments.

    Args:
        connection: which may be a stranger's.
        folder: of the dataset.
        absent: tables without files.
        format: of the dataset.
        database: its name, where macros are called from others: names in a macro are looked up at the caller.
    """
    text = statements(f"{pattern_of(folder)}/")
    for table in TABLES:
        here = reading(table, format)
        if table in absent and here == _reading(table):
            connection.from_arrow(TABLES[table].empty_table()).create(f"no_{table}")  # a table: cursors see it, too
            here = f"no_{table}"
        text = text.replace(_reading(table), here)
    connection.execute(_qualified(text, database) if database else text)


def _qualified(text: str, database: str) -> str:
    """Return the SQL of the catalog with its tables, views and macros as those of a database."""
    place = f"{identifier(database)}.main."
    macros = "|".join(re.findall(r"^CREATE MACRO (\w+)\(", text, re.MULTILINE))
    text = re.sub(rf"(?<!CREATE MACRO )\b({macros})\(", lambda found: place + found[0], text)
    tables = "|".join((*TABLES, *VIEWS))
    return re.sub(rf"\b(FROM|JOIN) ({tables})\b", lambda found: f"{found[1]} {place}{found[2]}", text)


def define_as(connection: Any, name: str, folder: Path, absent: Sequence[str] = (), format: int = FORMAT) -> None:
    """Define them in a new database of a stranger's connection, kept in memory; the connection goes on as it was.

    Raises:
        HearthError: BAD_ARGUMENT, where it has a database of that name.
    """
    import duckdb

    known = {each for (each,) in connection.execute("SELECT database_name FROM duckdb_databases()").fetchall()}
    if name.lower() in {each.lower() for each in known} or not name:
        remedy = "choose another name, or DETACH it first"
        message = f"the connection has a database `{name}` already" if name else "a database needs a name"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=remedy)
    used = connection.execute("SELECT current_database(), current_schema()").fetchone()
    connection.execute(f"ATTACH ':memory:' AS {identifier(name)}")
    try:
        connection.execute(f"USE {identifier(name)}")
        define(connection, folder.resolve(), absent, format, name)
    except duckdb.Error:
        connection.execute(f"USE {'.'.join(map(identifier, used))}")
        connection.execute(f"DETACH {identifier(name)}")
        raise
    connection.execute(f"USE {'.'.join(map(identifier, used))}")


def absent_tables(folder: Path, content: dict[str, Any]) -> list[str]:
    """Return the tables that a dataset never had, because an earlier version wrote it.

    Raises:
        HearthError: MISSING_FILE, where the manifest has a table and the folder has not: said before a query says so in
            DuckDB's words; DAMAGED_FILE, where a table is a pipe or a device, which a query would wait for.
    """
    parts = {table: [*(folder / table).glob("*.parquet")] for table in TABLES}
    if pipe := next((path for paths in parts.values() for path in paths if not path.is_file()), None):
        raise HearthError.of(Code.DAMAGED_FILE, "is not a regular file", file=str(pipe), suggestion="move it elsewhere")
    missing = [table for table, paths in parts.items() if not paths]
    published = {name.partition("/")[0] for name in content["files"]}
    lost = [f"`{table}`" for table in missing if table in published]
    if lost:
        message = f"it has no table {', '.join(lost)}; it was written by {content.get('version')}"
        remedy = "fetch the dataset again, or publish it again with this version"
        raise HearthError.of(Code.MISSING_FILE, message, file=str(folder), suggestion=remedy)
    return missing


def without_zones(relation: Any) -> Any:
    """Return a relation whose times in a zone are text, as 0.2 named it: see `exact_types.exactly`."""
    from hearth.datasets.format.exact_types import exactly

    return exactly(relation)
