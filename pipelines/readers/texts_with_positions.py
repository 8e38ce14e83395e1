"""Texts that know where they stand in a file: strings of JSON and cells of tables."""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterator, Sequence
from itertools import accumulate
from typing import Any

_TOKEN = re.compile(r'"([^"\\]*+(?:\\.[^"\\]*+)*+)"', re.DOTALL)
_GRAPHS = frozenset({"init_graph", "final_graph", "graph", "nodes", "edges"})
"""Keys of scene graphs, whose names need no places."""

JSON_UNIT = re.compile(r"\\u[dD][89abAB]..\\u[dD][c-fC-F]..|\\u....|\\.|[^\\]", re.DOTALL)
CELL_UNIT = re.compile(r'""|.', re.DOTALL)
"""The characters of a file that stand for one character of a text."""


class Text(str):
    """A text with its place: line and column from 1, and as the file has it where that differs."""

    __slots__ = ("column", "line", "raw", "unit")
    line: int
    column: int
    raw: str
    unit: str

    def cutter(self) -> Callable[[int, int], Text]:
        """Return a function that cuts pieces out of the text, with their places: by the start and the length of each.

        It reads the text once, so that all the lines of a long text take no longer than a few.
        """
        whole, offsets, breaks = str(self), self._offsets(), self._breaks()

        def cut(start: int, length: int) -> Text:
            first, end = offsets[start], offsets[start + length]
            line, column = self._at(first, breaks)
            return text_at(whole[start : start + length], line, column, self.raw[first:end], self.unit)

        return cut

    def places(self, skip: int = 0) -> list[list[int]]:
        """Return the place of each line; see `hearth.schemas.text_places`.

        Args:
            skip: characters that a reader has put before the first line.
        """
        if self.raw == self and "\n" not in self:
            return [[skip, self.line, self.column]]
        if self._has_breaks_alone():
            return self._starts(skip)
        offsets, breaks, found, start = self._offsets(), self._breaks(), [], 0
        for line in self.split("\n"):
            ends = offsets[start : start + len(line) + 1]
            found.append([each for place in self._jumps(ends, breaks, skip) for each in place])
            start, skip = start + len(line) + 1, 0
        return found

    def _has_breaks_alone(self) -> bool:
        """Return whether this is a string of JSON whose only escapes are line breaks, as most are."""
        is_json = _unit(self.unit) is JSON_UNIT and "\n" not in self.raw
        return is_json and self.raw.replace("\\n", "\n") == self

    def _starts(self, skip: int) -> list[list[int]]:
        """Return the places of lines between which the file has two characters, a backslash and `n`."""
        found, line, column = [], self.line, self.column
        for text in self.split("\n"):
            found.append([skip, line, column])
            column, skip = column + len(text) + 2, 0
        return found

    def _jumps(self, ends: Sequence[int], breaks: Sequence[int], skip: int) -> Iterator[tuple[int, int, int]]:
        """Yield the first character of a line, and each that does not stand right after the one before it."""
        before = -1
        for index, offset in enumerate(ends):
            if offset != before + 1 or not index:
                yield (index + skip, *self._at(offset, breaks))
            before = offset

    def _offsets(self) -> Sequence[int]:
        if self.raw == self:
            return range(len(self) + 1)
        unit = _unit(self.unit)
        return [0, *accumulate(len(match[0]) for match in unit.finditer(self.raw))]

    def _at(self, offset: int, breaks: Sequence[int]) -> tuple[int, int]:
        """Line and column of a place in the raw text, which has these line breaks."""
        before = bisect_left(breaks, offset)
        return (self.line + before, offset - breaks[before - 1]) if before else (self.line, self.column + offset)

    def _breaks(self) -> list[int]:
        return [match.start() for match in re.finditer("\n", self.raw)] if "\n" in self.raw else []


def _unit(name: str) -> re.Pattern[str]:
    """Return a pattern for a character of a text in the file; `name` may be line breaks with their indents."""
    if name.startswith(("\n", "\\n")):
        return re.compile(f"{name}|.", re.DOTALL)
    return CELL_UNIT if name == '""' else JSON_UNIT


def text_at(value: str, line: int, column: int, raw: str, unit: str = "") -> Text:
    """Return a text with its place."""
    found = Text(value)
    found.line, found.column, found.raw, found.unit = line, column, raw, unit
    return found


class Composed(Text):
    """A line made of texts from several places, and of the characters between them."""

    __slots__ = ("parts",)
    parts: list[tuple[int, Text]]

    def places(self, skip: int = 0) -> list[list[int]]:
        """Return the place of the line, which goes on at another place with each text."""
        return [[each for at, text in self.parts for each in text.places(at + skip)[0]]]

    def cutter(self) -> Callable[[int, int], Text]:
        """Return a function that cuts pieces out of the line: each has the texts that begin in it."""
        whole, begins = str(self), [at for at, _ in self.parts]

        def cut(start: int, length: int) -> Text:
            first, end = bisect_left(begins, start), bisect_left(begins, start + length)
            inside = [(at - start, text) for at, text in self.parts[first:end]]
            return _composed(whole[start : start + length], inside or [(0, self.parts[0][1])])

        return cut


def composed(*pieces: str) -> str:
    """Pieces of a line as one text, with the places of those that have one."""
    line, parts = "", []
    for piece in pieces:
        parts += [(len(line), piece)] if isinstance(piece, Text) else []
        line += piece
    return _composed(line, parts) if parts else line


