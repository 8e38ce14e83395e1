"""A published dataset, opened for reading: tables, SQL, and programs with their runs, repairs and sketches."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache, cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.datasets.consistent_reads import steady, version
from hearth.datasets.damage_faults import reading, refused_question, too_slow, using
from hearth.datasets.file_id_ranges import reading_between
from hearth.datasets.format.catalog import VIEWS, absent_tables, attach, define_as, describe
from hearth.datasets.format.exact_types import PYTHON, TEXT, exactly
from hearth.datasets.format.ids import names_of
from hearth.datasets.published_manifest import published_manifest
from hearth.datasets.published_program import Entry, Run
from hearth.datasets.read_only_sql import check_question
from hearth.datasets.stored_homes import StoredHome
from hearth.schemas.call_errors import explained
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.published_rows import StoredRunRow
from hearth.schemas.short_repr import cut
from hearth.schemas.tables import TABLES
from hearth.storage.manifest import NAME
from hearth.storage.query_time_limit import TimeLimit

if TYPE_CHECKING:
    from hearth.datasets.tensors import Tensors
    from hearth.kb.knowledge import Knowledge


OWN = "NOT is_perturbed(e.environment_id, e.program_id)"
"""The condition in SQL on rows `e` of `executions` for those that are not of originals in perturbed environments."""


class Dataset:
    """A dataset folder.

    Each table is an attribute: `ds.programs` is a DuckDB relation, with `.df()` for pandas and `.to_arrow_table()`.
    `ds["release:..."]` is one program with its runs.

    Attributes:
        within: seconds in which a question to `rows` or `batches` must be answered; None for no limit.

    Examples:
        >>> dataset = hearth.load(folder)
        >>> entry = dataset["text:milk.txt"]
        >>> entry.program.steps[0].action, len(entry.program.steps)
        ('Walk', 3)
        >>> [run.executable for run in entry.runs]
        [True]
    """

    def __init__(
        self, folder: Path, manifest: dict[str, Any], failures: bool = False, remembers: bool = True
    ) -> None:  # fmt: skip
        self.folder = folder
        self.manifest = manifest
        self.failures = failures
        self.remembers = remembers
        self.within: float | None = None
        self._version = version(folder)

    @classmethod
    @explained
    def open(cls, path: str | Path, failures: bool = False, remembers: bool = True) -> Dataset:
        """Open a dataset, or the dataset of a build's folder; of a URL that fsspec knows, a local copy of it.

        Args:
            path: of the folder.
            failures: whether runs, exports and scores have the executions in which the program fails, too. Queries
                always have them.
            remembers: whether facts about files stay in memory, 0.1 MB a file: the next queries are faster.

        Raises:
            HearthError: the path is not a dataset, or a newer version wrote it, or it is incomplete.
        """
        from hearth.storage.folder_exchange import present
        from hearth.storage.url_fetching import fetched

        folder = fetched(path)
        if not (folder / NAME).exists() and (present(folder / "publish") / NAME).exists():
            folder = present(folder / "publish")
        opened, content = version(folder), published_manifest(folder, str(path))
        dataset = cls(folder, content, failures, remembers)
        dataset._version = opened
        return dataset

    def __repr__(self) -> str:
        return f"Dataset({str(self.folder)!r})"

    @cached_property
    def knowledge(self) -> Knowledge:
        """The knowledge that it was made with: ours, extended by the dataset's overlay.

        Raises:
            HearthError: the overlay is missing, differs from the manifest, or has faults.
        """
        from hearth.datasets.dataset_knowledge import knowledge_of

        return knowledge_of(self.folder, self.manifest)

    @property
    def connection(self) -> Any:
        """Return a DuckDB connection with the views and macros.

        The connection reaches this folder only; `sql` refuses statements that change it.

        After a build has replaced the dataset, a new connection to the current one is made.

        Raises:
            HearthError: MISSING_FILE, if a table is missing; DAMAGED_FILE, if one cannot be read; errors of
                `published_manifest`, if the replacement is not a dataset.
        """
        now = version(self.folder)
        if now is not None and now != self._version:
            self._reopen(now)
        return self._attached

    @cached_property
    def _attached(self) -> Any:
        with reading(self.folder):
            absent = absent_tables(self.folder, self.manifest)
            return attach(self.folder, absent, self.manifest["format"], self.remembers)

    @cached_property
    def _described(self) -> None:
        describe(self.connection)

    def _reopen(self, now: tuple[int, int]) -> None:
        """Read the dataset that replaced the opened one."""
        self.manifest, self._version = published_manifest(self.folder, str(self.folder)), now
        for name in ("_attached", "_described", "stored_home", "knowledge", "vocabulary_ids"):
            self.__dict__.pop(name, None)

    def attach_to(self, connection: Any, name: str) -> None:
        """Give another connection the views and macros, as those of a database `name`: see `hearth.attach`."""
        with reading(self.folder):
            absent = absent_tables(self.folder, self.manifest)
            define_as(connection, name, self.folder, absent, self.manifest["format"])

    @explained
    def sql(self, query: str, **parameters: Any) -> Any:
        """Return a query as a DuckDB relation; `$name` in it is the parameter of that name.

        Raises:
            HearthError: SYNTAX, with DuckDB's own words, or when the query would change something; BAD_ARGUMENT, where
                it names a column, table or function that there is not.

        Examples:
            >>> query = "SELECT action FROM steps WHERE program_id = $id ORDER BY number"
            >>> hearth.load(folder).sql(query, id="text:milk.txt").fetchall()
            [('Walk',), ('Open',), ('Grab',)]
        """
        import duckdb

        try:
            check_question(self.connection, query, parameters)
            if "duckdb_" in query.lower():
                _ = self._described
            return self.connection.sql(query, params=parameters or None)
        except duckdb.Error as error:
            raise refused_question(error, self.folder, self._names()) from error

    @explained
    def rows(self, query: str, limit: int | None = None, **parameters: Any) -> tuple[list[str], list[tuple[Any, ...]]]:
        """Column names and at most `limit` rows of a query; errors as of `sql`, those of running it too.

        Infinite dates are Python's first or last day.

        Raises:
            HearthError: as of `sql`; TIMED_OUT, after `within` seconds; FILE_TOO_LARGE, where memory is short.
        """
        return self._fetched(query, limit, parameters, PYTHON)

    @explained
    def rows_as_text(self, query: str, limit: int | None = None) -> tuple[list[str], list[tuple[Any, ...]]]:
        """Return what `rows` does, with dates and times as DuckDB writes them, infinite ones among them."""
        return self._fetched(query, limit, {}, TEXT)

    def _fetched(
        self, query: str, limit: int | None, parameters: Mapping[str, Any], kept: frozenset[str]
    ) -> tuple[list[str], list[tuple[Any, ...]]]:
        def ask() -> tuple[list[str], list[tuple[Any, ...]]]:
            with self._asking():
                relation = self.sql(query, **parameters)
                found = relation if limit is None or self._explains(query) else relation.limit(limit)
                return list(relation.columns), exactly(found, kept).fetchall()

        return steady(self.folder, ask)

    @explained
    def batches(self, query: str, size: int, **parameters: Any) -> tuple[list[str], Iterator[Any]]:
        """Column names of a query and its rows as Arrow's batches of `size` rows; errors as of `rows`.

        One batch is in memory at a time. The time limit runs until the last one is taken.
        """
        with self._asking():
            relation = exactly(self.sql(query, **parameters))

        def found() -> Iterator[Any]:
            with self._asking():
                yield from relation.to_arrow_reader(size)

        return list(relation.columns), found()

    @contextmanager
    def _asking(self) -> Iterator[None]:
        """End what takes longer than `within`, and raise DuckDB's errors as ours."""
        with TimeLimit(self.connection, self.within) as limit:
            try:
                yield
            except Exception as error:  # Arrow has errors of its own for DuckDB's while rows are read
                if limit.over:
                    raise too_slow(limit.seconds) from error
                if isinstance(error, HearthError):
                    raise
                if type(error).__name__ == "InterruptException" or str(error).strip() == "Query interrupted":
                    raise KeyboardInterrupt from error
                raise refused_question(error, self.folder, self._names()) from error

    def _names(self) -> dict[str, list[str]]:
        """Every name of a column, a table or view, and a function, for questions that name none."""
        query = "SELECT 'column', column_name FROM duckdb_columns() UNION SELECT 'table', view_name FROM duckdb_views()"
        query += " UNION SELECT 'table', table_name FROM duckdb_tables()"
        query += " UNION SELECT 'function', function_name FROM duckdb_functions() WHERE NOT internal"
        found: dict[str, list[str]] = {}
        for kind, name in self.connection.execute(f"{query} ORDER BY ALL").fetchall():
            found.setdefault(kind, []).append(name)
        return found

    def _explains(self, query: str) -> bool:
        return bool(self.connection.extract_statements(query)[0].type.name == "EXPLAIN")

    def __getattr__(self, name: str) -> Any:
        if name not in (*TABLES, *VIEWS):
            raise AttributeError(f"no table `{name}`; tables are {', '.join(TABLES)}, and views {', '.join(VIEWS)}")
        return steady(self.folder, lambda: self.connection.table(name))

    def __dir__(self) -> list[str]:
        """Attributes with the tables and views, so that notebooks complete them."""
        return sorted({*super().__dir__(), *TABLES, *VIEWS})

    def __len__(self) -> int:
        return int(self.read("SELECT count(*) AS number FROM programs")[0]["number"])

    def __iter__(self) -> Iterator[str]:
        """Yield the ids of all programs, sorted."""
        query = "SELECT program_id::VARCHAR AS program_id FROM programs ORDER BY 1"  # a stranger's may be bytes
        yield from (row["program_id"] for row in self.read(query))

    def __contains__(self, program_id: str) -> bool:
        return any(self._rows("SELECT 1 FROM programs WHERE program_id = $id", name) for name in names_of(program_id))

    def __getitem__(self, program_id: str) -> Entry:
        """Return a program with its runs, repairs and sketches.

        Ids of the embedded corpus may be those of another version.

        Raises:
            KeyError: the id is unknown; it names those that are like it.
            TypeError: the key is not a text: programs have ids instead of places.
        """
        if not isinstance(program_id, str):
            raise TypeError(self._no_id(program_id))
        return steady(self.folder, lambda: self._entry(program_id))

    def _entry(self, program_id: str) -> Entry:
        query = "SELECT * FROM programs WHERE program_id = $id"
        found = next(filter(None, (self._rows(query, name) for name in names_of(program_id))), None)
        if found is None:
            raise KeyError(self._unknown(program_id))
        program_id = found[0]["program_id"]
        query = f"SELECT * FROM executions WHERE program_id = $id AND {self.included} ORDER BY execution_id"
        rows = self._rows(query, program_id)
        repairs = self._rows("SELECT * FROM repairs WHERE program_id = $id ORDER BY attempt", program_id)
        sketches = self._rows("SELECT * FROM sketches WHERE program_id = $id", program_id)
        with reading(self.folder):
            # With literal ids DuckDB reads only the row groups that contain them; a join would read all.
            wanted = self._named("environments", "environment_id", sorted({row["environment_id"] for row in rows}))
            runs: list[Any] = [{**row, "environment": wanted[row["environment_id"]]} for row in rows]
        return Entry(found[0], tuple(map(self.run_of, runs)), tuple(repairs), tuple(sketches))

    def _no_id(self, key: object) -> str:
        """Return the message for a key that is not an id: which keys there are."""
        first = next(iter(self), None)
        example = f"dataset[{first!r}]" if first else "there is none here"
        return (
            f"a program is found by its id, a text, not by {cut(repr(key), 40)}: {example}; "
            "list(dataset) has all ids, dataset.programs all programs as a table"
        )

    def _unknown(self, program_id: str) -> str:
        """Return the message for an id that no program has: the program of an execution, or ids like it."""
        query = "SELECT program_id FROM programs ORDER BY jaro_winkler_similarity(program_id, $id) DESC, 1 LIMIT 3"
        near = ", ".join(f"`{row['program_id']}`" for row in self._rows(query, str(program_id)))
        runs = self._rows("SELECT program_id FROM executions WHERE execution_id = $id", str(program_id))
        if runs:
            program = runs[0]["program_id"]
            return f"`{program_id}` is an execution of a program: dataset[{program!r}].runs has its executions"
        return f"no program `{cut(str(program_id), 80)}` among {len(self):,}; the nearest ids are {near or 'none'}"

    @property
    def included(self) -> str:
        """The condition in SQL on rows of `executions` that runs, exports and scores are of."""
        return "true" if self.failures else "executable"

    def home(self, name: str) -> EnvironmentGraph:
        """Return the graph of a home, the base of its environments.

        Raises:
            KeyError: the name is unknown.
        """
        return self.stored_home(name).graph

    def run_of(self, row: StoredRunRow) -> Run:
        """Return the execution of a row."""
        return Run(row, self.stored_home, self.folder)

    @cached_property
    def stored_home(self) -> Callable[[str], StoredHome]:
        """Gives a home by name, read once; raises KeyError where the name is unknown."""
        return cache(partial(StoredHome.read, self._rows))

    @explained
    def to_tensors(self, program_ids: Iterable[str], tick: int = 0) -> Tensors:
        """Programs with all their executions as arrays for graph networks, graphs after `tick` ticks (thesis 5.4.1).

        A shorter run contributes its last graph. `tensors.Tensors` has the shapes.

        Raises:
            KeyError: an id is unknown.

        Examples:
            >>> tensors = hearth.load(folder).to_tensors(["text:milk.txt"])
            >>> tensors.node_class.shape, tensors.edge_index.shape[0], tensors.actions.shape
            ((378,), 2, (1, 3))
        """
        from hearth.datasets.tensors import GraphSample, to_tensors

        entries = [self[program_id] for program_id in program_ids]
        samples = (
            GraphSample(entry.program, run.graph(min(tick, len(run.row["ticks"]))), run.bindings())
            for entry in entries
            for run in entry.runs
        )
        with using(self.folder):
            return to_tensors(samples, self.vocabulary_ids)

    @cached_property
    def vocabulary_ids(self) -> list[Any]:
        """Kind, name and id of every name that `to_tensors` writes as a number."""
        return self.rows("SELECT kind, name, id FROM vocabulary")[1]

    def _named(self, table: str, key: str, ids: list[str]) -> dict[str, Any]:
        if not ids:
            return {}
        asked = {f"id{number}": name for number, name in enumerate(ids)}
        query = f"SELECT * FROM {table} WHERE {key} IN ({', '.join(f'${name}' for name in asked)})"
        return {row[key]: row for row in self.read(query, asked)}

    def _rows(self, query: str, value: str) -> list[Any]:
        return self.read(query, {"id": value})

    def read(self, query: str, asked: dict[str, Any] | None = None, table: str = "") -> list[Any]:
        """Return the rows of a query of ours, by name of column.

        Args:
            query: the query.
            asked: its parameters.
            table: stands as `{table}` in the query, and is read only where ids are from `$low` to `$high`.

        Raises:
            HearthError: DAMAGED_FILE, where a table cannot be read.
        """

        def ask() -> list[Any]:
            with reading(self.folder):
                connection, text = self.connection, query
                if table and asked:
                    text = query.format(table=reading_between(self.folder, table, asked["low"], asked["high"]))
                rows: list[Any] = connection.sql(text, params=asked).to_arrow_table().to_pylist()
                return rows

        return steady(self.folder, ask)
