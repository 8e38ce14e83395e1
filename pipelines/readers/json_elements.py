"""JSON lists read entry by entry, in constant memory: at the top of a file, or under a key."""

import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from typing import Any

from hearth.pipelines.readers.json_documents import located, parsed
from hearth.pipelines.readers.reader_items import fault_of, pieces
from hearth.pipelines.readers.relaxed_json import uncommented
from hearth.pipelines.readers.texts_with_positions import Located
from hearth.schemas.failures import Code
from hearth.storage.archives import Place
from hearth.storage.rejects import Reject

LONGEST_ENTRY = 16_000_000
"""Characters of one entry at most."""

_TOKEN = re.compile(r'"[^"\\]*+(?:\\.[^"\\]*+)*+"|[\[\]{},:"]|//[^\n]*+\n|/\*.{0,2000}?\*/|/(?=[/*]|\Z)', re.DOTALL)
_OPENS, _CLOSES = frozenset("[{"), frozenset("]}")
_PAIR = {"]": "[", "}": "{"}


class BrokenError(Exception):
    """A document that ends too early, has text after its end, or an entry that is too long; with the line."""

    def __init__(self, message: str, line: int, code: Code = Code.BAD_JSON) -> None:
        super().__init__(message)
        self.line, self.code = line, code


def entries(path: Place, place: str, key: str = "") -> Iterator[tuple[int, Any | Reject]]:
    """Yield the values of a list with their first lines; an entry that is not JSON and a broken end are rejects.

    Args:
        path: the file.
        place: its name, for diagnostics.
        key: the key of the list in the file's object; empty if the file is the list.
    """
    return ((line, found) for line, _, found in _read(path, place, key, parsed))


def located_entries(path: Place, place: str) -> Iterator[tuple[int, Located | Reject]]:
    """Yield the values of a file's list as `entries` gives them, with the places of their texts."""
    return ((line, found) for line, _, found in _read(path, place, "", located))


def _read(
    path: Place, place: str, key: str, reader: Callable[[str, str, int, int], Any]
) -> Iterator[tuple[int, int, Any]]:
    try:
        for line, column, text in _Scanner(key).entries(pieces(path)):
            fault = fault_of(text, place, line)
            yield line, column, Reject((fault,)) if fault else reader(text, place, line, column)
    except BrokenError as error:
        suggestion = "save it as JSON in UTF-8, or write JSON Lines, one record a line"
        yield error.line, 1, Reject.of(error.code, str(error), file=place, line=error.line, suggestion=suggestion)


def kinds(path: Place) -> dict[str, str]:
    """Return the keys of a file's object, as far as it can be read, with the first character of each value."""
    scanner = _Scanner("", keep=False)
    with suppress(BrokenError):
        for _ in scanner.entries(pieces(path)):
            pass
    return scanner.kinds


class _Scanner:
    """Follows brackets and strings through a document; keeps only the current entry in memory."""

    def __init__(self, key: str, keep: bool = True) -> None:
        self.kinds: dict[str, str] = {}
        self._wanted = key
        self._level = (2 if key else 1) if keep else 0
        self._buffer, self._start, self._at = "", -1, 0
        self._line, self._counted, self._line_start = 1, 0, 0
        self._stack: list[str] = []
        self._began = False
        self._key, self._name = "", ""

    def entries(self, texts: Iterable[str]) -> Iterator[tuple[int, int, str]]:
        """Yield each entry of the list with its first line, and its column there.

        Raises:
            BrokenError: after the last whole entry.
        """
        for text in texts:
            self._buffer += text
            for match in _TOKEN.finditer(self._buffer, self._at):
                if match[0] in ('"', "/"):
                    break  # a string or comment that ends in a later piece
                yield from self._take(match[0], match.start(), match.end())
                self._at = match.end()
            self._forget()
        if self._stack or not self._began or uncommented(self._buffer[self._at :]).strip():
            raise BrokenError("the document is not complete", self._here(len(self._buffer)))

    def _take(self, token: str, at: int, end: int) -> Iterator[tuple[int, int, str]]:
        if token[0] == "/":
            return
        if not self._stack:
            self._begin(token, at)
            self._start = end if self._listed() else -1
        elif token in _OPENS:
            self._note(token)
            self._stack.append(token)
            self._start = end if self._listed() else self._start
        elif token in _CLOSES or token == ",":
            yield from self._ended(token, at)
            self._start = end if token == "," and self._listed() else self._start
        elif token == ":":
            self._key = self._name if len(self._stack) == 1 else self._key
        else:
            self._note('"')
            self._name = token[1:-1]

    def _begin(self, token: str, at: int) -> None:
        if self._began or token not in _OPENS or uncommented(self._buffer[:at]).strip():
            raise BrokenError("text next to the list or object", self._here(at))
        self._began = True
        self._stack.append(token)

    def _note(self, kind: str) -> None:
        if self._key and len(self._stack) == 1:
            self.kinds.setdefault(self._key, kind)

    def _listed(self) -> bool:
        """Return whether the next value is an entry of the requested list."""
        stack = self._stack
        if len(stack) != self._level or stack[-1] != "[":
            return False
        return self._level == 1 or (stack[0] == "{" and self._key == self._wanted)

    def _ended(self, token: str, at: int) -> Iterator[tuple[int, int, str]]:
        """Yield a comma or bracket, which may end an entry."""
        if self._listed() and self._start >= 0:
            text = uncommented(self._buffer[self._start : at])
            # `[]` is an empty list, and nothing need follow the last comma; before a comma an empty text is an entry.
            if token == "," or text.strip():
                lead = len(text) - len(text.lstrip())
                line = self._here(self._start + lead)
                yield line, self._start + lead - self._line_start + 1, text.strip()
            self._start = -1
        if token == "," and len(self._stack) == 1:
            self._key = ""
        if token != "," and _PAIR[token] != self._stack.pop():
            raise BrokenError(f"`{token}` closes what it did not open", self._here(at))

    def _here(self, at: int) -> int:
        breaks = self._buffer.count("\n", self._counted, at)
        if breaks:
            self._line += breaks
            self._line_start = self._buffer.rfind("\n", self._counted, at) + 1
        self._counted = max(at, self._counted)
        return self._line

    def _forget(self) -> None:
        """Keep only the current entry."""
        keep = self._start if self._start >= 0 else self._at
        self._here(keep)
        self._buffer, self._at = self._buffer[keep:], self._at - keep
        self._start, self._counted = min(self._start, 0), self._counted - keep
        self._line_start -= keep
        if len(self._buffer) > LONGEST_ENTRY:
            message = f"an entry of more than {LONGEST_ENTRY:,} characters"
            raise BrokenError(message, self._line, Code.FILE_TOO_LARGE)
