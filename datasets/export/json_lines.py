"""`jsonl`: every table as JSON Lines, nested values as they are."""

from __future__ import annotations

from pathlib import Path

import orjson

from hearth.datasets.dataset import Dataset
from hearth.datasets.export.batches import Wanted, stream
from hearth.schemas.tables import TABLES
from hearth.storage.names import inside

_OF_PROGRAMS = ("programs", "environments", "executions", "repairs", "sketches")


def jsonl(dataset: Dataset, to: Path, wanted: Wanted) -> int:
    """One file a table, one line a row; tables about programs have only the rows of the programs asked for.

    Returns:
        how many lines, all files together.
    """
    chosen, asked = wanted.chosen()
    lines = 0
    to.mkdir(parents=True, exist_ok=True)
    for table in TABLES:
        some = table in _OF_PROGRAMS
        query = f"SELECT * FROM {table}" + (f" WHERE program_id IN ({chosen})" if some else "") + " ORDER BY ALL"
        with inside(to, f"{table}.jsonl").open("wb") as file:
            for row in stream(dataset, query, asked if some else {}):
                file.write(orjson.dumps(row, option=orjson.OPT_APPEND_NEWLINE))
                lines += 1
    return lines
