"""Records of our own schema as JSON: JSON Lines, a list, or a single object."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import PurePath
from typing import Any

from hearth.datasets.format.ids import current_id
from hearth.datasets.format.splits import RULES
from hearth.kb.language.plan_lines import plan_line
from hearth.kb.language.program_lines import header as plan_header
from hearth.kb.language.program_lines import is_plan
from hearth.pipelines.readers import plans
from hearth.pipelines.readers.actions import is_action, looks_like_mapping, mapped_steps, of_planner, step_of
from hearth.pipelines.readers.columns import Asked, FieldColumns, guessed, lacks, value_at
from hearth.pipelines.readers.document import located, located_document
from hearth.pipelines.readers.elements import located_entries
from hearth.pipelines.readers.item import Item, fault_of, home_of, lines, record, refused, suffixless, worker_hash
from hearth.pipelines.readers.located import Located, Text, pieces_of, texts_in
from hearth.pipelines.readers.models import of_others
from hearth.pipelines.readers.release import graphs_of
from hearth.pipelines.readers.text import header
from hearth.schemas.blocks import STEP
from hearth.schemas.diagnostics import Diagnostic, HearthError
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

Places = list[list[int]] | None
"""Where the lines of a program's text stand in the file, as in `hearth.schemas.text_places`."""

_PLAIN = re.compile(r"[A-Za-z0-9_-]{1,60}", re.ASCII)
MOST_SPLITS = 20
"""Splits that a record may name: each has a row for every run."""

_WORDS = ("title", "description", "scene", "worker", "platform", "style", "description_id")
_FORM = 'a record is {"title": ..., "description": ..., "steps": ["[Walk] <bed> (1)", ...]}, or has `text` for `steps`'
_ORIGINS = frozenset({"written", "crowd", "release", "text", "spoken", "synthetic", "augmented", NAME})


def scan(path: Place, place: str, asked: Asked) -> Iterator[Item]:
    """The items of each line that is not blank."""
    for number, (line, _) in enumerate(lines(path), 1):
        if line.strip():
            fault = fault_of(line, place, number)
            value = Reject((fault,)) if fault else located(line, place, number)
            yield from items(value, place, number, f"{place}:{number}", asked)
    yield from absent(asked, place)


def scan_document(path: Place, place: str, asked: Asked) -> Iterator[Item]:
    """The items of one value."""
    found = located_document(path, place)
    if isinstance(found, Located) and isinstance(found.value, list):
        found.value = {"title": suffixless(PurePath(place).name).replace("_", " "), "steps": found.value}
    yield from items(found, place, 1, place, asked)
    yield from absent(asked, place)


def absent(asked: Asked, place: str) -> Iterator[Item]:
    """The fault of each column that `--columns` names and no record has."""
    for field, name in asked.absent() if asked.names else ():
        yield refused(place, lacks(field, name, asked.names, place), f"{place}~{name}")


def scan_list(path: Place, place: str, asked: Asked) -> Iterator[Item]:
    """The items of each entry of a list."""
    for number, (line, value) in enumerate(located_entries(path, place), 1):
        yield from items(value, place, line, f"{place}[{number}]", asked)
    yield from absent(asked, place)


def items(found: Any, place: str, line: int, name: str, given: FieldColumns) -> Iterator[Item]:
    """One item for each record of a value, which may be `Located`."""
    value = found.value if isinstance(found, Located) else found
    for inside, entry in list(records_in(value, given)) or [("", value)]:
        first = found.line_of(entry) if isinstance(found, Located) else line
        yield _item(entry, place, first, f"{name}{inside}", given)


def records_in(value: Any, given: FieldColumns, depth: int = 3) -> Iterator[tuple[str, Any]]:
    """The records of a JSON value with their places in it: itself, or those in the lists and objects that it holds.

    An object of programs by their titles holds a record for each.
    """
    if not isinstance(value, dict):
        return
    other = of_others(value)
    if other is not None:
        yield "", other
    elif of_planner(value.values()):
        yield "", Reject.of(Code.UNSUPPORTED_FILE, _OF_PLANNER, suggestion="write steps as [Walk] <shower> (1)")
    elif is_record(value, given):
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


