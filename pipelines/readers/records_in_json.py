"""The records in a JSON value, with their fields by our names, whatever their keys are."""

import itertools
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from hearth.kb.language.program_lines import is_plan
from hearth.pipelines.readers.field_columns import Asked, FieldColumns, guessed, is_condition, is_formula, value_at
from hearth.pipelines.readers.json_actions import is_action, looks_like_mapping, of_planner
from hearth.pipelines.readers.model_outputs import chat_of, of_others
from hearth.pipelines.readers.program_columns import column_of_steps, reading_of
from hearth.pipelines.readers.reader_warnings import IN_ORDER, ORDERED, warned
from hearth.pipelines.readers.step_lists import is_line, numbers_of, plain_name, with_step_lists
from hearth.pipelines.readers.step_texts import IN_LINE
from hearth.pipelines.readers.texts_with_positions import texts_in
from hearth.schemas.failures import Code
from hearth.schemas.program_boundaries import STEP
from hearth.storage.rejects import Reject, as_text


def records_in(value: Any, given: FieldColumns, depth: int = 3) -> Iterator[tuple[str, Any]]:
    """Yield the records of a JSON value with their places in it: itself, or those in the lists and objects that it
    holds.

    An object of programs by their titles holds a record for each.
    """
    if not isinstance(value, dict):
        return
    other = of_others(value)
    if other is not None:
        yield "", _with_own_keys(value, other, given)
    elif of_planner(value.values()):
        yield "", Reject.of(Code.UNSUPPORTED_FILE, _OF_PLANNER, suggestion="write steps as [Walk] <shower> (1)")
    elif _are_plans(value, given):
        yield from ((f"[{number}]", {"title": key, "program": value[key]}) for number, key in enumerate(value, 1))
    elif is_record(value, given):
        yield "", value
    elif value and all(map(_is_steps, (by_title := with_step_lists(value)).values())):
        for number, (title, steps) in enumerate(by_title.items(), 1):
            record = {"steps" if isinstance(steps, list) else "program": steps}
            yield f"[{number}]", record if plain_name(title) in _NO_TITLES else {"title": title, **record}
    elif depth:
        yield from _records_inside(value, given, depth - 1)


class Converted(dict[str, Any]):
    """A record of another form by our names.

    Attributes:
        keys_of_file: its keys in the file.
    """

    def __init__(self, record: dict[str, Any], keys_of_file: Iterable[str]) -> None:
        super().__init__(record)
        self.keys_of_file = [*keys_of_file]


def _with_own_keys(value: dict[str, Any], record: dict[str, Any], given: FieldColumns) -> Converted:
    """Return a converted record with the title next to a chat; the request of the chat then is its description."""
    chat = chat_of(value)
    name = given.get("title") or guessed(
        [key for key, part in value.items() if isinstance(part, str)], {}, exact=True
    ).get("title")
    title = value.get(name) if chat and name else None
    if not name or not isinstance(title, str) or not title.strip():
        return Converted(record, value)
    is_program = not FIELDS.isdisjoint(record.keys() - {"description"})
    asked = "\n".join(filter(None, (record.get("title"), record.get("description")))) if is_program else ""
    if isinstance(given, Asked):
        given.note(value, {"program": chat, "title": name, **({"description": chat} if asked else {})}, [])
    return Converted({**record, "title": title, **({"description": asked} if asked else {})}, value)


def _are_plans(value: dict[str, Any], given: FieldColumns) -> bool:
    """Return whether an object has only several texts, which all read as steps, under keys that are not fields."""
    if len(value) < 2 or given or not all(map(is_line, value.values())) or guessed(value, {}, exact=True):
        return False
    return all(reading_of([text]).are_steps for text in value.values())


def _records_inside(value: dict[str, Any], given: FieldColumns, depth: int) -> Iterator[tuple[str, Any]]:
    """Yield the records of the parts of an object; a part that can't be a record is yielded as one of the others.

    A record without a title has the title among the object's keys, or its own key.
    """
    titled = guessed([key for key, part in value.items() if isinstance(part, str)], {}, exact=True).get("title", "")
    is_asked = plain_name(titled) not in ("", "title", "name")  # as those may be of the whole file
    are_objects = all(isinstance(part, dict) for part in value.values())
    for key, part in value.items():
        listed = part if isinstance(part, list) else [part]
        found = [_plan_in(entry) or list(records_in(entry, given, depth)) for entry in listed]
        for number, (entry, records) in enumerate(zip(listed, found, strict=True), 1):
            if not records and entry and isinstance(entry, dict) and any(found):
                yield f".{as_text(key)}[{number}]", entry
            title = value.get(titled, "" if plain_name(key) in _NO_TITLES or not are_objects else key)
            for inside, each in records:
                is_its = is_asked or (isinstance(part, dict) and len(records) == 1)
                yield f".{as_text(key)}[{number}]{inside}", _with_title(each, title, given) if is_its else each


