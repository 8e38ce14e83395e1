"""The heads of lines in logs: times, levels and the name of the program that writes, in any order that loggers have."""

import re
from typing import NamedTuple

_CLOCK = r"\d{1,2}:\d\d(?::\d\d(?:[.,]\d{1,9})?)?(?:\s?[ap]m)?"
_DATE = (
    r"(?:\d{4}[-/]\d\d[-/]\d\d|\d{1,2}[./-]\d{1,2}[./-]\d{2,4}"
    r"|(?:jan|feb|mar|apr|may|jun|jul|aug|sep|oct|nov|dec)[a-z]{0,6}\s+\d{1,2})"
)
STAMP = (
    rf"(?:\[?\d{{9,13}}(?:\.\d{{1,9}})?\]?|[\[(]?(?:{_DATE}(?:T|,?\s+))?{_CLOCK}(?:Z|[+-]\d\d:?\d\d)?[\])]?"
    rf"|[\[(]{_DATE}[\])])"
)
_LEVEL = r"(?-i:\[?(?P<level>INFO|DEBUG|WARN(?:ING)?|ERROR|TRACE|FATAL)\]?|\[(?P<act>ACTION|EXEC|STEP)\])"
_FIRST = re.compile(rf"(?:{STAMP}|{_LEVEL})(?=[\s:|-])[\s:|,–-]*", re.IGNORECASE)
_ACT = re.compile(r"(?P<level>ACTION|EXEC|STEP):?\s+")
_LOGGER = re.compile(
    r"(?:[\w.-]{1,40}\s+)?[\w.-]{1,40}\[\d{1,9}\]:\s*|\[[\w./-]{1,40}\]:?\s+|[\w.-]{1,40}(?:\s+-\s+|:(?=\S))"
)
_RUN = re.compile(r"\[[A-Za-z][\w ./#-]{0,30}\d\]\s+(?=\w+:\s)")
_MOST = 4
"""Times and levels of a line, at most."""


class Head(NamedTuple):
    """The head of a line: its end, its level, and the answer whether it has a time or level."""

    end: int
    is_timed: bool
    level: str


def head_of(raw: str) -> Head:
    """Return the head of a line, of which each part is looked for once, so that a long line takes no long time."""
    at = len(raw) - len(raw.lstrip())
    if run := _RUN.match(raw, at):
        return Head(run.end(), False, "")
    is_timed, level = False, ""
    for _ in range(_MOST):
        found = _FIRST.match(raw, at) or (_ACT.match(raw, at) if is_timed else None)
        if not found:
            break
        parts = found.groupdict()
        level = parts.get("level") or parts.get("act") or level
        at, is_timed = found.end(), True
        if (logger := _LOGGER.match(raw, at)) and not _FIRST.match(raw, at):
            at = logger.end()
    return Head(at, is_timed, level)
