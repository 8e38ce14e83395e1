"""Plain steps with comments behind them: `open door  # it may be locked`; lines of comment alone are counted."""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.form import Form, Placed, remark, step

_STEP = re.compile(r"\s*(?P<step>[A-Za-z][^#/\[\](){}=<>|:]*?)\s+(?:#(?!\d)|//)\s*(?P<why>[^#]*\S)\s*")
_COMMENT = re.compile(r"\s*(?:#|//|;)\s*(?P<why>\S.*)")
_PLAIN = re.compile(r"\s*[A-Za-z][\w ,.'-]*")


def _fits(lines: Sequence[str]) -> bool:
    """Return whether two steps at least have comments behind them, and the others are plain lines or comments."""
    texts = [line for line in lines if line.strip()]
    found = sum(_STEP.fullmatch(line[:500]) is not None for line in texts)
    return found > 1 and all(_STEP.fullmatch(x[:500]) or _COMMENT.match(x) or _PLAIN.fullmatch(x[:500]) for x in texts)


def _lines(lines: Sequence[str]) -> list[Placed]:
    found: list[Placed] = []
    for row, raw in enumerate(lines):
        comment, commented = _COMMENT.fullmatch(raw), _STEP.fullmatch(raw[:500])
        if comment:
            found.append(remark(row, comment["why"]))
        elif raw.strip():
            found.append(step(row, commented["step"] if commented else raw))
    return found


COMMENTED = Form(_fits, _lines, lambda raw: bool(raw.strip()) and not _COMMENT.match(raw), re.compile(r"(?!)"))
