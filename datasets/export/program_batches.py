"""Programs, and runs with their programs, read in batches for exporters."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hearth.datasets.damage_faults import reading
from hearth.datasets.dataset import Dataset
from hearth.datasets.format.ids import names_of
from hearth.datasets.published_program import Run
from hearth.schemas.published_rows import ProgramRow
from hearth.storage.batch_sizes import PROGRAMS_EXPORTED


@dataclass(frozen=True, slots=True)
class Wanted:
    """A selection of programs to export.

    Attributes:
        programs: their ids; empty for all.
        limit: greatest number of programs; None for all.
    """

    programs: tuple[str, ...] = ()
    limit: int | None = None

    @property
    def some(self) -> bool:
        """Return whether not all are wanted."""
        return bool(self.programs) or self.limit is not None

    def chosen(self) -> tuple[str, dict[str, Any]]:
        """Return SQL that selects their ids, and its parameters."""
        names = (name for given in self.programs for name in names_of(given))
        asked = {f"id{number}": name for number, name in enumerate(names)}
        where = f" WHERE program_id IN ({', '.join(f'${name}' for name in asked)})" if asked else ""
        limit = f" LIMIT {int(self.limit)}" if self.limit is not None else ""
        return f"SELECT program_id FROM programs{where} ORDER BY program_id{limit}", asked


def programs(dataset: Dataset, wanted: Wanted) -> Iterator[ProgramRow]:
    """Yield rows of `programs`, sorted by id."""
    chosen, asked = wanted.chosen()
    yield from stream(dataset, f"SELECT * FROM programs SEMI JOIN ({chosen}) USING (program_id)"
                                " ORDER BY program_id", asked)  # fmt: skip


def runs(dataset: Dataset, wanted: Wanted, included: str = "") -> Iterator[tuple[ProgramRow, Run]]:
    """Yield each execution with its program's row, sorted by the ids of both.

    Args:
        dataset: to read.
        wanted: which programs.
        included: the condition in SQL on rows `e` of `executions`; that of the dataset if empty.
    """
    chosen, asked = wanted.chosen()
    query = f"""SELECT p AS program, e AS run, v AS environment
        FROM executions e JOIN environments v USING (environment_id) JOIN programs p ON p.program_id = e.program_id
        WHERE e.program_id IN ({chosen}) AND {included or dataset.included} ORDER BY e.program_id, e.execution_id"""
    for row in stream(dataset, query, asked):
        run: Any = {**row["run"], "environment": row["environment"]}
        yield row["program"], dataset.run_of(run)


def stream(dataset: Dataset, query: str, asked: dict[str, Any]) -> Iterator[Any]:
    """Yield the rows of a query."""
    # A separate cursor: a connection has one open result, and homes are read meanwhile.
    with reading(dataset.folder), dataset.connection.cursor() as cursor:
        for batch in cursor.sql(query, params=asked or None).to_arrow_reader(PROGRAMS_EXPORTED):
            yield from batch.to_pylist()


def write(path: Path, data: bytes) -> None:
    """Write a file, and create its folder."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)