_OF_PLANNER = "plans of a planner, or names of its actions: no programs of the home"
_KEYS = "keys of the record"
_FIELDS = frozenset({"steps", "text", "program", "description"})


def _is_steps(value: Any) -> bool:
    listed = value.split("\n") if isinstance(value, str) else value
    if not isinstance(listed, list) or not all(isinstance(step, str) or is_action(step) for step in listed):
        return False
    return (
        isinstance(value, list)
        or looks_like_mapping(value)
        or any(map(_IN_LINE.match, listed))
        or is_plan(listed)
        or any(map(STEP.match, listed))
    )


def _named(value: dict[str, Any], given: FieldColumns) -> dict[str, Any]:
    """A record with its fields by our names; those of others are guessed where ours are missing."""
    inside = {name: value_at(value, name) for name in given.values() if "." in name and name not in value}
    value = {**value, **{name: part for name, part in inside.items() if part is not None}}
    texts = [key for key, part in value.items() if isinstance(part, str) or (part and _is_steps(part))]
    found = guessed(texts, given, exact=True) if texts else {}
    if "program" in found and "program" not in given and "steps" in texts:
        found["program"] = "steps"
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


_PROGRAMS = frozenset({"steps", "program"})


def _item(value: Any, place: str, line: int, name: str, given: FieldColumns) -> Item:
    if isinstance(value, Reject):
        faults = (replace(fault, line=fault.line or line) for fault in value.diagnostics)
        return refused(place, Reject.because(faults, place), name, line)
    if isinstance(value, str):
        return plans.checked(value, line, f"{plans.NAME}:{name}", place)
    if isinstance(value, list):
        value = {"steps": value}
    if not isinstance(value, dict):
        kind = type(value).__name__
        fault = Reject.of(Code.BAD_JSON, f"a {kind}, not a record", file=place, line=line, suggestion=_FORM)
        return refused(place, fault, name, line)
    keys = [*value]
    value = _named(value, given)
    if _FIELDS.isdisjoint(value):
        value[_KEYS] = keys
    own = current_id(str(value.get("program_id") or value.get("id") or ""))
    wrong = id_fault(own, place, line)
    if wrong:
        return refused(place, wrong, name, line)
    return Item(own or f"{NAME}:{name}", NAME, place, value, _version(value), line=line)


def _version(value: dict[str, Any]) -> str:
    """What changes when the places of a record's program do."""
    texts = (value[key] for key in ("steps", "program", "text") if key in value)
    found = [f"{text.line}.{text.column}.{len(text.raw)}" for text in texts_in(list(texts))]
    return " ".join(found[:1] + found[-1:])


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
    except HearthError as error:
        return [Reject.because(error.diagnostics, item.place)]
    except (TypeError, ValueError, KeyError, AttributeError) as error:
        message = f"not a record of ours: {error}"
        return [Reject.of(Code.BAD_JSON, message, file=item.place, line=item.line, suggestion=_FORM)]


def _row(item: Item, value: Mapping[str, Any], salt: str) -> IngestedRow | Reject:
    words = {name: _word(value, name) for name in _WORDS}
    text, in_sentences, places = _text(value, words)
    kind = "program" if text else "description"
    if not text and not words["description"]:
        keys = ", ".join(as_text(key) for key in value.get(_KEYS, value))[:200] or "none"
        message = f"neither steps nor a description; its keys are {keys}"
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
        places=places,
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
    return pieces_of(found, [found.strip()])[0] if found else None


