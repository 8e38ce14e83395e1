"""Lists of todo.txt: `x 2026-11-02 2026-11-01 walk to the desk +home`, `(A) find the lamp due:2026-11-05`."""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.form import Form, Placed, step
from hearth.kb.language.plan_lines import TAGS, plan_line
from hearth.kb.language.step_like_lines import is_like_step

_ITEM = re.compile(
    r"\s*(?=x\s|\([A-Z]\)\s|\d{4}-\d\d-\d\d\s)(?:x\s+)?(?:\([A-Z]\)\s+)?(?:\d{4}-\d\d-\d\d\s+){0,2}(?=[^\W\d_])"
)
"""The marks before a task: whether it is done, its priority, and the days of its end and its beginning."""

_MARK = re.compile(r"\s*(?:x\s|\([A-Z]\)\s)")
_OUTSIDE = re.compile(r"\s*#{1,6}\s|\s*task\b.*:", re.IGNORECASE)


def _fits(lines: Sequence[str]) -> bool:
    """Return whether half of the lines at least are tasks, one of them done or with a priority."""
    texts = [line for line in lines if line.strip()]
    found = sum(_ITEM.match(line) is not None for line in texts)
    return found > 0 and 2 * found >= len(texts) and any(_MARK.match(line) and _ITEM.match(line) for line in texts)


def _lines(lines: Sequence[str]) -> list[Placed]:
    """Return the lines: each below the first task with marks is a task, and one above that asks for a step."""
    first = next((row for row, raw in enumerate(lines) if _ITEM.match(raw)), 0)
    return [
        _line(row, raw, is_task=row > first or (row > 0 and is_like_step(raw.strip()))) for row, raw in enumerate(lines)
    ]


def _line(row: int, raw: str, *, is_task: bool) -> Placed:
    item = _ITEM.match(raw)
    if item or (is_task and raw.strip() and not _OUTSIDE.match(raw)):
        return step(row, TAGS.sub("", raw[item.end() if item else 0 :].strip()))
    return Placed(row, plan_line(raw)._replace(number=None, numbered=False))


TODO_LISTS = Form(_fits, _lines, lambda raw: _ITEM.match(raw) is not None, _OUTSIDE)
