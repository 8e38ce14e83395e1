"""`croissant.json`: the dataset's description in the Croissant format (MLCommons, 1.0)."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pyarrow as pa

from hearth.datasets.format.datasheet import datasheet
from hearth.repair.strengths import MILD
from hearth.schemas.tables import KEYS, REFERENCES, TABLES, comment_of
from hearth.schemas.yaml_extent import packaged
from hearth.storage.files import file_digest, write_json
from hearth.version import RELEASED, VERSION

NAME = "croissant.json"
SUMMARY = (
    "Programs of household activities, run in homes: what was done, what changed, what broke and how it was mended."
)
PARQUET = "application/x-parquet"
LICENSE = "https://spdx.org/licenses/MIT.html"


def write_croissant(folder: Path, strength: str = MILD) -> None:
    """Write the description of a dataset's folder."""
    write_json(folder / NAME, describe(folder, strength))


def describe(folder: Path, strength: str) -> dict[str, Any]:
    """The description as JSON-LD: every Parquet file with its hash, every table with its key and all its columns.

    Columns within columns are sub-fields, extracted by JSONPath; of a list within a list (the objects of steps),
    mlcroissant 1.1 reads the first entry only. References name the files and the column that contain the values, since
    mlcroissant cannot read a table that refers to a field of itself, or to one of a table that it has read before.
    """
    sheet = datasheet(folder, strength)
    return {
        "@context": packaged("hearth.datasets.format", "croissant.yaml"),
        "@type": "sc:Dataset",
        "name": "hearth",
        "description": f"{SUMMARY} {sheet['motivation']}",
        "conformsTo": ["http://mlcommons.org/croissant/1.0", "http://mlcommons.org/croissant/RAI/1.0"],
        "creator": {"@type": "sc:Organization", "name": "The Hearth authors"},
        "citation": f"{sheet['thesis']} {sheet['bibtex']}",
        "rai:dataCollection": f"{sheet['process']} {sheet['authors']}",
        "rai:dataUseCases": sheet["uses"],
        "rai:dataLimitations": f"{sheet['limits']} {sheet['authors']}",
        "license": LICENSE,
        "url": "https://hearth.invalid/",
        "citeAs": "Hearth: household activities as programs that run",
        "version": VERSION,
        "datePublished": RELEASED,
        "distribution": [file for table in TABLES for file in (_file_set(table), *_parts(folder, table))],
        "recordSet": [_records(table) for table in TABLES],
    }


def _parts(folder: Path, table: str) -> Iterator[dict[str, Any]]:
    for path in sorted((folder / table).glob("part-*.parquet")):
        name = path.relative_to(folder).as_posix()
        yield {
            "@type": "cr:FileObject",
            "@id": name,
            "name": name,
            "contentUrl": name,
            "encodingFormat": PARQUET,
            "sha256": file_digest(path),
        }


def _file_set(table: str) -> dict[str, Any]:
    includes = f"{table}/*.parquet"
    return {"@type": "cr:FileSet", "@id": _set(table), "name": _set(table), "encodingFormat": PARQUET,
            "includes": includes}  # fmt: skip


def _set(table: str) -> str:
    return f"{table}-files"


def _records(table: str) -> dict[str, Any]:
    keys = [
        {"@id": f"{table}/{column}"} for column in KEYS[table] if not pa.types.is_list(TABLES[table].field(column).type)
    ]
    fields = [_field(table, column, column.name) for column in TABLES[table]]
    return {"@type": "cr:RecordSet", "@id": table, "name": table, "key": keys, "field": fields}


def _field(table: str, column: pa.Field, path: str) -> dict[str, Any]:
    """A column, or a column within one: the names on the way to it are joined by points, lists marked by `[*]`."""
    listed = pa.types.is_list(column.type)
    kind = column.type.value_type if listed else column.type
    found: dict[str, Any] = {
        "@type": "cr:Field",
        "@id": f"{table}/{path.replace('[*]', '').replace('.', '/')}",
        "name": column.name,
        "description": comment_of(column),
        **({"repeated": True} if listed else {}),
    }
    if pa.types.is_struct(kind):
        inner = f"{path}[*]" if listed else path
        return {**found, "subField": [_field(table, child, f"{inner}.{child.name}") for child in kind]}
    top, _, rest = path.partition(".")
    transform = {"transform": {"jsonPath": rest}} if rest else {}
    source = {**_column(table, top.removesuffix("[*]")), **transform}
    other = next((place for of, name, *place in REFERENCES if (of, name) == (table, path)), None)
    references = {"references": _column(*other)} if other else {}
    return {**found, "dataType": _kind(kind), "source": source, **references}


def _column(table: str, column: str) -> dict[str, Any]:
    return {"fileSet": {"@id": _set(table)}, "extract": {"column": column}}


def _kind(kind: pa.DataType) -> str:
    if pa.types.is_string(kind):
        return "sc:Text"
    if pa.types.is_integer(kind):
        return "sc:Integer"
    return "sc:Boolean" if pa.types.is_boolean(kind) else "sc:Float"
