"""`jsonl`: every table as JSON Lines, with nested values."""

from pathlib import Path

import orjson

from hearth.datasets.dataset import Dataset
from hearth.datasets.export.batches import Wanted, stream
from hearth.schemas.tables import TABLES
from hearth.storage.names import inside

_OF_PROGRAMS = ("programs", "environments", "executions", "perturbations", "repairs", "sketches")


def jsonl(dataset: Dataset, to: Path, wanted: Wanted) -> int:
    """One file per table, one line per row; tables about programs have only rows of the selected programs.

    Returns:
        Number of lines in all files.
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
