"""`croissant.json`: the dataset's description in the Croissant format (MLCommons, 1.0)."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pyarrow as pa

from hearth.datasets.format.action_set_tables import tables_of
from hearth.datasets.format.datasheet import datasheet
from hearth.kb.action_sets import USUAL
from hearth.repair.perturbation_strengths import MILD
from hearth.schemas.program import MOST_OBJECTS
from hearth.schemas.tables import KEYS, REFERENCES, TABLES, comment_of
from hearth.schemas.yaml_limits import packaged
from hearth.storage.files import file_digest, write_json
from hearth.version import RELEASED, VERSION

NAME = "croissant.json"
SUMMARY = "Programs of household activities, run in homes: their actions, the changes, the failures and the repairs."
PARQUET = "application/x-parquet"
LICENSE = "https://spdx.org/licenses/MIT.html"


def write_croissant(folder: Path, strength: str = MILD, action_set: int = USUAL) -> None:
    """Write the description of a dataset's folder."""
    write_json(folder / NAME, describe(folder, strength, action_set))


def describe(folder: Path, strength: str, action_set: int = USUAL) -> dict[str, Any]:
    """Return the description as JSON-LD.

    Every Parquet file with its hash, every table with its key and all its columns.

    Columns within columns are sub-fields, extracted by JSONPath. Of a list within a list mlcroissant 1.1 reads one
    entry only, so the objects of a step are a field for each place; of other such lists it reads the first. References
    name the files and the column that contain the values, since mlcroissant cannot read a table that refers to a field
    of itself, or to one of a table that it has read before.
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
        "recordSet": [_records(table, schema) for table, schema in tables_of(action_set).items()],
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


def _records(table: str, schema: pa.Schema) -> dict[str, Any]:
    keys = [{"@id": f"{table}/{column}"} for column in KEYS[table] if not pa.types.is_list(schema.field(column).type)]
    fields = [_field(table, column, column.name) for column in schema]
    return {"@type": "cr:RecordSet", "@id": table, "name": table, "key": keys, "field": fields}


def _field(table: str, column: pa.Field, path: str) -> dict[str, Any]:
    """Return a column, or a column within one.

    The names on the way to it are joined by points, lists marked by `[*]`.
    """
    listed = pa.types.is_list(column.type)
    kind = column.type.value_type if listed else column.type
    found = _head(table, path, column.name, comment_of(column), listed)
    if pa.types.is_struct(kind):
        if listed and path.endswith("[*].objects"):
            return {**found, "subField": [_place(table, kind, f"{path}[{place}]") for place in range(MOST_OBJECTS)]}
        inner = f"{path}[*]" if listed else path
        return {**found, "subField": _within(table, kind, inner)}
    top, _, rest = path.partition(".")
    transform = {"transform": {"jsonPath": rest}} if rest else {}
    source = {**_column(table, top.removesuffix("[*]")), **transform}
    other = next((place for of, name, *place in REFERENCES if (of, name) == (table, path)), None)
    references = {"references": _column(*other)} if other else {}
    return {**found, "dataType": _kind(kind), "source": source, **references}


def _within(table: str, kind: pa.StructType, path: str) -> list[dict[str, Any]]:
    return [_field(table, child, f"{path}.{child.name}") for child in kind]


def _place(table: str, kind: pa.StructType, path: str) -> dict[str, Any]:
    """Return the objects that the steps of a list have in one place; empty where a step has fewer."""
    place = path[path.rindex("[") + 1 : -1]
    meaning = f"Of each entry, the object in place {place}, from 0; empty where there are fewer."
    return {**_head(table, path, place, meaning, True), "subField": _within(table, kind, path)}


def _head(table: str, path: str, name: str, meaning: str, listed: bool) -> dict[str, Any]:
    """Return the common keys of every field; `steps[*].objects[0].name` is `programs/steps/objects/0/name`."""
    words = path.replace("[*]", "").replace("[", ".").replace("]", "").split(".")
    head = {"@type": "cr:Field", "@id": "/".join([table, *words]), "name": name, "description": meaning}
    return {**head, "repeated": True} if listed else head


def _column(table: str, column: str) -> dict[str, Any]:
    return {"fileSet": {"@id": _set(table)}, "extract": {"column": column}}


def _kind(kind: pa.DataType) -> str:
    if pa.types.is_string(kind):
        return "sc:Text"
    if pa.types.is_integer(kind):
        return "sc:Integer"
    return "sc:Boolean" if pa.types.is_boolean(kind) else "sc:Float"
