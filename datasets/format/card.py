"""The dataset card: `README.md` next to the tables, with the header that `datasets.load_dataset` reads."""

import re
from collections.abc import Iterator
from pathlib import Path

import orjson
import pyarrow as pa
import pyarrow.parquet as pq

from hearth.datasets.format.action_set_tables import tables_of
from hearth.datasets.format.croissant import SUMMARY
from hearth.datasets.format.datasheet import datasheet
from hearth.datasets.format.image_tables import FOLDER as IMAGES
from hearth.datasets.format.split_columns import PARTS
from hearth.datasets.format.splits import DESCENDED, LEFT_OUT
from hearth.kb.action_sets import USUAL, name_of_set
from hearth.repair.perturbation_strengths import MILD
from hearth.schemas.tables import TABLES, comment_of, nested
from hearth.storage.files import write_bytes
from hearth.storage.templates import rendered
from hearth.version import VERSION

NAME = "README.md"

ROWS = "rows"
"""The split of all rows of a table, for `load_dataset`: the only one of tables that do not descend from programs."""

_LEAKS = {"siblings": "siblings", "steps": "near-duplicate steps", "texts": "near-duplicate texts"}


def write_card(folder: Path, strength: str = MILD, action_set: int = USUAL) -> None:
    """Write the card of a dataset's folder: counts, tables and columns, ledger, splits and leakage, licences."""
    write_bytes(folder / NAME, card(folder, strength, action_set).encode() + b"\n")


def card(folder: Path, strength: str, action_set: int = USUAL) -> str:
    """Return the card, as `card.jinja` has it."""
    return rendered(
        "hearth.datasets.format",
        "card.jinja",
        {"cell": _cell},
        configs=list(_configs(folder)),
        summary=SUMMARY,
        version=VERSION,
        action_set=name_of_set(action_set),
        sheet=datasheet(folder, strength),
        tables=tables_of(action_set),
        counts={table: sum(_rows(path) for path in sorted((folder / table).glob("*.parquet"))) for table in TABLES},
        comment_of=comment_of,
        columns=columns,
        ledger=pq.ParquetFile(folder / "ledger/part-00000.parquet").read().to_pylist(),
        splits=orjson.loads((folder / "splits.json").read_bytes())["splits"],
        leaks=_LEAKS,
        sources=_sources(folder),
    )


def _rows(path: Path) -> int:
    return int(pq.read_metadata(path).num_rows)


def _configs(folder: Path) -> Iterator[tuple[str, dict[str, str]]]:
    """Yield each table for `load_dataset`, with its splits by patterns of files; it fails at splits without a row."""
    places = {table: IMAGES if table == "frames" else table for table in TABLES}
    parts = {place: {f"{place}/*.{part}.parquet": part for part in PARTS} for place in places.values()}
    files = {"programs": parts["programs"], "programs_left_out": {f"programs/*.{LEFT_OUT}.parquet": ROWS}}
    for table in (name for name in TABLES if name != "programs"):
        place = places[table]
        files[table] = {**(parts[place] if table in DESCENDED else {}), f"{place}/*.parquet": ROWS}
    for name, found in files.items():
        yield name, {pattern: split for pattern, split in found.items() if any(map(_rows, folder.glob(pattern)))}


def columns(schema: pa.Schema) -> Iterator[str]:
    """Yield a table of the columns and nested fields, with their types and meanings."""
    yield from ("| column | type | meaning |", "|---|---|---|")
    for path, field in (each for column in schema for each in nested(column)):
        kind = re.sub(r"<.*", "", str(field.type)).replace("string", "text")
        yield f"| `{path}` | {kind} | {_cell(comment_of(field))} |"


def _sources(folder: Path) -> list[tuple[str | None, str | None, int]]:
    """Return the origins and sources of programs, with their numbers."""
    counts: dict[tuple[str | None, str | None], int] = {}
    for path in sorted((folder / "programs").glob("part-*.parquet")):
        table = pq.ParquetFile(path).read(columns=["origin", "source"])
        for pair in zip(table["origin"].to_pylist(), table["source"].to_pylist(), strict=True):
            counts[pair] = counts.get(pair, 0) + 1
    ordered = sorted(counts.items(), key=lambda item: (item[0][0] or "", item[0][1] or ""))
    return [(*pair, number) for pair, number in ordered]


def _cell(text: str | None) -> str:
    return (text or "").replace("|", "\\|").replace("\n", " ")
