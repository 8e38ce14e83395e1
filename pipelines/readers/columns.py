"""Which columns of a table, or keys of a JSON record, hold which field: as given, or guessed from their names."""

import re
from collections.abc import Iterable, Mapping
from functools import cache

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.yaml_extent import packaged

FILE = "pipelines/readers/columns.yaml"

FieldColumns = Mapping[str, str]
"""The column of each field."""

FIELDS = ("program", "title", "description", "scene", "program_id", "worker", "platform", "style", "description_id")
"""Fields that `--columns` may name."""

_OTHER = re.compile(r"[^a-z0-9]+")


@cache
def _usual() -> dict[str, list[str]]:
    found: dict[str, list[str]] = packaged("hearth", FILE)
    return found


def read_columns(text: str) -> dict[str, str]:
    """The columns of `title=Task,program=Plan`.

    Raises:
        HearthError: UNKNOWN_ID, a field that no record has; or no `=`.
    """
    pairs = [piece.partition("=") for piece in text.split(",") if piece.strip()]
    wrong = [field for field, equals, name in pairs if field.strip() not in FIELDS or not name.strip()]
    if wrong:
        message = f"`{wrong[0].strip()[:60]}` is not a field with its column"
        suggestion = f"write title=Task,program=Plan; fields are {', '.join(FIELDS)}"
        raise HearthError.of(Code.UNKNOWN_ID, message, suggestion=suggestion)
    return {field.strip(): name.strip() for field, _, name in pairs}


def shown(place: str, columns: FieldColumns) -> str:
    """A sentence that names the columns of a table, and which of the usual fields have none."""
    named = ", ".join(f"{field}={name}" for field, name in columns.items())
    lacking = [field for field in ("program", "title", "description") if field not in columns]
    none = f"; none for {' and '.join(lacking)}" if named and lacking else ""
    return f"Columns of {place}: {named or 'none is known'}{none}. `--columns` names others."


def guessed(names: Iterable[str], given: FieldColumns, *, exact: bool = False) -> dict[str, str]:
    """The column of each field: the given one if the table has it, else that with the likeliest name.

    Args:
        names: of the columns.
        given: columns that need no guess.
        exact: compare whole names only.
    """
    columns = list(dict.fromkeys(names))
    found = {field: name for field, name in given.items() if name in columns}
    words = {name: _OTHER.sub(" ", name.lower()).split() for name in columns}
    for part in (slice(None), slice(-1, None), slice(1))[: 1 if exact else 3]:
        named = {" ".join(words[name][part]): name for name in reversed(columns)}
        for field, usual in _usual().items():
            likely = (named[each] for each in usual if each in named)
            name = next((name for name in likely if name not in found.values()), None)
            if name is not None:
                found.setdefault(field, name)
    return found
