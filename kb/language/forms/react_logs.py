"""ReAct's logs: of `Thought:`, `Act:` and `Obs:` only the acts are steps."""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.alfworld_commands import command, doubted, rows_without_effect
from hearth.kb.language.forms.form import Form, Placed, step
from hearth.kb.language.operator_step_syntax import operator_step
from hearth.kb.language.plan_lines import plan_line

_ACT = re.compile(r"\s*(?:>\s*)?\**(?:act|action)\s*\d*\s*:\**\s*(.*)", re.IGNORECASE)
_OTHER = re.compile(r"\s*(?:>\s*)?\**(?:thought|think|obs|observation|reason(?:ing)?|reward)\s*\d*\s*:", re.IGNORECASE)
_NO_ACT = re.compile(r"(?:(?:finish|think|stop)\b.*|look(?: around)?|(?:check )?inventory|done)\W*", re.IGNORECASE)


def act_of(line: str) -> str | None:
    """Return the words of an act, `Action: open fridge 1`; None where a line is none."""
    act = _ACT.match(line)
    return act[1].strip() if act else None


def _fits(lines: Sequence[str]) -> bool:
    acts = sum(_ACT.match(line) is not None for line in lines)
    return acts > 1 or (acts == 1 and any(map(_OTHER.match, lines)))


def _lines(lines: Sequence[str]) -> list[Placed]:
    """Return the acts; what stands before the first act or thought is title and description."""
    found: list[Placed] = []
    begun, without_effect = False, rows_without_effect(lines)
    for row, raw in enumerate(lines):
        act = _ACT.match(raw)
        begun = begun or act is not None or _OTHER.match(raw) is not None
        if act and act[1].strip() and not _NO_ACT.fullmatch(act[1].strip()):
            meant = step(row, command(act[1][:300]) or operator_step(raw.strip()) or act[1])
            found.append(doubted(meant) if row in without_effect else meant)
        elif not begun:
            found.append(Placed(row, plan_line(raw)._replace(number=None, numbered=False)))
    return found


REACT = Form(
    _fits,
    _lines,
    lambda raw: _ACT.match(raw) is not None,
    re.compile(r"[\s#*]*(task\b|goal\b|question\b|your task is to:)", re.IGNORECASE),
)
