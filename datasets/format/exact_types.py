"""Types of DuckDB that Python, Arrow or JSON alter: a column of one is asked for as DuckDB's own text.

Arrow wraps `UHUGEINT` around and gives bits and big numbers as bytes; Python has no infinite day, no time of 24:00, no
interval in months and no nanoseconds. Types that are not listed here are text too, so that a new one of DuckDB's is
said as DuckDB says it.
"""

from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

DEEPEST = 50
"""Lists and structures that may stand in one another in an answer; Arrow takes 64."""

_NESTED = {"list", "array", "struct", "map", "union", "tuple"}

TEXT = frozenset({
    "boolean", "tinyint", "smallint", "integer", "bigint", "hugeint", "utinyint", "usmallint", "uinteger", "ubigint",
    "float", "double", "decimal", "varchar", "uuid", "enum", "blob", "null",
})  # fmt: skip
"""Types whose values lose nothing on their way to text and JSON; all others are asked for as text."""

PYTHON = TEXT | {"date", "time", "interval", "timestamp", "timestamp_s", "timestamp_ms", "timestamp_ns"}
"""Types that callers in Python get as Python's own; infinite dates are its first or last day."""

FILE = TEXT | {"date", "time", "time_ns", "timestamp", "timestamp_ms", "timestamp_ns"}
"""Types that a Parquet file has as they are; it counts days and times by whole numbers, infinite ones too."""

_IN_FILES_AS = {"hugeint": "DECIMAL(38, 0)", "timestamp_s": "TIMESTAMP"}
"""Types that a Parquet file has only as another; a whole number that does not fit is refused by DuckDB."""


def exactly(relation: Any, kept: frozenset[str] = TEXT) -> Any:
    """Return a relation whose columns lose nothing on their way out of DuckDB.

    Args:
        relation: the answer to a question.
        kept: types that stay, such as `TEXT`, `PYTHON` or `FILE`; columns of others become DuckDB's own text.

    Raises:
        HearthError: FILE_TOO_LARGE: lists stand too deep in one another.
    """
    wanted = [_wanted(kind, kept) for kind in relation.types]
    if not any(wanted):
        return relation
    names = ['"' + name.replace('"', '""') + '"' for name in relation.columns]
    cells = (f"CAST(#{n} AS {kind})" if kind else f"#{n}" for n, kind in enumerate(wanted, 1))
    return relation.project(", ".join(f"{cell} AS {name}" for cell, name in zip(cells, names, strict=True)))


def _wanted(kind: Any, kept: frozenset[str], depth: int = 1) -> str:
    """Return the type to cast a type to; "" if it stays as it is."""
    if kind.id not in _NESTED:
        other = _IN_FILES_AS.get(kind.id, "") if kept is FILE else ""
        return other or ("" if kind.id in kept else "VARCHAR")
    if depth > DEEPEST:
        message = f"the answer has lists or structures more than {DEEPEST} deep in one another"
        raise HearthError.of(Code.FILE_TOO_LARGE, message, suggestion="ask for their parts, or for `...::VARCHAR`")
    parts = kind.children[:1] if kind.id == "array" else kind.children
    found = [_wanted(each, kept, depth + 1) for _, each in parts]
    if kind.id in ("union", "tuple"):
        return "VARCHAR" if kept is FILE or any(found) else ""
    if not any(found):
        return ""
    types = [new or str(each) for new, (_, each) in zip(found, parts, strict=True)]
    if kind.id == "map":
        return f"MAP({', '.join(types)})"
    if kind.id == "struct":
        fields = ('"' + name.replace('"', '""') + f'" {each}' for (name, _), each in zip(parts, types, strict=True))
        return f"STRUCT({', '.join(fields)})"
    return f"{types[0]}[{kind.children[1][1] if kind.id == 'array' else ''}]"
