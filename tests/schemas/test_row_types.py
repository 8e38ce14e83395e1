"""The declared rows and the Arrow schemas made of them: columns, types and comments."""

import typing
from types import UnionType

import pyarrow as pa
import pytest

from hearth.schemas import stage_rows, tables
from hearth.schemas.row_types import Arrow, Long

SCHEMAS = {
    **{name: value for name, value in vars(tables).items() if isinstance(value, pa.Schema) and name.isupper()},
    **tables.TABLES,
}
PYTHON = {"string": str, "bool": bool, "double": float, "int32": int, "int64": int, "uint64": int}


@pytest.mark.parametrize("name", SCHEMAS)
def test_every_column_says_what_it_means(name):
    assert all(field.metadata[b"comment"] for field in SCHEMAS[name])


def values(kind, number=7):
    """A value of an Arrow type."""
    if pa.types.is_struct(kind):
        return {field.name: values(field.type) for field in kind}
    return [values(kind.value_type)] if pa.types.is_list(kind) else PYTHON[str(kind)](number)


def fits(value, hint):
    """Return whether a value is of a declared type: every key of a row, every element of a list."""
    origin = typing.get_origin(hint)
    if origin is typing.Annotated:
        return fits(value, hint.__origin__)
    if origin in (typing.Union, UnionType):
        return any(fits(value, each) for each in typing.get_args(hint))
    if origin is list:
        return isinstance(value, list) and all(fits(each, *typing.get_args(hint)) for each in value)
    if typing.is_typeddict(hint):
        hints = typing.get_type_hints(hint, include_extras=True)
        return value.keys() == hints.keys() and all(fits(value[key], each) for key, each in hints.items())
    return type(value) is hint


@pytest.mark.parametrize(
    ("row", "schema"),
    [
        (stage_rows.IngestedRow, tables.INGESTED),
        (stage_rows.ValidatedRow, tables.VALIDATED),
        (stage_rows.CaseRow, tables.CASE),
        (stage_rows.SketchRow, tables.SKETCHED),
        (stage_rows.RenderedRow, tables.RENDERED),
        (stage_rows.FilmedRow, tables.FILMED),
        (stage_rows.RejectedRow, tables.REJECTED),
    ],
    ids=lambda each: getattr(each, "__name__", ""),
)
def test_what_arrow_gives_back_is_the_declared_row(row, schema):
    (given,) = pa.Table.from_pylist([values(pa.struct(list(schema)))], schema).to_pylist()
    assert fits(given, row)
    assert not fits({**given, "other": 1}, row)


def test_numbers_have_the_widths_that_are_published():
    assert str(tables.TABLES["environments"].field("seed").type) == "uint64"
    assert {str(field.type) for field in tables.TABLES["ledger"] if field.name.startswith("records")} == {"int64"}
    assert str(tables.CASE.field("steps").type.value_type.field("line").type) == "int32"
    assert isinstance(Long.__metadata__[0], Arrow)
