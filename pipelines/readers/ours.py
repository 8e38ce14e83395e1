"""Records of our own schema as JSON: JSON Lines, a list, or a single object."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from hearth.pipelines.readers import plans
from hearth.pipelines.readers.document import document, parsed
from hearth.pipelines.readers.elements import entries
from hearth.pipelines.readers.item import Item, fault_of, lines, record, refused
from hearth.pipelines.readers.text import header
from hearth.schemas.blocks import STEP
from hearth.schemas.failures import Code
from hearth.schemas.numbers import stored
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.rows import IngestedRow, QuantityRow
from hearth.schemas.syntax import normal_name, print_lines
from hearth.storage.archives import Place
from hearth.storage.names import leaves
from hearth.storage.rejects import Reject

NAME = "records"

_WORDS = ("title", "description", "scene", "worker", "platform", "description_id")
_FORM = 'a record is {"title": ..., "description": ..., "steps": ["[Walk] <bed> (1)", ...]}, or has `text` for `steps`'
_ORIGINS = frozenset({"crowd", "release", "text", "spoken", "synthetic", "augmented", NAME})


def scan(path: Place, place: str) -> Iterator[Item]:
    """One item for each line that is not blank."""
    for number, (line, _) in enumerate(lines(path), 1):
        if line.strip():
            fault = fault_of(line, place, number)
            value = Reject((fault,)) if fault else parsed(line, place, number)
            yield _item(value, place, number, f"{place}:{number}")


def scan_document(path: Place, place: str) -> Iterator[Item]:
    """One item: the record of an object."""
    yield _item(document(path, place), place, 1, place)


def scan_list(path: Place, place: str) -> Iterator[Item]:
    """One item for each entry of a list."""
    for number, (line, value) in enumerate(entries(path, place), 1):
        yield _item(value, f"{place}[{number}]", line if isinstance(value, Reject) else 0, f"{place}[{number}]")


def _item(value: Any, place: str, line: int, name: str) -> Item:
    if isinstance(value, Reject):
        return refused(place, value, line=line)
    if isinstance(value, str):
        return plans.checked(value, 1, f"{plans.NAME}:{name}", name)
    if not isinstance(value, dict):
        kind = type(value).__name__
        return refused(
            place, Reject.of(Code.BAD_JSON, f"a {kind}, not a record", file=place, line=line, suggestion=_FORM)
        )
    own = str(value.get("program_id") or value.get("id") or "")
    fault = id_fault(own, place, line)
    if fault:
        return refused(place, fault, line=line)
    return Item(own or f"{NAME}:{name}", NAME, place, value, line=line)


def id_fault(own: str, place: str, line: int = 0) -> Reject | None:
    """Why an id that comes with a record is not taken."""
    if not any(map(leaves, own.split(":"))) and own.isprintable():
        return None
    message = "an id that is a path out of its folder, or not printable"
    suggestion = "letters, digits and `-_./:#`, without `..`"
    found = ascii(own)[:60]
    return Reject.of(Code.BAD_JSON, message, file=place, line=line, found=found, suggestion=suggestion)


def read(item: Item) -> list[IngestedRow | Reject]:
    """The record of an item; with further descriptions, one record for each."""
    value: Mapping[str, Any] = item.value
    try:
        row = _row(item, value)
        return [row] if isinstance(row, Reject) else [row, *_others(item, row, value)]
    except (TypeError, ValueError, KeyError, AttributeError) as error:
        message = f"not a record of ours: {error}"
        return [Reject.of(Code.BAD_JSON, message, file=item.place, line=item.line, suggestion=_FORM)]


def _row(item: Item, value: Mapping[str, Any]) -> IngestedRow | Reject:
    words = {name: _word(value, name) for name in _WORDS}
    text, in_sentences = _text(value, words)
    kind = "program" if text else "description"
    if not text and not words["description"]:
        message = "neither steps nor a description"
        return Reject.of(Code.EMPTY, message, file=item.place, line=item.line, suggestion=_FORM)
    title, description = header(text) if text and not in_sentences and "steps" not in value else ("", "")
    origin = _word(value, "origin") or NAME
    return record(
        item,
        kind,
        words["title"] or title,
        words["description"] or description,
        origin=plans.NAME if in_sentences else origin if origin in _ORIGINS else NAME,
        description_id=words["description_id"] or "",
        scene=words["scene"],
        worker=words["worker"],
        platform=words["platform"],
        rooms=_quantities(value.get("rooms")),
        props=_quantities(value.get("props")),
        text=text or None,
        line=max(item.line - 1, 0),
    )


def _others(item: Item, row: IngestedRow, value: Mapping[str, Any]) -> Iterator[IngestedRow]:
    """Further descriptions of the same program."""
    kept: Any = {key: row[key] for key in ("origin", "scene", "worker", "platform", "line")}
    for number, text in enumerate(value.get("descriptions") or (), 2):
        other = replace(item, record_id=f"{row['program_id']}~{number}")
        yield record(other, "description", row["title"], str(text), **kept)


def _word(value: Mapping[str, Any], name: str) -> str | None:
    found = value.get(name)
    if found is not None and not isinstance(found, str):
        raise TypeError(f"`{name}` is {type(found).__name__}, not text")
    return found.strip() if found else None


def _text(value: Mapping[str, Any], words: Mapping[str, str | None]) -> tuple[str, bool]:
    """The program's text, and whether it has natural-language steps."""
    steps = value.get("steps")
    if steps is None:
        text = _word(value, "text") or _word(value, "program") or ""
        listed = text.split("\n")
    elif isinstance(steps, list) and all(isinstance(step, str) for step in steps):
        listed, text = steps, "\n".join(steps)
    elif isinstance(steps, list):
        return "".join(f"{line}\n" for line in print_lines(Program(steps=tuple(map(_step, steps))))), False
    else:
        raise TypeError(f"`steps` is {type(steps).__name__}, not a list")
    in_sentences = bool(text.strip()) and not any(STEP.match(line) for line in listed)
    if in_sentences and steps is not None:
        numbered = [f"Step {number}: {' '.join(step.split())}" for number, step in enumerate(listed, 1)]
        text = "\n".join([f"Task: {words['title'] or 'Untitled'}", words["description"] or "", *numbered])
    return (text.rstrip("\n") + "\n" if text.strip() else ""), in_sentences


def _step(value: Mapping[str, Any]) -> Step:
    """A step from a published row."""
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
