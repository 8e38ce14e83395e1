"""Records of our own schema as JSON: JSON Lines, a list, or a single object."""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import PurePath
from typing import Any

from hearth.datasets.format.ids import current_id
from hearth.datasets.format.splits import RULES
from hearth.kb.language.forms.code_calls import CODE
from hearth.kb.language.program_lines import header as plan_header
from hearth.kb.language.program_lines import is_plan, is_unmarked, reading_of
from hearth.pipelines.readers import natural_language_plans, reader_warnings
from hearth.pipelines.readers.field_columns import Asked, FieldColumns, guessed, lacks
from hearth.pipelines.readers.json_actions import is_action, step_of
from hearth.pipelines.readers.json_documents import located, located_document
from hearth.pipelines.readers.json_elements import located_entries
from hearth.pipelines.readers.model_outputs import is_message
from hearth.pipelines.readers.program_text import header
from hearth.pipelines.readers.reader_items import (
    Item,
    fault_of,
    home_of,
    lines,
    record,
    refused,
    suffixless,
    worker_hash,
)
from hearth.pipelines.readers.records_in_json import FIELDS, Converted, named, records_in
from hearth.pipelines.readers.release import graphs_of
from hearth.pipelines.readers.step_rows import joined, row_of_json
from hearth.pipelines.readers.step_rows_by_task import Entry
from hearth.pipelines.readers.step_texts import Places, numbered, out_of_order, places_of, steps_of
from hearth.pipelines.readers.texts_with_positions import Located, Text, pieces_of, texts_in
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.numbers import stored
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.program_boundaries import STEP
from hearth.schemas.row_types import QuantityRow
from hearth.schemas.stage_rows import IngestedRow, WrittenGroundingRow
from hearth.schemas.syntax import normal_name, print_lines
from hearth.storage.archives import Place
from hearth.storage.names import leaves
from hearth.storage.rejects import Reject, as_text

NAME = "records"

_PLAIN = re.compile(r"[A-Za-z0-9_-]{1,60}", re.ASCII)
MOST_SPLITS = 20
"""Splits that a record may name: each has a row for every run."""

_WORDS = ("title", "description", "scene", "worker", "platform", "style", "description_id")
_FORM = 'a record is {"title": ..., "description": ..., "steps": ["[Walk] <bed> (1)", ...]}, or has `text` for `steps`'
_ORIGINS = frozenset({"written", "crowd", "release", "text", "spoken", "synthetic", "augmented", NAME})


def scan(path: Place, place: str, asked: Asked) -> Iterator[Item]:
    """Yield the items of each line that is not blank."""
    yield from of_entries(_lines(path, place), place, asked)


def _lines(path: Place, place: str) -> Iterator[Entry]:
    for number, (line, _) in enumerate(lines(path), 1):
        if line.strip():
            fault = fault_of(line, place, number)
            yield Entry(Reject((fault,)) if fault else located(line, place, number), number, f"{place}:{number}")


def of_entries(entries: Iterable[Entry], place: str, asked: Asked) -> Iterator[Item]:
    """Yield the items of the records of a file, of which several may be the steps of one program."""
    for value, line, name in joined(_talks(entries), lambda value: row_of_json(value, asked)):
        yield from items(value, place, line, name, asked)
    yield from absent(asked, place)


def _talks(entries: Iterable[Entry]) -> Iterator[Entry]:
    """Yield the entries, messages that follow each other as one chat."""
    talk: list[Entry] = []
    for entry in entries:
        value = entry.value.value if isinstance(entry.value, Located) else entry.value
        if is_message(value):
            talk.append(entry._replace(value=value))
            continue
        yield from _talk(talk)
        talk = []
        yield entry
    yield from _talk(talk)


def _talk(talk: list[Entry]) -> Iterator[Entry]:
    """Yield messages as a chat; one alone as it is."""
    if len(talk) > 1:
        yield talk[0]._replace(value={"messages": [each.value for each in talk]})
    else:
        yield from talk


def scan_document(path: Place, place: str, asked: Asked) -> Iterator[Item]:
    """Yield the items of one value."""
    found = located_document(path, place)
    if isinstance(found, Located) and isinstance(found.value, list):
        found.value = {"title": suffixless(PurePath(place).name).replace("_", " "), "steps": found.value}
    yield from items(found, place, 1, place, asked)
    yield from absent(asked, place)


def absent(asked: Asked, place: str) -> Iterator[Item]:
    """Yield the fault of each column that `--columns` names and no record has."""
    for field, name in asked.absent() if asked.names else ():
        yield refused(place, lacks(field, name, asked.names, place), f"{place}~{name}")


def scan_list(path: Place, place: str, asked: Asked) -> Iterator[Item]:
    """Yield the items of each entry of a list."""
    entries = enumerate(located_entries(path, place), 1)
    yield from of_entries((Entry(value, line, f"{place}[{number}]") for number, (line, value) in entries), place, asked)


