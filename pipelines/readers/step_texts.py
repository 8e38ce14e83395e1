"""Texts that hold a plan as its steps, and steps as one text, with their places in the file."""

import re
from collections.abc import Mapping, Sequence

from hearth.kb.language.number_order import IN_ORDER, NumberOrder
from hearth.kb.language.plan_lines import plan_line
from hearth.pipelines.readers.json_actions import looks_like_mapping, mapped_steps
from hearth.pipelines.readers.texts_with_positions import Text, pieces_of

Places = list[list[int]] | None
"""Positions of the lines of a program's text in the file, as in `hearth.schemas.text_places`."""

IN_LINE = re.compile(r"\s*(?:plan|steps|answer)\s*:\s*1[.)]\s+\S.*\s2[.)]\s", re.IGNORECASE)
"""A whole plan on a line, as `Plan: 1. walk to kitchen 2. find milk`."""

SAID = re.compile(r"\s*(?:[\w'’]+\s+){0,3}(?:plan|steps|routine|actions)\s*:\s*(?=\S)", re.IGNORECASE)
"""The words before a plan on its line, as in `my plan: wake up, drink coffee`."""

_NUMBERS = re.compile(r"(?<!\S)\d{1,3}[.)]\s+")
_ENDS = frozenset({"done", "end", "stop", ""})
_QUOTED = re.compile(r"""'((?:[^'\\]|\\.)*+)'|"((?:[^"\\]|\\.)*+)\"""")
_IN_ONE_LINE = re.compile(
    r"(?<=[)\]}])[\s,;.]*(?=\[)|(?<=\S)\s+(?=\d{1,3}[.)]\s)|(?<!\s)\s*(?:;|->|→)\s*|(?<=[a-z]\.)\s+(?=[A-Z])"
)


def steps_of(text: str) -> list[str]:
    """Return the lines of a text.

    A single line gives its steps: a list, or separated by numbers, `;`, `->`, brackets, stops.

    Raises:
        HearthError: BAD_JSON, a mapping of actions to objects that is cut off.
    """
    if looks_like_mapping(text):
        return mapped_steps(text)
    enclosed = _IN_OBJECT.fullmatch(text.strip())
    if enclosed:
        return _quoted(text, enclosed[1])
    lines = text.strip().split("\n")
    in_line = next((line for line in lines if IN_LINE.match(line)), "")
    if in_line and not any(plan_line(line).number for line in lines if line != in_line):
        # The text before and below such a plan explains it.
        steps = [step.strip() for step in _NUMBERS.split(in_line)[1:]]
        return pieces_of(text, [step for step in steps if step.rstrip(".").lower() not in _ENDS])
    if len(lines) > 1:
        return pieces_of(text, text.split("\n"))
    if lines[0].startswith(('["', "['")):
        return _quoted(text, lines[0])
    said = SAID.match(lines[0])
    return pieces_of(text, [step for step in _IN_ONE_LINE.split(lines[0][said.end() if said else 0 :]) if step.strip()])


_IN_OBJECT = re.compile(
    r"\{\s*(?:\"\w+\"\s*:\s*\"[^\"]*\"\s*,\s*)*\"(?:plan|steps|actions|program|answer|response)\"\s*:\s*"
    r"\[(\s*\"[^{}]*\"\s*)\]\s*\}",
    re.IGNORECASE,
)
"""A list of steps in an object of JSON, as models answer that write JSON alone."""


def _quoted(text: str, listed: str) -> list[str]:
    """Return the texts in quotation marks of a list."""
    return pieces_of(text, [re.sub(r"\\(.)", r"\1", one or other) for one, other in _QUOTED.findall(listed)])


def numbered(listed: Sequence[str], words: Mapping[str, str | None]) -> tuple[str, Places]:
    """Return steps in words as a text with a title, and the places of its lines."""
    listed = [step for step in listed if step.strip()]
    title = words["title"] or _heading(listed)
    listed = listed if words["title"] or not title else listed[1:]
    top = f"Task: {title or 'Untitled'}\n{words['description'] or ''}".split("\n")
    found: list[str] = []
    places: list[list[int]] = []
    for step in listed:
        said = " ".join((plan_line(step).text or step).split())
        lead = f"Step {len(found) + 1}: "
        found.append(lead + said)
        places += places_of(pieces_of(step, [said])[0], len(lead))[:1]
    first = places[:1] or [[0, 1, 1]]
    return "\n".join([*top, *found]), [*first * len(top), *places] if any(
        isinstance(step, Text) for step in listed
    ) else None


def out_of_order(listed: Sequence[str]) -> list[tuple[int, str, str]]:
    """Return a warning for each step whose number does not follow the one above."""
    order = NumberOrder()
    numbered_lines = ((step, line) for step in listed if (line := plan_line(step)).numbered)
    faults = ((step, order.fault_of(line)) for step, line in numbered_lines)
    return [(step.line if isinstance(step, Text) else 0, fault, IN_ORDER) for step, fault in faults if fault]


def _heading(listed: Sequence[str]) -> str:
    """Return the heading above steps, `# Sweep the floor`; empty where the first text is none."""
    first = plan_line(listed[0]) if len(listed) > 1 else None
    return first.text if first and first.heading and first.number is None else ""


def places_of(text: str, skip: int) -> list[list[int]]:
    """Return the places of a text's lines; `skip` characters stand before the first on its line."""
    return text.places(skip) if isinstance(text, Text) else [[skip, 1, 1]] * (text.count("\n") + 1)
