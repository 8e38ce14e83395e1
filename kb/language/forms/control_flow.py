"""Control flow in plans as code: loops over literals are unrolled; a line that decides while it runs is refused."""

import ast
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from hearth.kb.language.forms.code_blocks import end_of_block, indent
from hearth.kb.language.refusals import Refusal

ThingNames = Mapping[str, str | None]
"""The thing that each variable stands for; None where only a run would tell."""


class CodeLine(NamedTuple):
    """A line of code in the order in which it runs, with the variables before it, and why it is refused."""

    row: int
    text: str
    names: ThingNames
    why: Refusal | None = None


CodeRows = Sequence[tuple[int, str]]

_MOST = 100
"""Rounds of a loop at most that are unrolled."""

_REMEDY = "write the steps one below another, as they are to be done"
_DEF = re.compile(r"\s*(?:async\s+)?def\s+(\w+)\s*\((.*)")
_FOR = re.compile(r"\s*for\s+(\w+)\s+in\s+(.+?)\s*:\s*(\S.*)?")
_HEAD = re.compile(
    r"\s*(?P<word>(?:async\s+)?(?:for|while|if|elif|else|try|except|finally|with|match|case|switch|repeat|until|do))\b"
    r"(?P<rest>.*[:{].*)"
)
_ALWAYS = re.compile(r"\s*if\s+\(?(?:True|1)\)?\s*:\s*(\S.*)?")
"""A condition that holds always: its lines are done once, and those of its `else` never."""

_MAIN = re.compile(r"\s*if\s+__name__\s*==")
_CLAUSE = re.compile(r"\s*(?:elif|else|except|finally)\b")
_ASSERT = re.compile(r"\s*assert\b")
_ELSE = re.compile(r"\s*else\s*:")
_LEAVES = re.compile(r"\s*(return|break|continue|raise)\b")
_BLANK = re.compile(r"\s*(?:#|//|$)")
_INLINE = re.compile(r"\)\s*(if|for|and|or)\b|^\s*(not|lambda)\b")
_QUOTED = re.compile(r"\"[^\"]*\"|'[^']*'")
_ASSIGNED = re.compile(r"\s*(?:await\s+)?(\w+)\s*=\s*(?:await\s+)?(?:\w+\.)*\w+\((.*)\)\s*;?\s*(?:#.*)?")
_REASONS = {
    "for": "the loop goes over neither a written list nor `range` of a number",
    "while": "a `while` runs until something changes, which a list of steps cannot say",
    "with": "a `with` is not a step, and its lines depend on it",
    "try": "a `try` has steps that are done only if others fail",
}
_DECIDES = "this line decides while it runs which steps are done"


def in_order(lines: Sequence[str]) -> list[CodeLine]:
    """Return the lines of a plan in the order in which they run, each with why it is refused, if it is."""
    return list(_run(list(enumerate(lines)), {}))


def _run(lines: CodeRows, names: ThingNames) -> Iterator[CodeLine]:
    at, names, is_asserted = 0, dict(names), False
    texts = [raw for _, raw in lines]
    while at < len(lines):
        row, raw = lines[at]
        at += 1
        if _BLANK.match(raw):
            continue
        if named := _DEF.match(raw):
            names |= dict.fromkeys(_parameters(named[2]))
        head = None if is_asserted and _ELSE.match(raw) else _HEAD.fullmatch(raw)
        is_asserted = _ASSERT.match(raw) is not None or (is_asserted and _ELSE.match(raw) is not None)
        if head and not _MAIN.match(raw):
            end = end_of_block(texts, at, indent(raw))
            yield from _compound(row, raw, lines[at:end], names, head["word"].split()[-1])
            at = end
            while at < len(lines) and _CLAUSE.match(texts[at]) and indent(texts[at]) == indent(raw):
                at = end_of_block(texts, at + 1, indent(raw))
        elif not head:
            yield CodeLine(row, raw, dict(names), _why_plain(raw, lines[at:]))
            if assigned := _ASSIGNED.fullmatch(raw):
                names[assigned[1]] = _thing(assigned[2], names)


def _compound(row: int, raw: str, body: CodeRows, names: ThingNames, word: str) -> Iterator[CodeLine]:
    """Yield the lines of a loop over literals, round by round, and of `if True:`; else the refused head."""
    if always := _ALWAYS.fullmatch(raw):
        yield from _run([(row, always[1]), *body] if always[1] else body, names)
        return
    loop = _FOR.fullmatch(raw)
    values = _values(loop[2]) if loop else None
    if loop is None or values is None:
        yield CodeLine(row, raw, names, Refusal(_REASONS.get(word, _DECIDES), _REMEDY))
        return
    if len(values) > _MOST:
        yield CodeLine(row, raw, names, Refusal(f"a loop of {len(values):,} rounds, at most {_MOST}", _REMEDY))
        return
    inside = [(row, loop[3]), *body] if loop[3] else body
    for value in values:
        yield from _run(inside, {**names, loop[1]: value})


def _values(listed: str) -> list[str | None] | None:
    """Return the values of a literal list of texts or numbers, or of `range(3)`; None for anything else."""
    try:
        found = ast.parse(listed.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
    if isinstance(found, ast.Call) and isinstance(found.func, ast.Name) and found.func.id == "range":
        numbers = [each.value for each in found.args if isinstance(each, ast.Constant)]
        if len(numbers) != len(found.args) or not 1 <= len(numbers) <= 3 or found.keywords:
            return None
        if not all(type(number) is int and abs(number) < _LARGEST for number in numbers) or numbers[2:] == [0]:
            return None
        return [None] * len(range(*numbers))  # type: ignore[arg-type]
    entries = found.elts if isinstance(found, ast.List | ast.Tuple) else []
    constants = [each.value for each in entries if isinstance(each, ast.Constant) and type(each.value) in (str, int)]
    if not constants or len(constants) != len(entries):
        return None
    return [each if isinstance(each, str) else None for each in constants]


_LARGEST = 1_000_000


def _why_plain(raw: str, below: CodeRows) -> Refusal | None:
    """Return why a line that holds no other lines is refused."""
    if leaves := _LEAVES.match(raw):
        follows = any(not _BLANK.match(line) and not _DEF.match(line) for _, line in below)
        if leaves[1] in ("break", "continue") or (follows and indent(raw)):
            return Refusal(f"the lines below this `{leaves[1]}` are not always done", _REMEDY)
        return None
    return Refusal(_DECIDES, _REMEDY) if _INLINE.search(_QUOTED.sub("''", raw)) and not _ASSERT.match(raw) else None


def _parameters(text: str) -> list[str]:
    """Return the names of a function's parameters."""
    return re.findall(r"(?:^|,)\s*\*{0,2}(\w+)", text.partition(")")[0])


def _thing(arguments: str, names: ThingNames) -> str | None:
    """Return the one thing of a call whose result has a name."""
    found = arguments.strip()
    if found in names:
        return names[found]
    return found.strip("\"'") if re.fullmatch(r"\w+|\"[^\"']+\"|'[^\"']+'", found) else None
