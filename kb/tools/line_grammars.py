"""Grammars of lines, and the forms in which engines of constrained decoding take them: GBNF, Lark, regular expressions.

A grammar is a list of alternatives for a line; each is texts and choices in turn. Choices that many alternatives share
are written once: 84 actions with 502 classes have 38 different sets of arguments.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


@dataclass(frozen=True)
class Group:
    """Several ways to go on, each parts in turn.

    Attributes:
        alternatives: the ways.
    """

    alternatives: tuple[tuple[Part, ...], ...]


Part = str | tuple[str, ...] | Group
"""A text, a choice of texts, or a group."""


@dataclass(frozen=True)
class LineGrammar:
    """The lines that may be written.

    Attributes:
        alternatives: for a line, each parts in turn; none of a choice without texts.
        most: lines, at most; there is always one.
    """

    alternatives: tuple[tuple[Part, ...], ...]
    most: int = 1

    @property
    def named(self) -> dict[Part, str]:
        """Return a name for each different choice and group, in order; groups come after those within them."""
        found: dict[Part, str] = {}

        def name(parts: Sequence[Part]) -> None:
            for part in parts:
                if isinstance(part, Group):
                    for inner in part.alternatives:
                        name(inner)
                    found.setdefault(part, f"g{len(found)}")
                elif not isinstance(part, str):
                    found.setdefault(part, f"c{len(found)}")

        for parts in self.alternatives:
            name(parts)
        return found


def line_grammar(alternatives: Iterable[Sequence[Part]], most: int = 1) -> LineGrammar:
    """Return a grammar without alternatives that nothing fits, such as an action for which there is no object.

    Raises:
        HearthError: EMPTY: nothing is left.
    """
    kept = possible(alternatives)
    if not kept:
        raise HearthError.of(Code.EMPTY, "nothing may be written, so there is no grammar")
    return LineGrammar(kept, most)


def possible(alternatives: Iterable[Sequence[Part]]) -> tuple[tuple[Part, ...], ...]:
    """Return the alternatives without those that have an empty choice or group."""
    return tuple(
        tuple(parts)
        for parts in alternatives
        if all(part.alternatives if isinstance(part, Group) else part for part in parts)
    )


def gbnf(grammar: LineGrammar) -> str:
    """Return a grammar as llama.cpp takes it."""
    names = grammar.named
    more = f' ("\\n" line){{0,{grammar.most - 1}}}' if grammar.most > 1 else ""
    lines = [f"root ::= line{more}", f"line ::= {_ways(grammar.alternatives, names)}"]
    for part, name in names.items():
        ways = _ways(part.alternatives, names) if isinstance(part, Group) else " | ".join(map(_quoted, part))
        lines.append(f"{name} ::= {ways}")
    return "\n".join(lines) + "\n"


def lark(grammar: LineGrammar) -> str:
    """Return a grammar as Lark and llguidance take it: choices are terminals."""
    names = {part: name if isinstance(part, Group) else name.upper() for part, name in grammar.named.items()}
    more = f' ("\\n" line){{0,{grammar.most - 1}}}' if grammar.most > 1 else ""
    lines = [f"start: line{more}", f"line: {_ways(grammar.alternatives, names)}"]
    for part, name in names.items():
        lines.append(f"{name}: {_ways(part.alternatives, names) if isinstance(part, Group) else f'/{trie(part)}/'}")
    return "\n".join(lines) + "\n"


def _ways(alternatives: Sequence[Sequence[Part]], names: Mapping[Part, str]) -> str:
    """Return alternatives as GBNF and Lark both have them."""
    said = (
        " ".join(_quoted(part) if isinstance(part, str) else names[part] for part in parts) for parts in alternatives
    )
    return " | ".join(said)


def regex(grammar: LineGrammar) -> str:
    """Return a grammar as a regular expression, in the syntax that all dialects share."""
    line = _either(grammar.alternatives)
    return line if grammar.most == 1 else rf"{line}(?:\n{line}){{0,{grammar.most - 1}}}"


def _either(alternatives: Sequence[Sequence[Part]]) -> str:
    found = ["".join(map(_pattern, parts)) for parts in alternatives]
    return f"(?:{'|'.join(found)})" if len(found) > 1 else found[0]


def _pattern(part: Part) -> str:
    if isinstance(part, Group):
        return _either(part.alternatives)
    return _escaped(part) if isinstance(part, str) else trie(part)


def lines_schema(grammar: LineGrammar, field: str = "command") -> dict[str, Any]:
    """Return the JSON schema of an object whose field is a line of a grammar of single lines, all of them listed."""
    every = [text for parts in grammar.alternatives for text in _texts(parts)]
    return {
        "type": "object",
        "properties": {field: {"enum": every}},
        "required": [field],
        "additionalProperties": False,
    }


def _texts(parts: Sequence[Part]) -> list[str]:
    found = [""]
    for part in parts:
        if isinstance(part, Group):
            ways = [text for inner in part.alternatives for text in _texts(inner)]
        else:
            ways = [part] if isinstance(part, str) else list(part)
        found = [text + each for text in found for each in ways]
    return found


FORMS: Mapping[str, Callable[[LineGrammar], str]] = {
    "gbnf": gbnf,
    "lark": lark,
    "regex": regex,
    "schema": lambda grammar: json.dumps(lines_schema(grammar)),
}
"""The forms of a grammar of lines."""


def written(grammar: LineGrammar, form: str) -> str:
    """Return a grammar in one of `FORMS`.

    Raises:
        HearthError: BAD_ARGUMENT: there is no such form.
    """
    if form not in FORMS:
        message = f"there is no form of grammars `{form[:40]}`"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=", ".join(FORMS))
    return FORMS[form](grammar)


def trie(texts: Sequence[str]) -> str:
    """Return a regular expression of some texts in which common beginnings stand once."""
    root: dict[str, Any] = {}
    for text in texts:
        at = root
        for letter in text:
            at = at.setdefault(letter, {})
        at[""] = {}
    return _branches(root)


def _branches(at: Mapping[str, Any]) -> str:
    parts = [_run(letter, below) for letter, below in at.items() if letter]
    if not parts:
        return ""
    one = len(parts) == 1 and ("" not in at)
    return parts[0] if one else f"(?:{'|'.join(parts)}){'?' if '' in at else ''}"


def _run(letter: str, below: Mapping[str, Any]) -> str:
    """Return a letter and all that follows, as long as only one thing may: a long text needs no recursion."""
    found = [_escaped(letter)]
    while len(below) == 1 and "" not in below:
        ((letter, below),) = below.items()
        found.append(_escaped(letter))
    return "".join(found) + _branches(below)


def _escaped(text: str) -> str:
    """Return a text for a regular expression; `re.escape` writes escapes of spaces that other dialects refuse."""
    return re.sub(r"([\\.^$*+?()\[\]{}|/-])", r"\\\1", text).replace("\n", r"\n")


def _quoted(text: str) -> str:
    r"""Return a text in quotes, as GBNF and Lark have it: with escapes of `"`, `\` and of unprintable characters."""
    return json.dumps(text, ensure_ascii=False)
