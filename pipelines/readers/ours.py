"""Records of our own schema as JSON: JSON Lines, a list, or a single object."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import PurePath
from typing import Any

from hearth.datasets.format.ids import current_id
from hearth.datasets.format.splits import RULES
from hearth.kb.language.plan_lines import plan_line
from hearth.kb.language.program_lines import header as plan_header
from hearth.kb.language.program_lines import is_plan
from hearth.pipelines.readers import plans
from hearth.pipelines.readers.columns import FieldColumns, guessed
from hearth.pipelines.readers.document import document, parsed
from hearth.pipelines.readers.elements import entries
from hearth.pipelines.readers.item import Item, fault_of, home_of, lines, record, refused, suffixless, worker_hash
from hearth.pipelines.readers.release import graphs_of
from hearth.pipelines.readers.text import header
from hearth.schemas.blocks import STEP
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.numbers import stored
from hearth.schemas.program import ObjectRef, Program, Step
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


def scan(path: Place, place: str, given: FieldColumns) -> Iterator[Item]:
    """The items of each line that is not blank."""
    for number, (line, _) in enumerate(lines(path), 1):
        if line.strip():
            fault = fault_of(line, place, number)
            value = Reject((fault,)) if fault else parsed(line, place, number)
            yield from items(value, place, number, f"{place}:{number}", given)


def scan_document(path: Place, place: str, given: FieldColumns) -> Iterator[Item]:
    """The items of one value."""
    value = document(path, place)
    title = suffixless(PurePath(place).name).replace("_", " ")
    yield from items({"title": title, "steps": value} if isinstance(value, list) else value, place, 1, place, given)


def scan_list(path: Place, place: str, given: FieldColumns) -> Iterator[Item]:
    """The items of each entry of a list."""
    for number, (line, value) in enumerate(entries(path, place), 1):
        name = f"{place}[{number}]"
        yield from items(value, name, line if isinstance(value, Reject) else 0, name, given)


def items(value: Any, place: str, line: int, name: str, given: FieldColumns) -> Iterator[Item]:
    """One item for each record of a value."""
    found = list(records_in(value, given)) or [("", value)]
    for inside, entry in found:
        yield _item(entry, f"{place}{inside}", line, f"{name}{inside}", given)


def records_in(value: Any, given: FieldColumns, depth: int = 3) -> Iterator[tuple[str, Any]]:
    """The records of a JSON value with their places in it: itself, or those in the lists and objects that it holds.

    An object of programs by their titles holds a record for each.
    """
    if not isinstance(value, dict):
        return
    if is_record(value, given):
        yield "", value
    elif value and all(map(_is_steps, value.values())):
        for number, (title, steps) in enumerate(value.items(), 1):
            yield f"[{number}]", {"title": title, "steps" if isinstance(steps, list) else "program": steps}
    elif depth:
        for key, part in value.items():
            for number, entry in enumerate(part if isinstance(part, list) else [part], 1):
                for inside, record_in_it in records_in(entry, given, depth - 1):
                    yield f".{as_text(key)}[{number}]{inside}", record_in_it


def is_record(value: dict[str, Any], given: FieldColumns) -> bool:
    """Whether an object has a program or a description, by whatever name."""
    return not _FIELDS.isdisjoint(_named(value, given))


_FIELDS = frozenset({"steps", "text", "program", "description"})


def _is_steps(value: Any) -> bool:
    listed = value.split("\n") if isinstance(value, str) else value
    if not isinstance(listed, list) or not all(isinstance(step, str) for step in listed):
        return False
    return isinstance(value, list) or is_plan(listed) or any(map(STEP.match, listed))


def _named(value: dict[str, Any], given: FieldColumns) -> dict[str, Any]:
    """A record with its fields by our names; those of others are guessed where ours are missing."""
    texts = [key for key, part in value.items() if isinstance(part, str) or (part and _is_steps(part))]
    found = guessed(texts, given, exact=True) if texts else {}
    named = {field: value[name] for field, name in found.items() if field in given or field not in value}
    if "steps" in value:
        named.pop("program", None)
    if "text" not in value or "text" in given.values():
        return {**value, **named}
    if "program" in named and not _is_steps(value["text"]):
        return {**{key: part for key, part in value.items() if key != "text"}, **named}
    return {**value, **{field: part for field, part in named.items() if field != "program" and found[field] != "text"}}


def _item(value: Any, place: str, line: int, name: str, given: FieldColumns) -> Item:
    if isinstance(value, Reject):
        return refused(place, value, line=line)
    if isinstance(value, str):
        return plans.checked(value, 1, f"{plans.NAME}:{name}", name)
    if isinstance(value, list):
        value = {"steps": value}
    if not isinstance(value, dict):
        kind = type(value).__name__
        return refused(
            place, Reject.of(Code.BAD_JSON, f"a {kind}, not a record", file=place, line=line, suggestion=_FORM)
        )
    value = _named(value, given)
    own = current_id(str(value.get("program_id") or value.get("id") or ""))
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


def read(item: Item, salt: str = "") -> list[IngestedRow | Reject]:
    """The record of an item; with further descriptions, one record for each.

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
    except (TypeError, ValueError, KeyError, AttributeError) as error:
        message = f"not a record of ours: {error}"
        return [Reject.of(Code.BAD_JSON, message, file=item.place, line=item.line, suggestion=_FORM)]


