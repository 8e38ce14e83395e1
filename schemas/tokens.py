"""The tokens of a short text, read one by one by parsers of formulas and of goals."""

import re
from collections.abc import Callable
from typing import ClassVar, TypeVar

from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code

_PART = re.compile(r"\S+")

DEEPEST = 40
"""Deepest nesting of parts of a text; Python's own limit would end in a traceback."""

T = TypeVar("T")
Self = TypeVar("Self", bound="Tokens")


class Tokens:
    """The tokens of a text that match `PATTERN`, with the place of the next one.

    Args:
        text: it may have several lines.
        file: where it stands, for faults; "" if it stands in no file.

    Raises:
        HearthError: SYNTAX, where it is something else.
    """

    PATTERN: ClassVar[re.Pattern[str]]

    def __init__(self, text: str, file: str = "") -> None:
        self.text, self.file, self.next, self.depth = text, file, 0, 0
        self.tokens: list[str] = []
        self.places: list[int] = []
        for part in _PART.finditer(text):
            place = part.start()
            while place < part.end():
                self.places.append(place)
                found = self.PATTERN.match(text, place)
                if not found:
                    self.next = len(self.tokens)
                    raise self.fault(f"cannot read `{text[place : min(part.end(), place + 20)]}`")
                self.tokens.append(found[0])
                place = found.end()
        self.places.append(len(text))

    def whole(self: Self, rule: Callable[[Self], T]) -> T:
        """Return a rule's result for all tokens."""
        result = rule(self)
        if self.peek():
            raise self.fault(f"`{self.peek()}` is too much")
        return result

    def fault(self, message: str, code: Code = Code.SYNTAX, suggestion: str = "", ahead: int = 0) -> HearthError:
        """Return an error at the next token, or at one before it."""
        if not self.file:
            return HearthError.of(code, f"in `{self.text}`: {message}", suggestion=suggestion)
        place = self.places[self.next + ahead]
        line, start = self.text.count("\n", 0, place) + 1, self.text.rfind("\n", 0, place) + 1
        source = self.text[start:].partition("\n")[0]
        where = (self.file, line, place - start + 1, len(self.tokens[self.next + ahead]) if ahead else 1)
        return HearthError(Diagnostic(code, message, *where, suggestion=suggestion, source=source))

    def peek(self, ahead: int = 0) -> str:
        """Return the next token, or one after it; "" after the last."""
        return self.tokens[self.next + ahead] if self.next + ahead < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        """Return the next token, which must be the wanted one."""
        token = self.peek()
        if not token or (wanted and token != wanted):
            raise self.fault(f"expected {wanted or 'a name'} but found `{token or 'the end'}`")
        self.next += 1
        return token

    def deeper(self, rule: Callable[[], T]) -> T:
        """Return a rule's result for a part that stands within another."""
        if self.depth >= DEEPEST:
            raise self.fault(f"more than {DEEPEST} parts within one another")
        self.depth += 1
        found = rule()
        self.depth -= 1
        return found

    def name(self) -> str:
        """Return the next token, which must be a name."""
        if not (self.peek()[:1].isalpha() or self.peek()[:1] == "_"):
            raise self.fault(f"expected a name but found `{self.peek() or 'the end'}`")
        return self.take()

    def several(self, rule: Callable[[], T], *marks: str) -> tuple[T, ...]:
        """Return a rule's results for parts with a mark between them."""
        parts = [rule()]
        while self.peek().lower() in marks:
            self.take()
            parts.append(rule())
        return tuple(parts)
