"""The tables of the report, each with its query (`report_tables.yaml`)."""

from dataclasses import dataclass
from typing import Any

from hearth.datasets.dataset import Dataset
from hearth.schemas.yaml_limits import packaged


@dataclass(frozen=True, slots=True)
class Figure:
    """A table of the report.

    Attributes:
        title: its heading.
        source: the corresponding table, figure or section of the thesis, or "".
        query: its SQL.
        columns, rows: the result.
        bars: length of each row's bar, percent of the longest.
    """

    title: str
    source: str
    query: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Any, ...], ...]
    bars: tuple[float, ...]


def figures(dataset: Dataset) -> list[Figure]:
    """Return every figure with a non-empty result."""
    found = []
    for each in packaged("hearth.datasets.report", "report_tables.yaml"):
        columns, rows = dataset.rows(each["query"])
        if rows:
            lengths = [float(row[columns.index(each["bars"])] or 0) for row in rows]
            longest = max(lengths) or 1.0
            bars = tuple(round(100 * length / longest, 1) for length in lengths)
            head = (each["title"], str(each.get("source", "")), each["query"])
            found.append(Figure(*head, tuple(columns), tuple(rows), bars))
    return found
