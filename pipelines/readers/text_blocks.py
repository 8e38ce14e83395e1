"""The programs of a text, found piece by piece in constant memory."""

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from hearth.schemas.program_boundaries import Splitter
from hearth.schemas.syntax import MAX_LINE

LONGEST_PROGRAM = 1_000_000
"""Characters of a program at most, however many steps; of a longer one only the beginning is kept."""

# Possessive quantifiers never backtrack, so that many blank lines take linear time.
_LEADING = re.compile(r"(?:[^\S\n]*+\n)*+")
_GAP = re.compile(r"\n[^\S\n]*+\n\s*+")
_NO_TITLE = frozenset(["", "[", "<", "(", "|"])
"""Characters after a gap that do not begin a title: the end of the buffer, or a step."""

_STEP = re.compile(r"^[^\S\n]*[\[<(|]", re.MULTILINE)


class Block(NamedTuple):
    """One program: the number of its first line, its text, and whether that is only its beginning."""

    first: int
    text: str
    cut: bool


def blocks(pieces: Iterable[str]) -> Iterator[Block]:
    """Split a text into programs as `hearth.schemas.program_boundaries` does, looking only at blank lines."""
    cutter = _Cutter()
    for piece in pieces:
        yield from cutter.take(piece)
    yield from cutter.take("", final=True)


class _Cutter:
    """Splits a text; the current program is in `_buffer`, or its beginning in `_kept` if it is too long."""

    def __init__(self) -> None:
        self._buffer = ""
        self._line = 1
        self._kept: Block | None = None
        self._seen = 0
        self._splitter = _started()

    def take(self, piece: str, final: bool = False) -> Iterator[Block]:
        """Yield the programs that end in the next piece of the text."""
        self._buffer += piece
        if self._kept is None and self._seen == 0:
            self._drop(_LEADING.match(self._buffer).end())  # type: ignore[union-attr]
        start = 0
        for gap in _GAP.finditer(self._buffer, self._seen):
            if self._buffer[gap.end() : gap.end() + 1] in _NO_TITLE:
                continue
            begins = self._begins(gap.start(), gap.end(), final)
            if begins is None:
                break
            if begins:
                at = self._buffer.rfind("\n", start, gap.end()) + 1
                yield self._block(start, at)
                self._line += self._buffer.count("\n", start, at)
                start = self._seen = at
                self._splitter = _started()
            else:
                self._seen = gap.end()
        self._buffer = self._buffer[start:]
        self._seen = min(self._seen - start, len(self._buffer)) if not final else 0
        if final:
            if self._kept or self._buffer.strip():
                yield self._block(0, len(self._buffer))
        elif len(self._buffer) > LONGEST_PROGRAM:
            self._shorten()

    def _begins(self, end: int, start: int, final: bool) -> bool | None:
        """Return whether the line at `start`, after a gap from `end`, begins a program.

        None while that is undecided.
        """
        buffer, splitter = self._buffer, self._splitter
        if not splitter.has_steps and self._has_steps(end):
            splitter.has_steps = True
        stop = buffer.find("\n", start, start + MAX_LINE + 1)
        if stop < 0 and not final and len(buffer) - start <= MAX_LINE:
            return None
        if not splitter.has_steps:
            return self._parted(end, start, stop)
        return stop >= 0 or len(buffer) - start <= MAX_LINE

    def _parted(self, end: int, start: int, stop: int) -> bool:
        buffer, splitter = self._buffer, self._splitter
        if "\n" in buffer[self._seen : end].strip():
            splitter.begins("", is_step=False)
        for _ in range(buffer.count("\n", end, start) - 1):
            splitter.blank()
        long = stop < 0 and len(buffer) - start > MAX_LINE
        return splitter.begins(buffer[start : stop if stop >= 0 else len(buffer)][: MAX_LINE + 1], is_step=long)

    def _has_steps(self, end: int) -> bool:
        """Return whether there is a step before `end`; a line that is too long counts as one."""
        if _STEP.search(self._buffer, self._seen, end):
            return True
        if end - self._seen <= MAX_LINE:
            return False
        return any(len(line) > MAX_LINE for line in self._buffer[self._seen : end].split("\n"))

    def _block(self, start: int, end: int) -> Block:
        kept, self._kept = self._kept, None
        if kept is None and end - start > LONGEST_PROGRAM:
            return Block(self._line, self._buffer[start : start + 2 * MAX_LINE], True)
        return kept or Block(self._line, self._buffer[start:end], False)

    def _shorten(self) -> None:
        """Keep the beginning of a program that is too long, and its last line, by which its end is found."""
        body = self._buffer.rstrip()
        if not body:
            self._drop(len(self._buffer) - 1)
            return
        self._kept = self._kept or self._block(0, len(self._buffer))
        line = body.rfind("\n") + 1
        self._splitter.has_steps = self._splitter.has_steps or self._has_steps(len(body))
        if not self._splitter.has_steps:
            self._splitter.begins("", is_step=False)
        before = len(body[:line].rstrip())
        last = body[line:] if len(body) - line <= MAX_LINE else body[line : line + MAX_LINE] + body[-1]
        rest = _squeezed(body[before:line]) + last + _squeezed(self._buffer[len(body) :])
        self._line += self._buffer.count("\n") - rest.count("\n")
        self._buffer, self._seen = rest, 0

    def _drop(self, end: int) -> None:
        self._line += self._buffer.count("\n", 0, end)
        self._buffer = self._buffer[end:]


def _started() -> Splitter:
    splitter = Splitter()
    splitter.begins("", is_step=False)
    return splitter


def _squeezed(blank: str) -> str:
    """Return at most three blank lines, as many as can separate programs; the text after the last line end is kept."""
    return "\n" * min(blank.count("\n"), 3) + blank[blank.rfind("\n") + 1 :][-MAX_LINE:]