def _plan_in(value: Any) -> list[tuple[str, Any]]:
    """Return the record of a list in a list, where its texts read as steps."""
    is_texts = isinstance(value, list) and len(value) > 1 and all(map(is_line, value))
    return [("", {"steps": value})] if is_texts and column_of_steps({"steps": ["\n".join(value)]}) else []


def _with_title(record: Any, title: str, given: FieldColumns) -> Any:
    if not title or not isinstance(record, dict) or "title" in named(record, given):
        return record
    return {**record, "title": title}


_NO_TITLES = frozenset({
    "text", "description", "instruction", "instructions", "content", "value", "plan", "plans", "steps", "program",
    "actions", "output", "answer", "response", "result", "results", "data", "completion", "solution", "message", "body",
    "function calls", "tool calls", "calls", "trajectory", "script", "action sequence", "prediction", "generation",
})  # fmt: skip
"""Keys that describe their contents, and are no names of tasks."""


def holds_program(value: Any) -> bool:
    """Return whether steps are among the records of a value."""
    records = (entry for _, entry in records_in(value, {}) if isinstance(entry, dict))
    return any(not _PROGRAMS.isdisjoint(named(entry, {})) for entry in records)


def is_record(value: dict[str, Any], given: FieldColumns) -> bool:
    """Return whether an object has a program or a description, by whatever name."""
    return not FIELDS.isdisjoint(named(value, given))


_OF_PLANNER = "plans of a planner, or names of its actions: no programs of the home"
FIELDS = frozenset({"steps", "text", "program", "description"})


def _is_steps(value: Any) -> bool:
    listed = value.split("\n") if isinstance(value, str) else value
    if not isinstance(listed, list) or not all(isinstance(step, str) or is_action(step) for step in listed):
        return False
    return (
        isinstance(value, list)
        or looks_like_mapping(value)
        or any(map(IN_LINE.match, listed))
        or is_plan(listed)
        or any(map(STEP.match, listed))
    )


def named(value: dict[str, Any], given: FieldColumns) -> dict[str, Any]:
    """Return a record with its fields by our names; those of others are guessed where ours are missing."""
    value = warned(with_step_lists(value), [*_out_of_order(value)])
    inside = {name: value_at(value, name) for name in given.values() if "." in name and name not in value}
    value = {**value, **{name: part for name, part in inside.items() if part is not None}}
    texts = [key for key, part in value.items() if isinstance(part, str) or (part and _is_steps(part))]
    found = guessed(texts, given, exact=True) if texts else {}
    if not _PROGRAM_KEYS & (found.keys() | given.keys() | value.keys()) and not all(map(_is_steps, value.values())):
        program = _key_of_steps({key: value[key] for key in texts if key not in found.values()})
        found.update({"program": program} if program else {})
    if "program" in found and "program" not in given and "steps" in texts:
        found["program"] = "steps"
    if "program" in found and not {"title", "description"} & (found.keys() | given.keys() | value.keys()):
        rest = [key for key in texts if key not in found.values() and is_line(value[key])]
        rest = [key for key in rest if not (is_condition(key, found) and is_formula(value[key]))]
        found.update({field: key for field, key in guessed(rest, {}).items() if field == "title"})
    if isinstance(given, Asked):
        given.note(value, found, texts)
    named = {field: value[name] for field, name in found.items() if field in given or field not in value}
    if "program" in given:
        value = {key: part for key, part in value.items() if key not in _PROGRAMS or key == given["program"]}
    if "steps" in value:
        named.pop("program", None)
    if "text" not in value or "text" in given.values():
        return {**value, **named}
    if "program" in named and not _is_steps(value["text"]):
        return {**{key: part for key, part in value.items() if key != "text"}, **named}
    return {**value, **{field: part for field, part in named.items() if field != "program" and found[field] != "text"}}


def _out_of_order(value: Mapping[str, Any]) -> Iterator[tuple[int, str, str]]:
    """Yield a warning for the first step of a record's list whose number is lower than the one above."""
    for part in value.values():
        numbers = numbers_of(part)
        for at, (before, number) in enumerate(itertools.pairwise(numbers), 1):
            if number < before:
                line = next((text.line for text in texts_in(part[at])), 0)
                yield line, f"step {number} stands below step {before}: {ORDERED}", IN_ORDER
                break


_PROGRAMS = frozenset({"steps", "program"})
_PROGRAM_KEYS = _PROGRAMS | {"text"}


def _key_of_steps(value: Mapping[str, Any]) -> str:
    """Return the key whose texts read as steps, of a record that no key names."""
    parts = {key: part if isinstance(part, list) else [part] for key, part in value.items()}
    return column_of_steps(
        {key: ["\n".join(part)] for key, part in parts.items() if all(isinstance(each, str) for each in part)}
    )
