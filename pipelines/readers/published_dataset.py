"""A published dataset of ours: its original programs and the descriptions without a program.

Augmented programs are not read; the next build makes them again.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hearth.datasets.format.catalog import earlier
from hearth.datasets.format.ids import current_id
from hearth.datasets.format.row_conversion import program_of
from hearth.datasets.format.splits import RULES
from hearth.pipelines.readers import json_records
from hearth.pipelines.readers.reader_items import Item, refused
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.stage_rows import IngestedRow
from hearth.schemas.syntax import print_lines
from hearth.storage.archives import DamagedError
from hearth.storage.files import read_json
from hearth.storage.parquet_rows import row_lists
from hearth.storage.rejects import Reject

NAME = "published"

COLUMNS = [
    "program_id", "origin", "description_id", "parent_id", "title", "description", "steps", "rooms", "props",
    "worker", "platform",
]  # fmt: skip
DESCRIPTION_COLUMNS = [
    "description_id", "title", "description", "scene", "origin", "worker", "platform", "style", "programs",
]  # fmt: skip


def names_it(path: Path) -> bool:
    """Return whether a folder is a dataset."""
    manifest = read_json(path / "manifest.json")
    return isinstance(manifest, dict) and manifest.get("stage") == "publish"


def scan(path: Path, place: str) -> Iterator[Item]:
    """One item for each original program, then one for each description without any."""
    columns = ["description_id", "scene", "style"]
    described = {row["description_id"]: row for row in _rows(path, "descriptions", columns)}
    parts, empty = _own_splits(path), True
    for row in _rows(path, "programs", COLUMNS):
        if row["parent_id"] is None:
            empty = False
            words = {**row, **described.get(row["description_id"], {}), "splits": parts.get(row["program_id"])}
            yield _item(row["program_id"], f"{place}/programs", words)
    for row in _rows(path, "descriptions", DESCRIPTION_COLUMNS):
        if not row.pop("programs"):
            empty = False
            yield _item(row["description_id"], f"{place}/descriptions", row)
    if empty:
        yield refused(place, Reject.of(Code.EMPTY, "a dataset without programs or descriptions", file=place))


def _own_splits(path: Path) -> dict[str, dict[str, str | None]]:
    """Program id -> split -> part, of the splits that came with the dataset's source."""
    about = read_json(path / "splits.json")
    named = about.get("splits") if isinstance(about, dict) else None
    found: dict[str, dict[str, str | None]] = {}
    if isinstance(named, dict) and named.keys() - RULES.keys():
        for row in _rows(path, "splits", ["program_id", "split", "part"]):
            if isinstance(row["split"], str) and row["split"] not in RULES:
                found.setdefault(row["program_id"], {})[row["split"]] = row["part"]
    return found


def _item(own: str, place: str, row: Any) -> Item:
    own = current_id(own)
    fault = json_records.id_fault(own, place)
    return refused(place, fault) if fault else Item(own, NAME, place, row)


def _rows(path: Path, table: str, columns: list[str]) -> Iterator[Any]:
    import pyarrow as pa
    import pyarrow.parquet as pq

    for file in sorted((path / table).glob("*.parquet")):
        try:
            if not file.is_file():
                raise ValueError("it is not a regular file")
            if not file.resolve().is_relative_to(path.resolve()):
                raise ValueError("it is a link that leads out of the dataset")
            with pq.ParquetFile(file) as source:
                later = {*earlier(1).get(table, {}).get("lacks", ())} - {*source.schema_arrow.names}
                columns = [name for name in columns if name not in later]
                lacking = sorted({*columns} - {*source.schema_arrow.names})
                if lacking:
                    raise ValueError(f"it lacks the column{'s' * (len(lacking) > 1)} {', '.join(lacking)}")
                _check_text(source.schema_arrow, columns)
                for rows in row_lists(source, file.stat().st_size, f"{table}/{file.name}", columns):
                    yield from rows
        except HearthError as error:  # it unpacks to too much
            raise DamagedError(error.diagnostics) from error
        except (pa.ArrowException, OSError, ValueError) as error:
            name = f"{table}/{file.name}"
            message = f"can't be read as a table of a dataset: {error}"
            suggestion = "`verify` checks whether a dataset is complete; copy it again"
            raise DamagedError.of(Code.DAMAGED_FILE, message, file=name, suggestion=suggestion) from error


def _check_text(schema: Any, columns: list[str]) -> None:
    """Raise ValueError if the first column, the rows' id, is not text, or any column is bytes."""
    import pyarrow.types as kind

    for name in columns:
        found = schema.field(name).type
        text = kind.is_string(found) or kind.is_large_string(found)
        if kind.is_binary(found) or kind.is_large_binary(found) or (name == columns[0] and not text):
            raise ValueError(f"{name} is {found}, not text")


def read(item: Item) -> list[IngestedRow | Reject]:
    """Return the record of a row."""
    value = item.value
    try:
        origin = str(value["origin"])
        if "steps" in value:
            program = program_of(value)
            value = {**value, "text": "".join(f"{line}\n" for line in print_lines(program))}
            del value["steps"]
        rows = json_records.read(Item(item.record_id, json_records.NAME, item.place, value))
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        message = f"not a row of a dataset: {type(error).__name__} {error}"
        suggestion = "copy it again"
        return [Reject.of(Code.DAMAGED_FILE, message, file=item.place, found=item.record_id, suggestion=suggestion)]
    if origin != "crowd":  # of a crowd's rows `ours` knows those that were written
        rows = [row if isinstance(row, Reject) else {**row, "origin": origin} for row in rows]
    return rows
