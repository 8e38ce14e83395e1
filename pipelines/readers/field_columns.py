"""The columns of a table, or keys of a JSON record, by field: as given, or guessed from their names."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from difflib import get_close_matches
from functools import cache
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.yaml_limits import packaged
from hearth.storage.rejects import Reject

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
    """Return the columns of `title=Task,program=Plan`.

    Raises:
        HearthError: UNKNOWN_ID, a field that no record has; or no `=`.
    """
    pairs = [piece.partition("=") for piece in text.split(",") if piece.strip()]
    wrong = [field for field, equals, name in pairs if field.strip() not in FIELDS or not name.strip()]
    if wrong:
        first = wrong[0].strip()[:60]
        near = get_close_matches(first.lower(), FIELDS, n=1)
        message = f"no field is called `{first}`" if first not in FIELDS else f"`{first}` is given no column"
        hint = f"did you mean `{near[0]}`? " if near and first not in FIELDS else ""
        suggestion = f"{hint}write FIELD=COLUMN, as in title=Task,program=Plan; fields are {', '.join(FIELDS)}"
        raise HearthError.of(Code.UNKNOWN_ID, message, suggestion=suggestion)
    return {field.strip(): name.strip() for field, _, name in pairs}


class Asked(dict[str, str]):
    """The columns that `--columns` gives, and the findings in one file.

    Attributes:
        found: the column of each field so far.
        names: the keys of the records so far.
    """

    def __init__(self, given: FieldColumns) -> None:
        super().__init__(given)
        self.found = Found()
        self.names: dict[str, None] = {}
        self._seen: set[tuple[str, ...]] = set()

    def note(self, names: Iterable[str], found: FieldColumns, texts: Sequence[str]) -> None:
        """Note the keys of a record, the fields that they hold, and other keys that may hold them."""
        self.names.update(dict.fromkeys(names))
        for field, name in found.items():
            self.found.setdefault(field, name)
        if tuple(texts) not in self._seen:
            self._seen.add(tuple(texts))
            for field, others in rivals(texts, found, self).items():
                self.found.rivals.setdefault(field, others)

    def absent(self) -> Iterator[tuple[str, str]]:
        """Yield each field whose column no record has, with the column."""
        return ((field, name) for field, name in self.items() if name not in self.names)


class Found(dict[str, str]):
    """The column of each field in a file; `rivals` has the other columns that may hold a field.

    Attributes:
        note: a sentence on how the programs were found, where no name said it.
    """

    def __init__(self, *found: FieldColumns) -> None:
        super().__init__(*found)
        self.rivals: dict[str, list[str]] = {}
        self.is_table = False
        self.note = ""

    @property
    def is_ours(self) -> bool:
        """Return whether every key has the name that it has in our own records, and no other key may hold its field."""
        return (
            not self.is_table
            and not self.rivals
            and all(name in (field, "steps", "text") for field, name in self.items())
        )


def lacks(field: str, name: str, names: Iterable[str], place: str, line: int = 0) -> Reject:
    """Return the fault of a column that `--columns` names and a file does not have."""
    known = list(names)
    by_lower = {each.lower(): each for each in known}
    near = [by_lower[each] for each in get_close_matches(name.lower(), by_lower, n=3, cutoff=0.6)]
    hint = f"did you mean {' or '.join(f'`{each}`' for each in near)}? " if near else ""
    have = f"it has {', '.join(known)[:200] or 'none'}"
    message, remedy = f"a file without a column or key `{name}`, named for `{field}`", f"{hint}{have}"
    return Reject.of(Code.BAD_TABLE, message, file=place, line=line, found=name, suggestion=remedy)


def value_at(record: Mapping[str, Any], name: str) -> Any:
    """Return the value of a key, or of one within another as `answer.plan`; None if there is none."""
    if name in record:
        return record[name]
    found: Any = record
    for key in name.split("."):
        found = found.get(key) if isinstance(found, Mapping) else None
    return found


def shown(place: str, columns: FieldColumns) -> str:
    """Return a sentence that names the columns of a table, and which of the usual fields have none."""
    named = ", ".join(f"{field}={name}" for field, name in columns.items())
    lacking = [field for field in ("program", "title", "description") if field not in columns]
    none = f"; none for {' and '.join(lacking)}" if named and lacking else ""
    rivals = columns.rivals if isinstance(columns, Found) else {}
    also = "".join(
        f" Warning: {' and '.join(f'`{name}`' for name in names)} may hold the {field} too; "
        f"`{columns[field]}` is taken."
        for field, names in rivals.items()
    )
    note = f" {columns.note}" if isinstance(columns, Found) and columns.note else ""
    return f"Columns of {place}: {named or 'none is known'}{none}.{note} `--columns` names others.{also}"


_OF_RECORDS = [["id"], ["ids"], ["no"], ["nr"], ["number"], ["index"], ["idx"], ["count"], ["length"], ["date"]]
"""Last words of columns that number and date records, and say nothing of their own: `plan_id`."""


def guessed(names: Iterable[str], given: FieldColumns, *, exact: bool = False) -> dict[str, str]:
    """Return the column of each field: the given one if the table has it, else that with the likeliest name.

    A field whose given column is missing is not guessed. An instruction is the title where nothing else is.

    Args:
        names: of the columns.
        given: columns that need no guess.
        exact: compare whole names only.
    """
    columns = list(dict.fromkeys(names))
    found = {field: name for field, name in given.items() if name in columns}
    words = {name: _OTHER.sub(" ", name.lower()).split() for name in columns}
    for part in (slice(None), slice(-1, None), slice(1))[: 1 if exact else 3]:
        named = {
            " ".join(words[name][part]): name
            for name in reversed(columns)
            if part == slice(None) or words[name][-1:] not in _OF_RECORDS
        }
        for field, usual in _usual().items():
            likely = (named[each] for each in usual if each in named)
            name = next((name for name in likely if name not in found.values()), None)
            if name is not None and field not in given:
                found.setdefault(field, name)
    if "title" in found and "title" not in given and is_condition(found["title"], found):
        found.pop("title")
    asked = found.get("description", "")
    if "title" not in found.keys() | given.keys() and words.get(asked) == ["instruction"]:
        found["title"] = found.pop("description")
        text = next((name for name in columns if words[name] == ["text"] and name not in found.values()), None)
        found.update({"description": text} if text else {})
    return found


def is_condition(name: str, found: FieldColumns) -> bool:
    """Return whether a column holds conditions: `goal` next to predictions, in files to score."""
    return name.strip().lower() == "goal" and found.get("program", "").strip().lower() in ("prediction", "predicted")


_FORMULA = re.compile(r"[(){}\[\]<>=]|\w:\s*\d")


def is_formula(text: str) -> bool:
    """Return whether a text is a condition, `ON(plate, table): 2`, and no words."""
    return _FORMULA.search(text) is not None


def rivals(names: Iterable[str], found: FieldColumns, given: FieldColumns) -> dict[str, list[str]]:
    """Return the other columns whose whole names say that they hold a program or a title, where one was guessed."""
    others = [name for name in dict.fromkeys(names) if name not in found.values()]
    words = {name: " ".join(_OTHER.sub(" ", name.lower()).split()) for name in others}
    known = {field: [name for name in others if words[name] in _usual()[field]] for field in _DOUBTED}
    return {field: those for field, those in known.items() if those and field in found and field not in given}


_DOUBTED = ("program", "title")
