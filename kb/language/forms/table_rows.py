"""Tables of steps as text: those of Markdown and LaTeX, as databases print them, and columns between tabs."""

import itertools
import re
from collections.abc import Sequence
from typing import NamedTuple

from hearth.kb.language.action_keys import ACTIONS, INSTANCE, holds_object, names_action
from hearth.kb.language.forms.form import Form, Placed, step
from hearth.kb.language.plan_lines import plan_line
from hearth.kb.language.step_like_lines import is_like_step
from hearth.kb.language.steps_from_calls import composed_step

_BAR = r"[|│┃║]"
_BARS = re.compile(rf"\s*{_BAR}(?P<cells>.*){_BAR}\s*")
_INNER = re.compile(rf"\s*(?P<cells>[^|│┃║]+(?:{_BAR}[^|│┃║]*)+?)\s*")
_LATEX = re.compile(r"\s*(?P<cells>[^&\\]+(?:&[^&\\]*)+)\\\\\s*(?:\\\w+\s*)*")
_TABS = re.compile(r"(?P<cells>[^\t]*\S(?:\t+[^\t]+)+)")
_WIDE = re.compile(r"\s*(?P<cells>\S+(?: \S+)*(?:\s{2,}\S+(?: \S+)*)+)\s*")
_KINDS: dict[str, tuple[re.Pattern[str], re.Pattern[str]]] = {
    "bars": (_BARS, re.compile(_BAR)),
    "LaTeX": (_LATEX, re.compile("&")),
    "tabs": (_TABS, re.compile(r"\t+")),
    "inner bars": (_INNER, re.compile(_BAR)),
    "blanks": (_WIDE, re.compile(r"\s{2,}")),
}
"""Rows by the mark between their cells, the surest first: the row, and the mark."""

_RULE = re.compile(
    r"\s*[|│┃║┌├└┏┣┗╔╠╚+]?[\s:]*[-=─━═]{2,}[\s:|│┃║+┬┼┴┳╋┻╦╬╩┐┤┘┓┫┛╗╣╝─━═=-]*\s*|\s*\\(?:hline|toprule|midrule|bottomrule|(?:begin|end)\{.*)\s*"
)
_RULED = frozenset({"bars", "LaTeX", "tabs"})
"""Kinds that need no rule."""

_COUNT = re.compile(r"\(?\d{1,4}[.):]?|\d{1,2}[:.]\d\d(?:[:.]\d\d)?(?:\s?[ap]m)?|")
_NAMED = re.compile(
    r"(?:actions?|steps?|what(?: to do)?|instructions?|do|tasks?|activit(?:y|ies)|verbs?|commands?|move)", re.IGNORECASE
)
_COUNTS = re.compile(
    r"(?:#|n|no\.?|nr\.?|nbr|num(?:ber)?|step(?: (?:no\.?|number|#))?|order|index|idx|i|id|time|when|at|start)", re.I
)
_RELATION = re.compile(r"(?P<word>onto|on top of|on|into|inside|in|to|from|at|with)\s+(?=\S)", re.IGNORECASE)
_WORDS = re.compile(r"[^\W\d_]{2}")
_MOST = 1_000


_HINT = re.compile(r".*[|│┃║\t&]|.*\S\s{2,}\S").match
"""Tests that a line may be a row."""


class _Table(NamedTuple):
    """The mark between the cells of a table, and the names of its columns; none where it has no head."""

    kind: str
    head: tuple[str, ...]


def _cells(raw: str, kind: str) -> list[str]:
    row, between = _KINDS[kind]
    found = row.fullmatch(raw) if len(raw) <= _MOST else None
    return [cell.strip().strip("*`").strip() for cell in between.split(found["cells"])] if found else []


def _is_rule(raw: str) -> bool:
    return len(raw) <= _MOST and _RULE.fullmatch(raw) is not None


def _table(lines: Sequence[str]) -> _Table | None:
    """Return the table of steps in a text, which has a rule, or several rows of a kind with as many cells."""
    if not any(map(_HINT, lines)):
        return None
    has_rule = any(map(_is_rule, lines))
    for kind in _KINDS:
        rows = [cells for line in lines if not _is_rule(line) and (cells := _cells(line, kind))]
        if not rows or not (has_rule or (kind in _RULED and len(rows) > 1)):
            continue
        head = _head(lines, kind, rows)
        steps = [_step(row, head) for row in rows[bool(head) :]]
        like = sum(each.startswith("[") or is_like_step(each) for each in steps)
        is_sure = kind == "bars" and has_rule
        if steps and (is_sure or (len(steps) > 1 and 3 * like >= 2 * len(steps))) and _is_most(len(rows), lines, kind):
            return _Table(kind, head)
    return None