def _row(item: Item, value: Mapping[str, Any], salt: str) -> IngestedRow | Reject:
    words = {name: _word(value, name) for name in _WORDS}
    text, in_sentences = _text(value, words)
    kind = "program" if text else "description"
    if not text and not words["description"]:
        message = f"neither steps nor a description; its keys are {', '.join(map(as_text, value))[:200] or 'none'}"
        return Reject.of(Code.EMPTY, message, file=item.place, line=item.line, suggestion=_FORM)
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
        origin=plans.NAME if in_sentences else origin if origin in _ORIGINS else NAME,
        description_id=current_id(words["description_id"] or ""),
        scene=words["scene"],
        worker=worker_hash(words["worker"], salt) if words["worker"] else None,
        platform=words["platform"],
        style=words["style"],
        rooms=_quantities(value.get("rooms")),
        props=_quantities(value.get("props")),
        text=text or None,
        line=item.line - 1 if item.line else None,
    )


def _placed(item: Item, row: IngestedRow, value: Mapping[str, Any]) -> Iterator[IngestedRow | Reject]:
    """The row with its parts in splits of its source, as `{"pairs": "test", "tasks": null}`; faulty ones are refused
    alone.
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
    """The row with the graph in which its program runs, if it has one; a faulty graph is refused alone."""
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
    return found.strip() if found else None


def _text(value: Mapping[str, Any], words: Mapping[str, str | None]) -> tuple[str, bool]:
    """The program's text, and whether it has natural-language steps."""
    steps = value.get("steps")
    if steps is None and isinstance(value.get("program"), list):
        steps = value["program"]
    text = "" if steps is not None else _word(value, "text") or _word(value, "program") or ""
    listed = steps_of(text) if steps is None else steps
    if not isinstance(listed, list):
        raise TypeError(f"`steps` is {type(steps).__name__}, not a list")
    if not all(isinstance(step, str) for step in listed):
        return "".join(f"{line}\n" for line in print_lines(Program(steps=tuple(map(_step, listed))))), False
    text = text if listed == text.split("\n") else "\n".join(listed)
    in_sentences = bool(text.strip()) and (is_plan(listed) or not any(map(STEP.match, listed)))
    if in_sentences and (steps is not None or not is_plan(listed)):
        words_of = (plan_line(step).text or step for step in listed if step.strip())
        numbered = [f"Step {number}: {' '.join(step.split())}" for number, step in enumerate(words_of, 1)]
        text = "\n".join([f"Task: {words['title'] or 'Untitled'}", words["description"] or "", *numbered])
    return (text.rstrip("\n") + "\n" if text.strip() else ""), in_sentences


_QUOTED = re.compile(r"""'((?:[^'\\]|\\.)*+)'|"((?:[^"\\]|\\.)*+)\"""")
_IN_ONE_LINE = re.compile(
    r"(?<=[)\]}])[\s,;.]*(?=\[)|(?<=\S)\s+(?=\d{1,3}[.)]\s)|(?<!\s)\s*(?:;|->|→)\s*|(?<=[a-z]\.)\s+(?=[A-Z])"
)


def steps_of(text: str) -> list[str]:
    """The lines of a text; of a single line its steps: a list, or separated by numbers, `;`, `->`, brackets, stops."""
    lines = text.strip().split("\n")
    if len(lines) > 1:
        return text.split("\n")
    if lines[0].startswith(('["', "['")):
        return [re.sub(r"\\(.)", r"\1", one or other) for one, other in _QUOTED.findall(lines[0])]
    return [step for step in _IN_ONE_LINE.split(lines[0]) if step.strip()]


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
