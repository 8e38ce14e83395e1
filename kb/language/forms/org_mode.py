"""Outlines of Org mode: `** TODO walk to the desk` below `* Tidy the desk`."""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.form import Form, Placed, step, title
from hearth.kb.language.plan_lines import plan_line

_ITEM = re.compile(r"\s*\*{1,6}\s+(?:TODO|DONE|NEXT|WAITING|STARTED)\s+(?:\[#[A-C]\]\s+)?(\S.*?)(?:\s+:[\w@:]+:)?\s*")
_HEADING = re.compile(r"\*{1,6}\s+(?!(?:TODO|DONE|NEXT|WAITING|STARTED)\b)(\S.*?)(?:\s+:[\w@:]+:)?\s*")


def _fits(lines: Sequence[str]) -> bool:
    """Return whether half of the lines, and two at least, are items to do."""
    texts = [line for line in lines if line.strip()]
    found = sum(_ITEM.fullmatch(line) is not None for line in texts)
    return found > 1 and 2 * found >= len(texts)


def _lines(lines: Sequence[str]) -> list[Placed]:
    found = []
    for row, raw in enumerate(lines):
        item, heading = _ITEM.fullmatch(raw), _HEADING.fullmatch(raw)
        if item:
            found.append(step(row, item[1]))
        else:
            found.append(title(row, heading[1]) if heading else Placed(row, plan_line(raw)))
    return found


ORG_MODE = Form(
    _fits,
    _lines,
    lambda raw: _ITEM.fullmatch(raw) is not None,
    re.compile(r"\*{1,6}\s+(?!(?:TODO|DONE|NEXT|WAITING|STARTED)\b)"),
)
