"""`jsonl` and `csv`: every table as lines, with nested values."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import orjson

from hearth.datasets.dataset import Dataset
from hearth.datasets.export.program_batches import Wanted, stream
from hearth.datasets.query_output import write_separated
from hearth.schemas.tables import TABLES
from hearth.storage.names import inside

_ITS = " WHERE program_id IN ({chosen})"
_OF_PARENTS = " WHERE coalesce(program_id, parent_id) IN ({chosen})"
_OF_RUNS = " WHERE execution_id IN (SELECT execution_id FROM executions WHERE program_id IN ({chosen}))"
_WHERE = {
    **dict.fromkeys(("programs", "environments", "executions", "sketches", "splits"), _ITS),
    **dict.fromkeys(("perturbations", "repairs"), _OF_PARENTS),
    **dict.fromkeys(("frames", "videos", "clips", "demonstration_frames"), _OF_RUNS),
}
"""The rows of a selection of programs, by table; of other tables all rows."""


def jsonl(dataset: Dataset, to: Path, wanted: Wanted) -> int:
    """One file per table, one line per row; tables about programs have only rows of the selected programs.

    Returns:
        Number of lines in all files.
    """
    lines = 0
    to.mkdir(parents=True, exist_ok=True)
    for table, query, asked in tables(wanted):
        with inside(to, f"{table}.jsonl").open("wb") as file:
            for row in stream(dataset, query, asked):
                file.write(orjson.dumps(row, option=orjson.OPT_APPEND_NEWLINE))
                lines += 1
    return lines


def csv(dataset: Dataset, to: Path, wanted: Wanted) -> int:
    """Write the tables as comma-separated values; nested values are JSON, and spreadsheets find text, never formulas.

    Returns:
        Number of rows in all files.
    """
    rows = 0
    to.mkdir(parents=True, exist_ok=True)
    for table, query, asked in tables(wanted):
        with inside(to, f"{table}.csv").open("w", encoding="utf-8", newline="") as file:
            rows += write_separated(dataset, query, file, asked=asked)
    return rows


def tables(wanted: Wanted) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield every table with the query of its rows, all or those of the wanted programs, and its parameters."""
    chosen, asked = wanted.chosen()
    for table in TABLES:
        where = _WHERE.get(table, "").format(chosen=chosen) if wanted.some else ""
        yield table, f"SELECT * FROM {table}{where} ORDER BY ALL", asked if where else {}
