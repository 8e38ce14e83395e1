"""Datasets as strangers could write them: copies of one of ours, with values of its tables replaced."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq


def rewrite(folder: Path, table: str, change: Callable[[dict[str, Any]], dict[str, Any]]) -> int:
    """Replace every row of a table by what `change` makes of it; returns how many rows there are."""
    count = 0
    for path in sorted((folder / table).glob("*.parquet")):
        found = pq.read_table(path)
        rows = [change(row) for row in found.to_pylist()]
        pq.write_table(pa.Table.from_pylist(rows, found.schema), path)
        count += len(rows)
    return count


def replace_texts(folder: Path, texts: dict[str, str]) -> None:
    """Replace several texts in all tables, each wherever it is a whole value."""

    def change(row: dict[str, Any]) -> dict[str, Any]:
        for old, new in texts.items():
            row = replaced(row, old, new)
        return row

    for table in sorted(path.name for path in folder.iterdir() if any(path.glob("*.parquet"))):
        rewrite(folder, table, change)


def rename(folder: Path, old: str, new: str) -> None:
    """Replace a text by another in all tables, wherever it is a whole value."""
    replace_texts(folder, {old: new})


def replaced(value: Any, old: str, new: str) -> Any:
    """A value of rows with a text replaced wherever it stands."""
    if isinstance(value, dict):
        return {key: replaced(each, old, new) for key, each in value.items()}
    if isinstance(value, list):
        return [replaced(each, old, new) for each in value]
    return new if value == old else value
