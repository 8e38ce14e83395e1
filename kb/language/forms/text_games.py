"""Games of text: what stands behind `>` was asked for, and the other lines are what the game answered."""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.alfworld_commands import command
from hearth.kb.language.forms.form import Form, Placed, remark, step
from hearth.kb.language.plan_lines import plan_line

_ASKED = re.compile(r"\s*>\s?(?=[A-Za-z])(?P<said>[^>]+)")


def _fits(lines: Sequence[str]) -> bool:
    """Return whether answers stand between two lines that begin with `>` at least; in a quotation none do.

    A game numbers no answers: numbered lines between two quotations are a plan with remarks of its readers.
    """
    texts = [line for line in lines if line.strip()]
    at = [n for n, line in enumerate(texts) if _ASKED.fullmatch(line)]
    if len(at) < 2:
        return False
    answers = [line for line in texts[at[0] : at[-1]] if not _ASKED.fullmatch(line)]
    return bool(answers) and all(plan_line(line).number is None for line in answers)


def _lines(lines: Sequence[str]) -> list[Placed]:
    found: list[Placed] = []
    begun = False
    for row, raw in enumerate(lines):
        asked = _ASKED.fullmatch(raw)
        begun = begun or asked is not None
        if asked:
            found.append(step(row, command(asked["said"].strip()[:300]) or asked["said"]))
        elif begun:
            found += [remark(row, raw)] if raw.strip() else []
        else:
            found.append(Placed(row, plan_line(raw)._replace(number=None, numbered=False)))
    return found


PROMPTS = Form(_fits, _lines, lambda raw: _ASKED.fullmatch(raw) is not None, re.compile(r"\s*(?:#|task\b.*:)", re.I))
