"""Blocks of SayCanPay: `[Goal] read book.` above `[Step 1] grab novel.`"""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.form import Form, Placed, step, title
from hearth.kb.language.plan_lines import PlanLine

_STEP = re.compile(r"\s*\[\s*step\s*\d+\s*\]\s*(.*)", re.IGNORECASE)
_FIELD = re.compile(r"\s*\[\s*(goal|scene|description|env\w*|initial state|task)\s*\]\s*(.*)", re.IGNORECASE)


def _fits(lines: Sequence[str]) -> bool:
    return any(map(_STEP.match, lines))


def _lines(lines: Sequence[str]) -> list[Placed]:
    found: list[Placed] = []
    for row, raw in enumerate(lines):
        own, field = _STEP.match(raw), _FIELD.match(raw)
        if own:
            found.append(step(row, own[1].strip().rstrip(".")))
        elif field and field[1].lower() in ("goal", "task"):
            found.append(title(row, field[2].strip().rstrip(".")))
        elif field and field[1].lower() == "description":
            found.append(Placed(row, PlanLine(field[2].strip())))
        elif not field and raw.strip():
            found.append(Placed(row, PlanLine(" ".join(raw.split()))))
    return found


SAY_CAN_PAY = Form(_fits, _lines, _FIELD)
