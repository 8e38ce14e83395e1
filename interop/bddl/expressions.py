"""Expressions in brackets, as BDDL and PDDL write them, with the line of each."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code

LONGEST = 1 << 20
"""Characters of a problem that are read; those of BEHAVIOR have some 5,000."""

DEEPEST = 40
"""Brackets within one another."""


@dataclass(frozen=True)
class Expression:
    """A list of words and expressions: `(ontop ?plate_1 table_1)`.

    Attributes:
        items: words in lower case, and expressions.
        line: of its bracket, from 1.
    """

    items: tuple[str | Expression, ...]
    line: int

    @property
    def head(self) -> str:
        """The first word; "" where an expression comes first, or nothing."""
        return self.items[0] if self.items and isinstance(self.items[0], str) else ""

    @property
    def words(self) -> tuple[str, ...]:
        """The words behind the first one."""
        return tuple(item for item in self.items[1:] if isinstance(item, str))

    @property
    def parts(self) -> tuple[Expression, ...]:
        """The expressions in it."""
        return tuple(item for item in self.items if isinstance(item, Expression))

    def __str__(self) -> str:
        return f"({' '.join(map(str, self.items))})"


def read_expression(text: str, file: str = "") -> Expression:
    """Return the one expression of a text; comments begin with `;`.

    Raises:
        HearthError: FILE_TOO_LARGE, or SYNTAX with the line.
    """
    if len(text) > LONGEST:
        raise HearthError.of(Code.FILE_TOO_LARGE, f"{len(text):,} characters, where {LONGEST:,} are read", file=file)
    stack: list[tuple[list[str | Expression], int]] = [([], 1)]
    line = 1
    for line, token in _tokens(text):
        if token == "(":
            stack.append(([], line))
            if len(stack) > DEEPEST:
                raise _fault(f"more than {DEEPEST} brackets are within one another", file, line, "fewer brackets")
        elif token == ")":
            if len(stack) == 1:
                raise _fault("a bracket is closed that none opens", file, line, "remove the bracket")
            items, start = stack.pop()
            stack[-1][0].append(Expression(tuple(items), start))
        else:
            stack[-1][0].append(token)
    found = stack[0][0]
    if len(stack) > 1:
        raise _fault("a bracket is not closed", file, stack[-1][1], "close it")
    if len(found) != 1 or not isinstance(found[0], Expression):
        raise _fault(f"{len(found)} expressions, where one is expected", file, line, "one problem a file")
    return found[0]


def _tokens(text: str) -> Iterator[tuple[int, str]]:
    for number, line in enumerate(text.splitlines(), 1):
        for token in re.findall(r"[()]|[^\s()]+", line.partition(";")[0]):
            yield number, token.lower()


def _fault(message: str, file: str, line: int, suggestion: str) -> HearthError:
    return HearthError(Diagnostic(Code.SYNTAX, message, file, line, suggestion=suggestion))
