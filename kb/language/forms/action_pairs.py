"""Actions in capitals before their objects: `WALK kitchen`, `PUTBACK plate table`, `WALK: kitchen`, `PUT|cup|table`."""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.form import Form, Placed, step
from hearth.kb.language.plan_lines import plan_line
from hearth.kb.language.program_names import action_of
from hearth.kb.language.recognition_knowledge import recognition
from hearth.kb.language.steps_from_calls import composed_step
from hearth.schemas.program_boundaries import TITLE

_PAIR = re.compile(
    r"\s*(?:\d{1,3}[.):]\s+|[-*]\s+)?([A-Z][A-Z_]{2,}|[A-Z][a-z]+(?:[A-Z][a-z]+)+)((?:\s+[a-z][\w-]*){0,2})\s*[.;]?\s*"
)
_LONGEST = 300
_NAME = r"[a-z][\w' -]*"
_MARKED = re.compile(
    rf"\s*(?:\d{{1,3}}[.):]\s+|[-*]\s+)?([A-Z][A-Z_]{{2,}})((?:\s*[:|]\s*{_NAME}(?:\s*[|,]\s*{_NAME})?)?)\s*[.;]?\s*"
)
_BETWEEN = re.compile(r"\s*[:|,]\s*")
_LOOSE = re.compile(
    rf"\s*(?:(?:step\s*)?\d{{1,3}}\s*[.):|]\s*)?[(<]?\s*([A-Za-z][A-Za-z_]*)\s*(?:>|\||->|→|:|,)\s*"
    rf"({_NAME}(?:\s*(?:\||,|->|→)\s*{_NAME})?)\s*[)|]?\s*",
    re.IGNORECASE,
)
"""An action in small letters is one of a pair where every line is such a pair of a known action."""

_SEPARATOR = re.compile(r"\s*(?:\||,|->|→)\s*")
_BEGINS = re.compile(r"\s*(?:#|\**task\b.*:)", re.IGNORECASE)


def _parts(raw: str) -> list[str]:
    """Return the action of a line and its objects; none of another line."""
    pair = _PAIR.fullmatch(raw)
    if pair:
        return [pair[1], *pair[2].split()]
    pair = _MARKED.fullmatch(raw)
    return [each.strip() for each in _BETWEEN.split(pair[1] + pair[2])] if pair and not TITLE.match(raw) else []


def _loose(raw: str) -> list[str]:
    found = _LOOSE.fullmatch(raw) if len(raw) <= _LONGEST else None
    return [found[1], *(each.strip() for each in _SEPARATOR.split(found[2]))] if found else []


def _are_loose(lines: Sequence[str]) -> bool:
    """Return whether every line is a pair in small letters, and most have a known action."""
    found = [_loose(line) for line in lines if line.strip()]
    return len(found) > 1 and all(found) and 3 * sum(map(_is_known, found)) >= 2 * len(found)


def _is_known(parts: list[str]) -> bool:
    known = recognition()
    return bool(parts) and (known.action(parts[0]) is not None or bool(action_of(known, parts[0], parts[1:])))


def _fits(lines: Sequence[str]) -> bool:
    """Return whether most lines, and two at least, are such pairs, and half of those have a known action."""
    texts = [line for line in lines if line.strip()]
    if _are_loose(texts):
        return True
    found = [parts for line in texts if (parts := _parts(line))]
    if len(found) < 2 or 3 * len(found) < 2 * len(texts):
        return False
    return not any(map(_MARKED.fullmatch, texts)) or 2 * sum(map(_is_known, found)) >= len(found)


def _lines(lines: Sequence[str]) -> list[Placed]:
    found: list[Placed] = []
    parts_of = _loose if _are_loose(lines) else _parts
    for row, raw in enumerate(lines):
        parts = parts_of(raw)
        found.append(step(row, composed_step(parts[0], parts[1:])) if parts else Placed(row, plan_line(raw)))
    return found


PAIRS = Form(_fits, _lines, lambda raw: bool(_parts(raw)), _BEGINS)
