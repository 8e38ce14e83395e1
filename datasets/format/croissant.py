"""`croissant.json`: the dataset's description in the Croissant format (MLCommons, 1.0)."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pyarrow as pa

from hearth.schemas.tables import TABLES
from hearth.storage.files import file_digest, write_json
from hearth.version import RELEASED, VERSION

NAME = "croissant.json"
SUMMARY = (
    "Programs of household activities, run in homes: what was done, what changed, what broke and how it was mended."
)
PARQUET = "application/x-parquet"
LICENSE = "https://spdx.org/licenses/MIT.html"

_CONTEXT = {
    "@language": "en",
    "@vocab": "https://schema.org/",
    "citeAs": "cr:citeAs",
    "column": "cr:column",
    "conformsTo": "dct:conformsTo",
    "cr": "http://mlcommons.org/croissant/",
    "rai": "http://mlcommons.org/croissant/RAI/",
    "data": {"@id": "cr:data", "@type": "@json"},
    "dataType": {"@id": "cr:dataType", "@type": "@vocab"},
    "dct": "http://purl.org/dc/terms/",
    "examples": {"@id": "cr:examples", "@type": "@json"},
    "extract": "cr:extract",
    "field": "cr:field",
    "fileProperty": "cr:fileProperty",
    "fileObject": "cr:fileObject",
    "fileSet": "cr:fileSet",
    "format": "cr:format",
    "includes": "cr:includes",
    "isLiveDataset": "cr:isLiveDataset",
    "jsonPath": "cr:jsonPath",
    "key": "cr:key",
    "md5": "cr:md5",
    "parentField": "cr:parentField",
    "path": "cr:path",
    "recordSet": "cr:recordSet",
    "references": "cr:references",
    "regex": "cr:regex",
    "repeated": "cr:repeated",
    "replace": "cr:replace",
    "sc": "https://schema.org/",
    "separator": "cr:separator",
    "source": "cr:source",
    "subField": "cr:subField",
    "transform": "cr:transform",
}


def write_croissant(folder: Path) -> None:
    """Write the description of a dataset's folder."""
    write_json(folder / NAME, describe(folder))


def describe(folder: Path) -> dict[str, Any]:
    """The description as JSON-LD: every Parquet file with its hash, every table with its columns of plain values.

    Nested columns (steps, ticks, ...) are omitted, because readers of Croissant do not agree on their form; the dataset
    card describes them.
    """
    return {
        "@context": _CONTEXT,
        "@type": "sc:Dataset",
        "name": "hearth",
        "description": SUMMARY,
        "conformsTo": "http://mlcommons.org/croissant/1.0",
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
    fields = [_field(table, column) for column in TABLES[table] if _kind(column.type)]
    return {"@type": "cr:RecordSet", "@id": table, "name": table, "field": fields}


def _field(table: str, column: pa.Field) -> dict[str, Any]:
    comment = (column.metadata or {}).get(b"comment", b"").decode()
    listed = {"repeated": True} if pa.types.is_list(column.type) else {}
    return {
        "@type": "cr:Field",
        "@id": f"{table}/{column.name}",
        "name": column.name,
        "description": comment,
        "dataType": _kind(column.type),
        **listed,
        "source": {"fileSet": {"@id": _set(table)}, "extract": {"column": column.name}},
    }


def _kind(kind: pa.DataType) -> str | None:
    if pa.types.is_list(kind):
        return _kind(kind.value_type)
    if pa.types.is_string(kind):
        return "sc:Text"
    if pa.types.is_integer(kind):
        return "sc:Integer"
    if pa.types.is_floating(kind):
        return "sc:Float"
    return "sc:Boolean" if pa.types.is_boolean(kind) else None