def items(found: Any, place: str, line: int, name: str, given: FieldColumns) -> Iterator[Item]:
    """One item for each record of a value, which may be `Located`."""
    value = found.value if isinstance(found, Located) else found
    for inside, entry in list(records_in(value, given)) or [("", value)]:
        first = found.line_of(entry) if isinstance(found, Located) else line
        yield _item(entry, place, first, f"{name}{inside}", given)


_KEYS = "keys of the record"


def _item(value: Any, place: str, line: int, name: str, given: FieldColumns) -> Item:
    if isinstance(value, Reject):
        faults = (replace(fault, line=fault.line or line) for fault in value.diagnostics)
        return refused(place, Reject.because(faults, place), name, line)
    if isinstance(value, str):
        return natural_language_plans.checked(value, line, f"{natural_language_plans.NAME}:{name}", place)
    if isinstance(value, list):
        value = {"steps": value}
    if not isinstance(value, dict):
        kind = type(value).__name__
        fault = Reject.of(Code.BAD_JSON, f"a {kind}, not a record", file=place, line=line, suggestion=_FORM)
        return refused(place, fault, name, line)
    keys = value.keys_of_file if isinstance(value, Converted) else [*value]
    value = named(value, given)
    if all(_is_blank(value.get(field)) for field in FIELDS):
        value[_KEYS] = keys
    own = current_id(str(value.get("program_id") or value.get("id") or ""))
    wrong = id_fault(own, place, line)
    if wrong:
        return refused(place, wrong, name, line)
    return Item(own or f"{NAME}:{name}", NAME, place, value, _version(value), line=line)


def _is_blank(part: Any) -> bool:
    return not part or (isinstance(part, str) and not part.strip())


def _version(value: dict[str, Any]) -> str:
    """Return a text that changes when the places of a record's program do."""
    texts = (value[key] for key in ("steps", "program", "text") if key in value)
    found = [f"{text.line}.{text.column}.{len(text.raw)}" for text in texts_in(list(texts))]
    return " ".join(found[:1] + found[-1:])


def id_fault(own: str, place: str, line: int = 0) -> Reject | None:
    """Return why an id that comes with a record is not taken."""
    if not any(map(leaves, own.split(":"))) and own.isprintable():
        return None
    message = "an id that is a path out of its folder, or not printable"
    suggestion = "letters, digits and `-_./:#`, without `..`"
    found = ascii(own)[:60]
    return Reject.of(Code.BAD_JSON, message, file=place, line=line, found=found, suggestion=suggestion)


def read(item: Item, salt: str = "") -> list[IngestedRow | Reject]:
    """Return the record of an item; with further descriptions, one record for each.

    Args:
        item: as scanned.
        salt: for the hash of a worker's id.
    """
    value: Mapping[str, Any] = item.value
    try:
        row = _row(item, value, salt)
        if isinstance(row, Reject):
            return [row]
        first, *faults = _placed(item, row, value)
        assert not isinstance(first, Reject)
        return [*_grounded(item, first, value), *faults, *_others(item, first, value)]
    except HearthError as error:
        return [Reject.because(error.diagnostics, item.place)]
    except (TypeError, ValueError, KeyError, AttributeError) as error:
        message = f"not a record of ours: {error}"
        return [Reject.of(Code.BAD_JSON, message, file=item.place, line=item.line, suggestion=_FORM)]


def _row(item: Item, value: Mapping[str, Any], salt: str) -> IngestedRow | Reject:
    words = {name: _word(value, name) for name in _WORDS}
    text, in_sentences, places, order = _text(value, words)
    kind = "program" if text else "description"
    if not text and not words["description"]:
        names = [as_text(key) for key in value.get(_KEYS, value)]
        empty = guessed(names, {}).get("program")
        lacks_plan = f"`{empty}` is empty: " if empty and _is_blank(value.get(empty)) else ""
        message = f"{lacks_plan}neither steps nor a description; its keys are {', '.join(names)[:200] or 'none'}"
        blank = empty if lacks_plan and empty else ""
        return Reject.of(Code.EMPTY, message, file=item.place, line=item.line, found=blank, suggestion=_FORM)
    top = header if not in_sentences else plan_header
    title, description = top(text) if text and "steps" not in value else ("", "")
    origin = _word(value, "origin") or NAME
    if origin == "crowd" and item.record_id.startswith("written:"):  # the embedded corpus, as 0.1 published it
        origin, words["worker"], words["platform"] = "written", None, None
    return record(
        item,
        kind,
        words["title"] or title,
        words["description"] or description,
        origin=natural_language_plans.NAME if in_sentences else origin if origin in _ORIGINS else NAME,
        description_id=current_id(words["description_id"] or ""),
        scene=words["scene"],
        worker=worker_hash(words["worker"], salt) if words["worker"] else None,
        platform=words["platform"],
        style=words["style"],
        rooms=_quantities(value.get("rooms")),
        props=_quantities(value.get("props")),
        text=text or None,
        line=item.line - 1 if item.line else None,
        places=places,
        warnings=reader_warnings.rows_of(reader_warnings.warned(value, order).get(reader_warnings.KEY)),
    )