def _text(value: Mapping[str, Any], words: Mapping[str, str | None]) -> tuple[str, bool, Places]:
    """The program's text, whether it has natural-language steps, and the places of its lines."""
    steps = value.get("steps")
    if steps is None and isinstance(value.get("program"), list):
        steps = value["program"]
    text = "" if steps is not None else _word(value, "text") or _word(value, "program") or ""
    listed: Any = steps_of(text) if steps is None else steps
    if not isinstance(listed, list):
        raise TypeError(f"`steps` is {type(steps).__name__}, not a list")
    listed = [step_of(step) if is_action(step) else step for step in listed]
    if not all(isinstance(step, str) for step in listed):
        program = Program(steps=tuple(_step(step) for step in listed))
        return "".join(f"{line}\n" for line in print_lines(program)), False, None
    text = text if listed == text.split("\n") else "\n".join(listed)
    in_sentences = bool(text.strip()) and (is_plan(listed) or not any(map(STEP.match, listed)))
    places = None
    if in_sentences and (steps is not None or not is_plan(listed)):
        text, places = _numbered(listed, words)
    elif any(isinstance(step, Text) for step in listed):
        places = [place for step in listed for place in _places_of(step, 0)]
    return (text.rstrip("\n") + "\n" if text.strip() else ""), in_sentences, places


def _numbered(listed: Sequence[str], words: Mapping[str, str | None]) -> tuple[str, Places]:
    """Steps in words as a text with a title, and the places of its lines."""
    top = f"Task: {words['title'] or 'Untitled'}\n{words['description'] or ''}".split("\n")
    found: list[str] = []
    places: list[list[int]] = []
    for step in listed:
        if step.strip():
            said = " ".join((plan_line(step).text or step).split())
            lead = f"Step {len(found) + 1}: "
            found.append(lead + said)
            places += _places_of(pieces_of(step, [said])[0], len(lead))[:1]
    first = places[:1] or [[0, 1, 1]]
    return "\n".join([*top, *found]), [*first * len(top), *places] if any(
        isinstance(step, Text) for step in listed
    ) else None


def _places_of(text: str, skip: int) -> list[list[int]]:
    return text.places(skip) if isinstance(text, Text) else [[skip, 1, 1]] * (text.count("\n") + 1)


_IN_LINE = re.compile(r"\s*(?:plan|steps|answer)\s*:\s*1[.)]\s+\S.*\s2[.)]\s", re.IGNORECASE)
"""A whole plan on a line, as `Plan: 1. walk to kitchen 2. find milk`."""

_NUMBERS = re.compile(r"(?<!\S)\d{1,3}[.)]\s+")
_ENDS = frozenset({"done", "end", "stop", ""})
_QUOTED = re.compile(r"""'((?:[^'\\]|\\.)*+)'|"((?:[^"\\]|\\.)*+)\"""")
_IN_ONE_LINE = re.compile(
    r"(?<=[)\]}])[\s,;.]*(?=\[)|(?<=\S)\s+(?=\d{1,3}[.)]\s)|(?<!\s)\s*(?:;|->|→)\s*|(?<=[a-z]\.)\s+(?=[A-Z])"
)


def steps_of(text: str) -> list[str]:
    """The lines of a text; of a single line its steps: a list, or separated by numbers, `;`, `->`, brackets, stops.

    Raises:
        HearthError: BAD_JSON, a mapping of actions to objects that is cut off.
    """
    if looks_like_mapping(text):
        return mapped_steps(text)
    lines = text.strip().split("\n")
    in_line = next((line for line in lines if _IN_LINE.match(line)), "")
    if in_line and not any(plan_line(line).number for line in lines if line != in_line):
        # What is said before and below such a plan explains it.
        steps = [step.strip() for step in _NUMBERS.split(in_line)[1:]]
        return pieces_of(text, [step for step in steps if step.rstrip(".").lower() not in _ENDS])
    if len(lines) > 1:
        return pieces_of(text, text.split("\n"))
    if lines[0].startswith(('["', "['")):
        return pieces_of(text, [re.sub(r"\\(.)", r"\1", one or other) for one, other in _QUOTED.findall(lines[0])])
    return pieces_of(text, [step for step in _IN_ONE_LINE.split(lines[0]) if step.strip()])


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
