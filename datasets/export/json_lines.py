"""`jsonl`: every table as JSON Lines, with nested values."""

from pathlib import Path

import orjson

from hearth.datasets.dataset import Dataset
from hearth.datasets.export.batches import Wanted, stream
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
"""Which rows a selection of programs has, by table; of other tables all."""


def jsonl(dataset: Dataset, to: Path, wanted: Wanted) -> int:
    """One file per table, one line per row; tables about programs have only rows of the selected programs.

    Returns:
        Number of lines in all files.
    """
    chosen, asked = wanted.chosen()
    lines = 0
    to.mkdir(parents=True, exist_ok=True)
    for table in TABLES:
        where = _WHERE.get(table, "").format(chosen=chosen) if wanted.some else ""
        query = f"SELECT * FROM {table}{where} ORDER BY ALL"
        with inside(to, f"{table}.jsonl").open("wb") as file:
            for row in stream(dataset, query, asked if where else {}):
                file.write(orjson.dumps(row, option=orjson.OPT_APPEND_NEWLINE))
                lines += 1
    return lines
