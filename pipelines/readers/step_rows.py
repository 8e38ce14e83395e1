"""Rows, or lines of JSON, that hold a step each: those of one task are one program."""

from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from typing import Any

from hearth.pipelines.readers.field_columns import FieldColumns, guessed
from hearth.pipelines.readers.json_actions import is_action, is_only_action, is_tool_use, step_of
from hearth.pipelines.readers.program_columns import is_one_step
from hearth.pipelines.readers.step_lists import is_count, number_of, plain_name, text_of
from hearth.pipelines.readers.step_rows_by_task import Entry, StepRow, Tasks
from hearth.pipelines.readers.texts_with_positions import Located
from hearth.storage.rejects import Reject


def joined(entries: Iterable[Entry], row_of: Callable[[Any], StepRow | None]) -> Iterator[Entry]:
    """Return the entries in order, with one for all rows of a program; others stay as they are.

    A row that is refused costs the program no more than its step.
    """
    tasks = Tasks()
    for entry in entries:
        yield from tasks.take(entry, None if isinstance(entry.value, Reject) else row_of(entry.value))
    yield from tasks.end()


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