def _is_most(rows: int, lines: Sequence[str], kind: str) -> bool:
    """Return whether rows of words between blanks are most of a text: other lines may have wide gaps, too."""
    texts = sum(bool(line.strip()) and not _is_rule(line) for line in lines)
    return kind in ("bars", "LaTeX") or 3 * rows >= 2 * texts


def _head(lines: Sequence[str], kind: str, rows: Sequence[list[str]]) -> tuple[str, ...]:
    """Return the names of columns: the row above the first rule, or the first row if it is made of such names."""
    for above, line in itertools.pairwise(lines):
        if _is_rule(line) and (cells := _cells(above, kind)) and cells == rows[0]:
            return tuple(cells)
    names = [cell for cell in rows[0] if cell]
    is_head = any(map(_NAMED.fullmatch, names)) and not any(map(_COUNT.fullmatch, names))
    return tuple(rows[0]) if is_head and all(map(_is_name, names)) else ()


def _is_name(cell: str) -> bool:
    return bool(
        _NAMED.fullmatch(cell) or _COUNTS.fullmatch(cell) or holds_object(cell) or cell.lower() in ACTIONS
    ) or bool(INSTANCE.fullmatch(cell))


def _step(cells: Sequence[str], head: Sequence[str]) -> str:
    """Return the step of a row: the cells of an action and its things, or the one of words."""
    at = _column(cells, head)
    words = cells[at] if at < len(cells) else ""
    things = _things(cells, head, at)
    if things and words:
        relation, names = "", []
        for thing in things:
            found = _RELATION.match(thing)
            relation = found["word"].lower() if found else relation
            names.append(thing[found.end() :] if found else thing)
        if names_action(words, names) or not relation:
            return composed_step(words, names, relation.removesuffix(" top of"))
        return " ".join([words, *things])
    return words if _WORDS.search(words) else next((cell for cell in cells if _WORDS.search(cell)), "")


def _column(cells: Sequence[str], head: Sequence[str]) -> int:
    """Return the column of the action or the sentence: by its name, else the first of words."""
    named = [n for n, name in enumerate(head) if _NAMED.fullmatch(name)]
    worded = [n for n in named if n < len(cells) and _WORDS.search(cells[n])]
    if worded:
        return worded[-1]
    return next((n for n, cell in enumerate(cells) if not _COUNT.fullmatch(cell)), 0)


def _things(cells: Sequence[str], head: Sequence[str], at: int) -> list[str]:
    """Return the cells of things: by the names of their columns, else those behind a known action."""
    if head:
        things = [n for n, name in enumerate(head) if n != at and holds_object(name)]
        return [_thing(cells, head, n) for n in things if n < len(cells) and _WORDS.search(cells[n])]
    behind = [cell for cell in cells[at + 1 :] if cell]
    return behind if 0 < len(behind) < _FEW and names_action(cells[at], behind) else []


def _thing(cells: Sequence[str], head: Sequence[str], at: int) -> str:
    """Return the cell of a thing with the instance in the column behind it, `cup 2`."""
    behind = at + 1
    is_counted = behind < min(len(head), len(cells)) and INSTANCE.fullmatch(head[behind])
    return f"{cells[at]} {cells[behind]}" if is_counted and cells[behind].isdecimal() else cells[at]


_FEW = 4


def _lines(lines: Sequence[str]) -> list[Placed]:
    """Return the rows below the head as steps."""
    table = _table(lines)
    found: list[Placed] = []
    if table is None:
        return found
    is_open, was_head = not table.head, False
    for row, raw in enumerate(lines):
        cells = [] if _is_rule(raw) else _cells(raw, table.kind)
        if _is_rule(raw):
            is_open = is_open or was_head
        elif cells and table.head and (cells == list(table.head) or not is_open):
            is_open = is_open or not any(map(_is_rule, lines))
        elif cells and is_open and (words := _step(cells, table.head)):
            found.append(step(row, words))
        elif not cells:
            is_open = is_open if not raw.strip() or not table.head else not any(map(_is_rule, lines))
            found.append(Placed(row, plan_line(raw)))
        was_head = bool(cells)
    return found


TABLES = Form(
    lambda lines: _table(lines) is not None,
    _lines,
    lambda raw: any(_cells(raw, kind) for kind in _RULED),
    re.compile(r"\s*(?:#|\**task\b.*:)", re.IGNORECASE),
)
