"""Functions in plans as code: one is a plan; those that it calls, or that it repeats itself by, are refused."""

import itertools
import re
from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

from hearth.kb.language.forms.code_blocks import end_of_block, indent
from hearth.kb.language.refusals import Refusal

_DEF = re.compile(r"(\s*)(?:async\s+)?def\s+(\w+)\s*\(")
_CALLED = re.compile(r"(\w+)\s*\(")
_RUN = re.compile(r"(?:await\s+|asyncio\.run\()?(?:\w+\.)?(\w+)\([^()]*\)\)?\s*;?\s*(?:#.*)?")
_MAIN = re.compile(r"if\s+__name__\s*==")
_SPOKEN = re.compile(r"\s*(?:#|//|\"{3}|'{3}|@|$)")
_IDLE = re.compile(r"\s*(?:pass|\.\.\.|return\b.*|print\(.*|\"{3}.*|'{3}.*|#.*|raise\b.*|logging\.\w+\(.*)?")
_ONE_LINE = re.compile(r"[^:]*\)\s*(?:->[^:]*)?:\s*(?:pass|\.\.\.|#.*)?\s*")
_SECOND = Refusal("a second function in one record", "write each plan as a record of its own")


class Functions(NamedTuple):
    """The lines of code without those that only define or start it, and the functions that hold steps.

    Attributes:
        lines: of the code; those left out are empty.
        names: the functions that hold steps, with the row on which each begins.
        called: those among them that a line calls.
    """

    lines: list[str]
    names: dict[str, int]
    called: frozenset[str]

    def why(self, raw: str, row: int) -> Refusal | None:
        """Return why a line is refused: it calls a function of the code, or begins a second one."""
        named = _DEF.match(raw)
        if named:
            is_second = not self.called and row > min(self.names.values(), default=row)
            return _SECOND if is_second else None
        found = next((name for name in _CALLED.findall(raw) if name in self.called), None) if self.called else None
        if not found or _SPOKEN.match(raw):
            return None
        return Refusal(f"it calls `{found}`, a function of this code", f"write the steps of `{found}` in its place")


def plan_of(lines: Sequence[str]) -> Functions:
    """Return the lines of a plan: empty where they define an action that has no steps, or only start a function."""
    starts = [row for row, raw in enumerate(lines) if _DEF.match(raw)]
    if not starts:
        return Functions(list(lines), {}, frozenset())
    bodies = {row: range(row, end_of_block(lines, row + 1, indent(lines[row]))) for row in starts}
    names = {row: _DEF.match(lines[row])[2] for row in starts}  # type: ignore[index]
    inside = set(itertools.chain.from_iterable(bodies.values()))
    calls = Counter(
        name for row, raw in enumerate(lines) if row not in bodies and not _SPOKEN.match(raw)
        for name in _CALLED.findall(raw)
    )  # fmt: skip
    idle = {row for row in starts if calls[names[row]] and _is_idle([lines[n] for n in bodies[row]])}
    outside = [row for row in range(len(lines)) if row not in inside and not _SPOKEN.match(lines[row])]
    runs = [row for row in outside if (run := _RUN.fullmatch(lines[row].strip())) and run[1] in names.values()]
    others = [row for row in outside if row > starts[0] and row not in runs and not _MAIN.match(lines[row])]
    started = Counter(_RUN.fullmatch(lines[row].strip())[1] for row in runs)  # type: ignore[index]
    left_out = {n for row in idle for n in bodies[row]}
    if not others and all(count == 1 and calls[name] == 1 for name, count in started.items()):
        left_out |= set(outside) - set(range(starts[0]))
        calls -= started
    kept = {names[row]: row for row in starts if row not in idle}
    return Functions(
        ["" if row in left_out else raw for row, raw in enumerate(lines)],
        kept,
        frozenset(name for name in kept if calls[name]),
    )


def _is_idle(body: Sequence[str]) -> bool:
    """Return whether a function has no steps, as one that only stands for an action."""
    first, *rest = body
    return (_ONE_LINE.fullmatch(first) is not None) and all(map(_IDLE.fullmatch, rest))
