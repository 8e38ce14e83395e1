"""The columns of every table as Arrow schemas, made from the rows that `schemas.rows` declares.

A column's comment stands in its field's metadata (`comment`).
"""

from collections.abc import Iterable
from types import UnionType
from typing import Any, Final, Union, get_args, get_origin, get_type_hints, is_typeddict

import pyarrow as pa

from hearth.schemas import rows
from hearth.schemas.rows import Arrow

_PLAIN = {str: pa.string(), bool: pa.bool_(), int: pa.int32(), float: pa.float64()}


def struct(row: type) -> pa.DataType:
    """The Arrow type of a declared row; nested columns have no comments."""
    return pa.struct([(name, _type(hint)) for name, hint in get_type_hints(row, include_extras=True).items()])


def _type(hint: Any) -> pa.DataType:
    """The Arrow type of an annotation: `X | None` is as X, since Arrow's columns may all be null."""
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


def _schema(row: type, known: Iterable[pa.Field] = (), otherwise: str = "") -> pa.Schema:
    """The schema of a declared row.

    Args:
        row: a TypedDict.
        known: fields with comments, for columns of the same name that have none.
        otherwise: the comment of columns in neither, with their name put in.
    """
    comments = {field.name: field.metadata[b"comment"] for field in known}
    fields = []
    for name, hint in get_type_hints(row, include_extras=True).items():
        own = (each for each in getattr(hint, "__metadata__", ()) if not isinstance(each, Arrow))
        comment = next(own, None) or comments.get(name) or otherwise.format(name)
        fields.append(pa.field(name, _type(hint), metadata={"comment": comment}))
    return pa.schema(fields)


INGESTED: Final = _schema(rows.IngestedRow)
VALIDATED: Final = _schema(rows.ValidatedRow)
CASE: Final = _schema(rows.CaseRow)
_REPAIRED = [CASE.field(name) for name in ("execution_id", "environment_id", "parent_id", "home", "perturbations")]
TRIED: Final = _schema(rows.TriedRow, _REPAIRED, "repair: {}")
SKETCHED: Final = _schema(rows.SketchRow)
RENDERED: Final = _schema(rows.RenderedRow)
FILMED: Final = _schema(rows.FilmedRow)
REJECTED: Final = _schema(rows.RejectedRow)

_VERSIONS: Final = _schema(rows.VersionsRow)

TABLES: Final[dict[str, pa.Schema]] = {
    table: pa.schema([*schema, *_VERSIONS])
    for table, schema in {
        "activities": _schema(rows.ActivityRow),
        "descriptions": _schema(rows.DescriptionRow, INGESTED),
        "programs": _schema(rows.ProgramRow, CASE),
        "homes": _schema(rows.HomeRow),
        "home_nodes": _schema(rows.HomeNodeRow, otherwise="node: {}"),
        "home_edges": _schema(rows.HomeEdgeRow, otherwise="edge: {}"),
        "environments": _schema(rows.EnvironmentRow, CASE, "differs from the home: {}"),
        "executions": _schema(rows.ExecutionRow, CASE),
        "repairs": _schema(rows.RepairedRow, _REPAIRED, "repair: {}"),
        "splits": _schema(rows.SplitRow),
        "sketches": SKETCHED,
        "frames": _schema(rows.FrameRow),
        "videos": _schema(rows.VideoRow),
        "vocabulary": _schema(rows.NameRow),
        "rejects": _schema(rows.RejectRow),
        "ledger": _schema(rows.LedgerRow),
    }.items()
}
"""Published tables by name."""
