"""Diagnostics about input that people wrote, and the one exception the library raises for bad input."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from hearth.schemas.failures import Code


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """A fault in a file, with its place and its remedy.

    Attributes:
        code: the kind.
        file: where it stands, as the user named it; empty for text without a file.
        line: from 1; 0 when the fault concerns the whole file.
        column: from 1; 0 when unknown.
        length: how many characters are at fault.
        found: the offending words.
        message: the fault.
        suggestion: the remedy, if one is known.
        source: the whole offending line, for underlining.
        before: characters of the file's line before `source`, where that is a part of it.
    """

    code: Code
    message: str
    file: str = ""
    line: int = 0
    column: int = 0
    length: int = 0
    found: str = ""
    suggestion: str = ""
    source: str = ""
    before: int = 0

    def at(self, file: str) -> Diagnostic:
        """Return the same fault, placed in `file`."""
        return replace(self, file=file)

    def place(self) -> str:
        """`file:line:column`, leaving out what is unknown."""
        return ":".join(str(part) for part in (self.file, self.line, self.column) if part)

    def __str__(self) -> str:
        place = self.place()
        text = f"{place}: {self.code}: {self.message}" if place else f"{self.code}: {self.message}"
        return f"{text} ({self.suggestion})" if self.suggestion else text


LONGEST_SOURCE = 200
"""Characters of a line at most that a fault holds."""


def excerpt(line: str, column: int) -> tuple[str, int]:
    """Return the part of a line around a column (from 1) for `source`, and the characters of the line `before` it."""
    start = 0 if column <= LONGEST_SOURCE - _FOLLOWING else column - 1 - _LEADING
    return line[start : start + LONGEST_SOURCE], start


_LEADING, _FOLLOWING = 60, 60


class HearthError(Exception):
    """Bad input, with every fault that was found. The command line prints it and exits with status 1,
    or with status 2 where a name on the command line is at fault.

    Attributes:
        diagnostics: the faults, each with code, place, message and remedy.

    Examples:
        >>> try:
        ...     hearth.home("castle")
        ... except hearth.HearthError as error:
        ...     print(error.diagnostics[0].code, error.diagnostics[0].message)
        UNKNOWN_HOME there is no home `castle`
    """

    def __init__(self, diagnostics: Iterable[Diagnostic] | Diagnostic) -> None:
        found = (diagnostics,) if isinstance(diagnostics, Diagnostic) else tuple(diagnostics)
        self.diagnostics: tuple[Diagnostic, ...] = found
        super().__init__("\n".join(map(str, found)))

    @classmethod
    def of(cls, code: Code, message: str, *, file: str = "", suggestion: str = "") -> HearthError:
        """Return an error of one fault that concerns a whole file or option."""
        return cls(Diagnostic(code, message, file=file, suggestion=suggestion))

    def __reduce__(self) -> tuple[type[HearthError], tuple[tuple[Diagnostic, ...]]]:
        return (type(self), (self.diagnostics,))