def _composed(line: str, parts: list[tuple[int, Text]]) -> Composed:
    found = Composed(line)
    found.parts, first = parts, parts[0][1]
    found.line, found.column, found.raw, found.unit = first.line, first.column, line, ""
    return found


class Located:
    """A JSON value whose strings are `Text`, and the lines on which its objects begin.

    Attributes:
        value: the value.
        whole: whether every string of the file is in it: not if an object repeats a key.
    """

    def __init__(self, value: Any, raw: str, line: int = 1, column: int = 1) -> None:
        self._raw, self._line, self._column = raw, line, column
        self._breaks = [match.start() for match in re.finditer("\n", raw)] if "\n" in raw else []
        self._lines: dict[int, int] = {}
        self.whole = True
        alone = _TOKEN.fullmatch(raw) if isinstance(value, str) else None
        self.value = self._text(value, alone) if alone else self._walk(value)

    def line_of(self, value: Any) -> int:
        """Return the line on which an object of the value, or a text in it, begins; else that of the whole value."""
        first = self._lines.get(id(value))
        if first is None:
            inside = next(texts_in(value), None)
            return inside.line if inside is not None else self._line
        return first

    def _walk(self, value: Any) -> Any:
        """Replace the strings of a value, in the order of the file."""
        tokens = _TOKEN.finditer(self._raw)
        top: list[Any] = [value]
        stack: list[tuple[Iterator[tuple[Any, Any, Any]], bool]] = [(iter([(top, 0, value)]), False)]
        while stack:
            parts, is_graph = stack[-1]
            for holder, key, part in parts:
                if holder.__class__ is not list:
                    self._keyed(holder, next(tokens))
                if isinstance(part, str):
                    token = next(tokens)
                    if not is_graph:
                        holder[key] = self._text(part, token)
                elif part and isinstance(part, (dict, list)):
                    stack.append((_parts(part), is_graph or key in _GRAPHS))
                    break
            else:
                stack.pop()
        self.whole = next(tokens, None) is None
        return top[0]

    def _keyed(self, holder: Any, token: re.Match[str]) -> None:
        if id(holder) not in self._lines:
            self._lines[id(holder)] = self._place(self._raw.rfind("{", 0, token.start()))[0]

    def _text(self, value: str, token: re.Match[str]) -> Text:
        return text_at(value, *self._place(token.start(1)), token[1], "\\")

    def _place(self, offset: int) -> tuple[int, int]:
        breaks = bisect_right(self._breaks, offset)
        if not breaks:
            return self._line, self._column + offset
        return self._line + breaks, offset - self._breaks[breaks - 1]


class Pairs(dict[str, Any]):
    """A JSON object with repeated keys: the last value of each, and all in the order of the file."""

    def __init__(self, pairs: list[tuple[str, Any]]) -> None:
        super().__init__(pairs)
        self.pairs = [[key, value] for key, value in pairs]


def pairs_of(value: dict[str, Any]) -> list[tuple[str, Any]]:
    """Return the keys of an object with their values, in the order of the file, repeated ones too."""
    return [(key, part) for key, part in value.pairs] if isinstance(value, Pairs) else list(value.items())


def _parts(value: Any) -> Iterator[tuple[Any, Any, Any]]:
    """Yield each part of a list or object: its container, its key, and the part."""
    if isinstance(value, list):
        return ((value, index, part) for index, part in enumerate(value))
    if not isinstance(value, Pairs):
        return ((value, key, part) for key, part in list(value.items()))
    return ((_Repeated(value, index), value.pairs[index][0], pair[1]) for index, pair in enumerate(list(value.pairs)))


class _Repeated:
    """Sets a pair of an object with repeated keys."""

    def __init__(self, owner: Pairs, index: int) -> None:
        self._owner, self._index = owner, index

    def __setitem__(self, key: str, value: Any) -> None:
        self._owner.pairs[self._index][1] = value
        self._owner[key] = value


def texts_in(value: Any) -> Iterator[Text]:
    """Yield the texts of a value that is not deep, in order."""
    if isinstance(value, Text):
        yield value
    elif isinstance(value, (dict, list)):
        for part in value.values() if isinstance(value, dict) else value:
            if isinstance(part, Text):
                yield part
            elif isinstance(part, list):
                yield from (text for text in part if isinstance(text, Text))


def pieces_of(text: str, pieces: Sequence[str]) -> list[str]:
    """Pieces that follow each other in a text, with their places where the text has one."""
    if not isinstance(text, Text):
        return list(pieces)
    found: list[str] = []
    at, cut = 0, text.cutter()
    for piece in pieces:
        start = text.find(piece, at)
        found.append(cut(start, len(piece)) if start >= 0 else _words_in(text, piece, cut))
        at = start + len(piece) if start >= 0 else at
    return found


def _words_in(text: Text, piece: str, cut: Callable[[int, int], Text]) -> Text:
    """Return a piece whose words follow each other in a text, whatever stands between them.

    Else at the text's place.
    """
    parts: list[str] = []
    at = 0
    for word in piece.split(" "):
        start = text.find(word, at)
        if start < 0:
            return text_at(piece, text.line, text.column, piece)
        parts += [cut(start, len(word)), " "]
        at = start + len(word)
    joined = composed(*parts[:-1])
    return joined if isinstance(joined, Text) else text_at(piece, text.line, text.column, piece)
