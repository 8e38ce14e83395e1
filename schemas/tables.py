"""The columns of every table as Arrow schemas, made from the rows that `schemas.stage_rows` and
`schemas.published_rows` declare.

A column's comment stands in its field's metadata (`comment`).
"""

from collections.abc import Iterable, Iterator, Mapping
from types import MappingProxyType, UnionType
from typing import Any, Final, Union, get_args, get_origin, get_type_hints, is_typeddict

import pyarrow as pa

from hearth.schemas import published_rows, stage_rows
from hearth.schemas.row_types import Arrow
from hearth.schemas.yaml_limits import packaged

_PLAIN = {str: pa.string(), bool: pa.bool_(), int: pa.int32(), float: pa.float64()}


def struct(row: type) -> pa.DataType:
    """Return the Arrow type of a declared row."""
    return pa.struct(_fields(row))


def _type(hint: Any) -> pa.DataType:
    """Return the Arrow type of an annotation: `X | None` is as X, since Arrow's columns may all be null."""
    wide = next((each for each in getattr(hint, "__metadata__", ()) if isinstance(each, Arrow)), None)
    if wide:
        return pa.type_for_alias(wide)
    if hasattr(hint, "__metadata__"):
        return _type(hint.__origin__)
    if get_origin(hint) in (Union, UnionType):
        return _type(next(each for each in get_args(hint) if each is not type(None)))
    if get_origin(hint) is list:
        return pa.list_(_type(*get_args(hint)))
    return struct(hint) if is_typeddict(hint) else _PLAIN[hint]


def schema_of(row: type, known: Iterable[pa.Field] = ()) -> pa.Schema:
    """Return the schema of a declared row; columns that have no comment have that of the known field of their name."""
    comments = {field.name: comment_of(field) for field in known}
    return pa.schema(_fields(row, comments), metadata={"comment": str(row.__doc__)})


def _fields(row: type, comments: Mapping[str, str] = MappingProxyType({})) -> list[pa.Field]:
    fields = []
    for name, hint in get_type_hints(row, include_extras=True).items():
        own = (each for each in getattr(hint, "__metadata__", ()) if not isinstance(each, Arrow))
        comment = next(own, None) or comments.get(name, "")
        fields.append(pa.field(name, _type(hint), metadata={"comment": comment}))
    return fields


def comment_of(described: pa.Field | pa.Schema) -> str:
    """Return the meaning of a column, of a nested field, or of a table."""
    return str((described.metadata or {}).get(b"comment", b"").decode())


def nested(column: pa.Field, path: str = "") -> Iterator[tuple[str, pa.Field]]:
    """Yield a column and all fields within it, with their paths.

    `steps`, `steps[].objects`, `steps[].objects[].name`.
    """
    kind, path = column.type, path or column.name
    yield path, column
    while pa.types.is_list(kind):
        kind, path = kind.value_type, f"{path}[]"
    for field in kind if pa.types.is_struct(kind) else ():
        yield from nested(field, f"{path}.{field.name}")


INGESTED: Final = schema_of(stage_rows.IngestedRow)
VALIDATED: Final = schema_of(stage_rows.ValidatedRow)
CASE: Final = schema_of(stage_rows.CaseRow)
SKETCHED: Final = schema_of(stage_rows.SketchRow)
RENDERED: Final = schema_of(stage_rows.RenderedRow)
FILMED: Final = schema_of(stage_rows.FilmedRow)
CLIPPED: Final = schema_of(stage_rows.ClippedRow)
DEMONSTRATED: Final = schema_of(stage_rows.DemonstratedRow)
REJECTED: Final = schema_of(stage_rows.RejectedRow)

_VERSIONS: Final = schema_of(published_rows.VersionsRow)

TABLES: Final[dict[str, pa.Schema]] = {
    table: pa.schema([*schema, *_VERSIONS], metadata=schema.metadata)
    for table, schema in {
        "activities": schema_of(published_rows.ActivityRow),
        "descriptions": schema_of(published_rows.DescriptionRow, INGESTED),
        "programs": schema_of(published_rows.ProgramRow, CASE),
        "homes": schema_of(published_rows.HomeRow),
        "home_nodes": schema_of(published_rows.HomeNodeRow),
        "home_edges": schema_of(published_rows.HomeEdgeRow),
        "environments": schema_of(published_rows.EnvironmentRow, CASE),
        "executions": schema_of(published_rows.ExecutionRow, CASE),
        "perturbations": schema_of(published_rows.PerturbedRow),
        "repairs": schema_of(published_rows.RepairedRow),
        "splits": schema_of(published_rows.SplitRow),
        "sketches": SKETCHED,
        "frames": schema_of(published_rows.FrameRow),
        "videos": schema_of(published_rows.VideoRow),
        "clips": schema_of(published_rows.ClipRow),
        "demonstration_frames": schema_of(published_rows.DemonstrationFrameRow),
        "vocabulary": schema_of(published_rows.NameRow),
        "rejects": schema_of(stage_rows.RejectRow),
        "ledger": schema_of(published_rows.LedgerRow),
    }.items()
}
"""Published tables by name."""

CONSEQUENCE_TABLES: Final[dict[str, pa.Schema]] = {
    **TABLES,
    "executions": pa.schema(
        [*schema_of(published_rows.HarmfulExecutionRow, TABLES["executions"]), *_VERSIONS],
        metadata=TABLES["executions"].metadata,
    ),
}
"""The tables of datasets of action set 3, whose executions have columns of harm besides."""

_RELATED: Final = packaged("hearth.schemas", "keys.yaml")

KEYS: Final[dict[str, tuple[str, ...]]] = {table: tuple(columns) for table, columns in _RELATED["keys"].items()}
"""Key columns of each table."""

REFERENCES: Final[tuple[tuple[str, str, str, str], ...]] = tuple(
    (table, column, other, KEYS[other][0])
    for table, columns in _RELATED["references"].items()
    for column, other in columns.items()
)
"""References: table and column, and the table and key that must contain the value; null refers to nothing."""
