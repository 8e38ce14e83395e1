"""Special blocks: free text instead of an action, and the reviewed steps that replace some of it (thesis 3.3)."""

import re
from dataclasses import replace
from functools import cache
from typing import NamedTuple

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.yaml_limits import packaged

FILE = "data_raw/crowd/special_blocks.yaml"

_SPECIAL = re.compile(r"\s*\[\s*special\s*\]\s*<?(.*?)>?(?:\s*\(\d+\))?\s*", re.IGNORECASE)


class Expanded(NamedTuple):
    """A program's text with special blocks replaced, and the original line of each of its lines."""

    text: str
    lines: tuple[int, ...]
    replaced: tuple[tuple[int, str], ...] = ()
    """The lines of the replaced blocks, with their text."""

    def original(self, line: int) -> int:
        """Return the line that a line of the expanded text came from."""
        return self.lines[line - 1] if 0 < line <= len(self.lines) else line

    def placed(self, fault: Diagnostic) -> Diagnostic:
        """Return a fault of the expanded text, moved to its original line.

        A fault of the whole text moves to the first line.
        """
        return replace(fault, line=self.original(fault.line or 1))


@cache
def blocks() -> dict[str, tuple[str, ...]]:
    """Return the steps that replace each free text, which is in lower case with single spaces."""
    data = packaged("hearth", FILE) or {}
    return {_normal(block["text"]): tuple(block["steps"]) for block in data.get("blocks") or ()}


def expand(text: str, before: int) -> Expanded:
    """Replace the known blocks; `before` is the number of lines of the file before the text."""
    known = blocks()
    kept: list[str] = []
    numbers: list[int] = []
    replaced: list[tuple[int, str]] = []
    for number, line in enumerate(text.split("\n"), before + 1):
        match = _SPECIAL.fullmatch(line) if "special" in line.lower() else None
        steps = known.get(_normal(match[1])) if match else None
        if match and steps:
            replaced.append((number, match[1]))
        for piece in steps or (line,):
            kept.append(piece)
            numbers.append(number)
    return Expanded("\n".join(kept), tuple(numbers), tuple(replaced))


def _normal(text: str) -> str:
    return " ".join(text.lower().split())
