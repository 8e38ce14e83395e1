"""Synthetic programs whose descriptions were written one by one, not drawn from the grammar."""

import csv
from collections.abc import Iterator
from pathlib import Path
from typing import Any

FILE = Path(__file__).parent.parent / "data_raw" / "synthetic.csv"
"""`program_id`, `title`, `description` and `program` of each; `data_raw/README.md` says how they came about."""


def described(file: Path = FILE) -> Iterator[dict[str, Any]]:
    """Yield the described programs as JSON Lines that `ingest` reads, as `synthesis.record` gives drawn ones."""
    with file.open(encoding="utf-8", newline="") as opened:
        for row in csv.DictReader(opened):
            yield {
                "program_id": row["program_id"],
                "origin": "synthetic",
                "title": row["title"],
                "description": row["description"],
                "descriptions": [],
                "steps": row["program"].split("\n"),
            }
