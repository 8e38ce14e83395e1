"""Rows, or lines of JSON, that hold a step each: those of one task in order are one program."""

from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from hearth.pipelines.readers.field_columns import FieldColumns, guessed
from hearth.pipelines.readers.json_actions import is_action, is_only_action, is_tool_use, step_of
from hearth.pipelines.readers.program_columns import is_one_step
from hearth.pipelines.readers.step_lists import is_count, number_of, plain_name, text_of
from hearth.pipelines.readers.texts_with_positions import Located
from hearth.storage.rejects import Reject

MOST_ROWS = 1_000
"""Rows of one program, at most; a further row begins another."""


class StepRow(NamedTuple):
    """A row that is a step.

    Attributes:
        key: of its task; "" where the row says nothing of it.
        number: of the step; None where rows are not numbered.
        is_sure: whether it is a step also where no row next to it has its task.
        value: the record so far, with `steps`.
    """

    key: str
    number: int | None
    is_sure: bool
    value: dict[str, Any]


class Entry(NamedTuple):
    """A value with its first line and its name in ids."""

    value: Any
    line: int
    name: str


def joined(entries: Iterable[Entry], row_of: Callable[[Any], StepRow | None]) -> Iterator[Entry]:
    """Return the entries in order, with one for all rows of a program; others stay as they are.

    A row that is refused costs the program no more than its step.
    """
    rows: list[tuple[Entry, StepRow]] = []
    are_steps = False
    for entry in entries:
        if isinstance(entry.value, Reject):
            yield entry
            continue
        row = row_of(entry.value)
        if rows and not (row and _follows(rows, row)):
            are_steps = are_steps or len(rows) > 1
            yield _program(rows, are_steps)
            rows = []
        if row:
            rows.append((entry, row))
        else:
            yield entry
    if rows:
        yield _program(rows, are_steps)


def _follows(rows: list[tuple[Entry, StepRow]], row: StepRow) -> bool:
    first, last = rows[0][1], rows[-1][1]
    if len(rows) >= MOST_ROWS or row.key not in ("", first.key):
        return False
    if row.number is None or last.number is None:
        return row.number is last.number and row.is_sure
    return row.number > last.number and (row.is_sure or first.number in (0, 1))


def _program(rows: list[tuple[Entry, StepRow]], are_steps: bool) -> Entry:
    entry, row = rows[0]
    if len(rows) == 1 and not (row.is_sure or are_steps):
        return entry
    return entry._replace(value={**row.value, "steps": [step for _, each in rows for step in each.value["steps"]]})


def row_of_json(found: Any, given: FieldColumns) -> StepRow | None:
    """Return the step that a JSON object is: an action or words with a number, perhaps with the name of its task."""
    value = found.value if isinstance(found, Located) else found
    if isinstance(value, dict) and is_tool_use(value):
        return StepRow("", None, True, _record(value, "", step_of(value)))
    if not isinstance(value, dict) or any(isinstance(part, dict) for part in value.values()):
        return None
    number = number_of(value) or number_of(value, any_number=True)
    if not number:
        return StepRow("", None, True, _record(value, "", step_of(value))) if is_only_action(value) else None
    names = guessed([key for key, part in value.items() if isinstance(part, str)], given, exact=True)
    title = names.get("title", "")
    title = "" if plain_name(title) == "instruction" and "title" not in given else title  # that of a step
    step = value.get(given["program"]) if "program" in given else _step(value, (title, number), number)
    is_sure = number == number_of(value)
    if not isinstance(step, str) or not (is_sure or is_one_step(step)):
        return None
    return StepRow(_key(value, title, number), int(value[number]), is_sure, _record(value, title, step))


def _step(value: Mapping[str, Any], others: Container[str], number: str) -> str | None:
    """Return the step of an object, given its other keys."""
    rest = {key: part for key, part in value.items() if key not in others}
    return step_of(rest) if is_action(rest) else text_of({**rest, number: value[number]}, any_number=True)


def _record(value: Mapping[str, Any], title: str, step: Any) -> dict[str, Any]:
    return {**({"title": value[title]} if title else {}), "steps": [step]}


def _key(value: Mapping[str, Any], title: str, number: str) -> str:
    """Return the common key of the rows of one task: its name, else its id."""
    own = next((key for key in value if key != number and plain_name(key).split()[-1:] == ["id"]), "")
    return str(value[title or own]) if title or own else ""


def row_of_table(columns: Mapping[str, str], number: str) -> Callable[[Any], StepRow | None]:
    """Return a function that reads a row of a table as a step.

    Args:
        columns: of the fields; the program's column holds a step, or there are columns of an action and its objects.
        number: the column that counts the steps; empty if there is none.
    """

    def row_of(value: Any) -> StepRow | None:
        title = columns.get("title", "")
        count, step = value.get(number, "").strip(), value.get(columns.get("program", ""), "")
        if not step.strip():
            rest = {key: part for key, part in value.items() if part.strip() and key not in (title, number)}
            step = step_of(rest) if is_action(rest) else ""
        if not step.strip() or (number and not is_count(count)):
            return None
        known = {field: value[name] for field, name in columns.items() if field != "program" and value[name]}
        at = int(count) if number else None
        return StepRow(_key(value, title, number), at, True, {**known, "steps": [step]})

    return row_of
