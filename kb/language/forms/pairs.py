"""Actions in capitals before their objects: `WALK kitchen`, `PUTBACK plate table`."""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.form import Form, Placed, step, written
from hearth.kb.language.plan_lines import plan_line

_PAIR = re.compile(r"\s*(?:\d{1,3}[.):]\s+|[-*]\s+)?([A-Z][A-Z_]{2,})((?:\s+[a-z][\w-]*){0,2})\s*[.;]?\s*")
_BEGINS = re.compile(r"\s*(?:#|\**task\b.*:)", re.IGNORECASE)


def _fits(lines: Sequence[str]) -> bool:
    """Return whether most lines, and two at least, are such pairs."""
    texts = [line for line in lines if line.strip()]
    found = sum(_PAIR.fullmatch(line) is not None for line in texts)
    return found > 1 and 3 * found >= 2 * len(texts)


def _lines(lines: Sequence[str]) -> list[Placed]:
    found: list[Placed] = []
    for row, raw in enumerate(lines):
        pair = _PAIR.fullmatch(raw)
        found.append(step(row, written(pair[1], pair[2].split())) if pair else Placed(row, plan_line(raw)))
    return found


PAIRS = Form(_fits, _lines, lambda raw: _PAIR.fullmatch(raw) is not None, _BEGINS)
