"""Blocks of SayCanPay: `[Goal] read book.` above `[Step 1] grab novel.`"""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.form import Form, Placed, step, title
from hearth.kb.language.plan_lines import PlanLine

_STEP = re.compile(r"\s*\[\s*step\s*\d+\s*\]\s*(.*)", re.IGNORECASE)
_FIELD = re.compile(r"\s*\[\s*(goal|scene|description|env\w*|initial state|task)\s*\]\s*(.*)", re.IGNORECASE)


_GOAL = re.compile(r"\s*\[\s*goal\s*\]\s", re.IGNORECASE)
_SHORT = re.compile(r"(walk|run|go|sit|lie)(?= (?!to\b|into\b|towards\b|on\b|in\b|down\b|at\b))", re.IGNORECASE)
"""The beginning of `walk sofa`, `sit sofa`, which name no preposition."""


def _whole(verb: re.Match[str]) -> str:
    return f"{verb[1]} {'on' if verb[1].lower() in ('sit', 'lie') else 'to'}"


def _fits(lines: Sequence[str]) -> bool:
    return any(_STEP.match(line) or _GOAL.match(line) for line in lines)


def _lines(lines: Sequence[str]) -> list[Placed]:
    found: list[Placed] = []
    for row, raw in enumerate(lines):
        own, field = _STEP.match(raw), _FIELD.match(raw)
        if own:
            words = " ".join(own[1].split()).rstrip(".")
            found.append(step(row, _SHORT.sub(_whole, words)))
        elif field and field[1].lower() in ("goal", "task"):
            found.append(title(row, field[2].strip().rstrip(".")))
        elif field and field[1].lower() == "description":
            found.append(Placed(row, PlanLine(field[2].strip())))
        elif not field and raw.strip():
            found.append(Placed(row, PlanLine(" ".join(raw.split()))))
    return found


SAY_CAN_PAY = Form(_fits, _lines, lambda raw: _STEP.match(raw) is not None, _FIELD)
