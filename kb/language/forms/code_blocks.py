"""Blocks of code: how far a line is indented, and where the lines end that belong to it."""

from collections.abc import Sequence


def indent(raw: str) -> int:
    """Return the characters before a line of code; a tab counts as it is shown."""
    return len(raw.expandtabs()) - len(raw.expandtabs().lstrip())


def end_of_block(lines: Sequence[str], at: int, above: int) -> int:
    """Return the index behind the lines from `at` on that are indented deeper than `above`; blank ones at its end are
    none of them.
    """
    end = at
    while at < len(lines) and (not lines[at].strip() or indent(lines[at]) > above):
        at += 1
        end = at if lines[at - 1].strip() else end
    return end