def _placed(item: Item, row: IngestedRow, value: Mapping[str, Any]) -> Iterator[IngestedRow | Reject]:
    """Yield the row with its parts in splits of its source, as `{"pairs": "test", "tasks": null}`; faulty ones are
    refused alone.
    """
    given = value.get("splits")
    if row["kind"] != "program" or not isinstance(given, Mapping) or not given:
        yield row
        return
    names = (*given, *(part for part in given.values() if part is not None))
    wrong = [f"there are {len(given):,}, more than {MOST_SPLITS}"] if len(given) > MOST_SPLITS else []
    odd = (name for name in names if not isinstance(name, str) or not _PLAIN.fullmatch(name))
    wrong += (f"`{as_text(name)[:40]}` is not a name" for name in odd)
    wrong += (f"`{name}` is a split that publishing makes" for name in sorted(RULES.keys() & given.keys()))
    if wrong:
        message, remedy = f"splits of a record: {wrong[0]}", "letters, digits, `_` and `-`; names that are not taken"
        yield row
        yield Reject.of(Code.BAD_JSON, message, file=item.place, line=item.line, suggestion=remedy)
        return
    yield {**row, "parts": [{"split": split, "part": part} for split, part in sorted(given.items())]}


def _grounded(item: Item, row: IngestedRow, value: Mapping[str, Any]) -> Iterator[IngestedRow | Reject]:
    """Yield the row with the graph in which its program runs, if it has one; a faulty graph is refused alone."""
    if row["kind"] != "program" or "init_graph" not in value:
        yield row
        return
    home = (_word(value, "home") or home_of(item.place)).removesuffix("_graph")
    fault, found = id_fault(home, item.place), graphs_of(value, item.place)
    if fault or isinstance(found, Diagnostic):
        yield row
        yield fault or Reject((found,))  # type: ignore[arg-type]
        return
    start, final = found
    grounding: WrittenGroundingRow = {"home": home, "text": row["text"] or "", "start": start, "final": final}
    yield {**row, "groundings": [grounding]}


def _others(item: Item, row: IngestedRow, value: Mapping[str, Any]) -> Iterator[IngestedRow]:
    """Further descriptions of the same program."""
    kept: Any = {key: row[key] for key in ("origin", "scene", "worker", "platform", "style", "line")}
    for number, text in enumerate(value.get("descriptions") or (), 2):
        other = replace(item, record_id=f"{row['program_id']}~{number}")
        yield record(other, "description", row["title"], str(text), **kept)


def _word(value: Mapping[str, Any], name: str) -> str | None:
    found = value.get(name)
    if found is not None and not isinstance(found, str):
        raise TypeError(f"`{name}` is {type(found).__name__}, not text")
    return pieces_of(found, [found.strip()])[0] if found else None


_TEXTS = ("steps", "text", "program")


Order = list[tuple[int, str, str]]
"""Warnings of the numbers before steps."""


def _text(value: Mapping[str, Any], words: Mapping[str, str | None]) -> tuple[str, bool, Places, Order]:
    """Return the program's text, whether it has steps in words, the places of its lines, and faults of numbers."""
    steps = next((value[key] for key in ("steps", "program") if isinstance(value.get(key), list)), None)
    text = "" if steps is not None else next((word for key in _TEXTS if (word := _word(value, key))), "")
    listed: Any = steps_of(text) if steps is None else steps
    has_actions = any(map(is_action, listed))
    listed = [step_of(step) if is_action(step) else step for step in listed]
    if not all(isinstance(step, str) for step in listed):
        program = Program(steps=tuple(_step(step) for step in listed))
        return "".join(f"{line}\n" for line in print_lines(program)), False, None, []
    text = text if listed == text.split("\n") else "\n".join(listed)
    is_mixed = (
        steps is not None and (has_actions or "steps" in value) and not all(map(STEP.match, filter(None, listed)))
    )
    in_sentences = bool(text.strip()) and (is_mixed or is_plan(listed) or not any(map(STEP.match, listed)))
    places, order = None, []
    is_code = steps is None and in_sentences and reading_of(listed)[1] is CODE
    if in_sentences and not is_code and (steps is not None or not is_plan(listed) or is_unmarked(listed)):
        text, places = numbered(listed, words)
        order = out_of_order(listed)
    elif any(isinstance(step, Text) for step in listed):
        places = [place for step in listed for place in places_of(step, 0)]
    return (text.rstrip("\n") + "\n" if text.strip() else ""), in_sentences, places, order


def _step(value: Mapping[str, Any]) -> Step:
    """Return a step from a published row."""
    objects = tuple(
        ObjectRef(normal_name(str(ref["name"])), int(ref.get("instance") or 1), None)
        for ref in value.get("objects") or ()
    )
    modifiers = tuple((str(pair["name"]), str(pair["value"])) for pair in value.get("modifiers") or ())
    return Step(str(value["action"]), objects, int(value.get("agent") or 0), bool(value.get("joins")), modifiers)


def _quantities(found: Any) -> list[QuantityRow]:
    return [
        {"name": normal_name(str(one["name"])), "quantity": stored(one.get("quantity") or 1)} for one in found or ()
    ]
