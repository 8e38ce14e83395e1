"""Numbered titles with plain steps below them, which stand farther in: `1) Rest`, then `     sit on sofa`."""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.form import Form, Placed, step, title
from hearth.kb.language.plan_lines import plan_line
from hearth.kb.language.step_like_lines import is_like_step

_TITLE = re.compile(r"\d{1,3}[.)]\s+(\S.*)")
_STEP = re.compile(r"(?:\s{2,}|\t)\s*([A-Za-z][^.:!?]*)")
_GOING = re.compile(r"\d{1,3}[.)]\s+(?:walk|go|head|move|run)\b", re.IGNORECASE)
"""A line about going somewhere is a step with others below it, and no title."""

_SHARE = 0.7
_FEWEST = 2


def _fits(lines: Sequence[str]) -> bool:
    """Return whether lines are such titles and steps alone, most titles with two steps at least below them."""
    texts = [line for line in lines if line.strip()]
    titles = [n for n, line in enumerate(texts) if _TITLE.fullmatch(line)]
    steps = [found[1] for line in texts if (found := _STEP.fullmatch(line))]
    if any(map(_GOING.match, texts)) or not titles or titles[0] or len(titles) + len(steps) < len(texts):
        return False
    enough = sum(end - start > _FEWEST for start, end in zip(titles, [*titles[1:], len(texts)], strict=True))
    return enough > len(titles) / 2 and sum(map(is_like_step, steps)) >= _SHARE * len(steps)


def _lines(lines: Sequence[str]) -> list[Placed]:
    found = []
    for row, raw in enumerate(lines):
        named, below = _TITLE.fullmatch(raw), _STEP.fullmatch(raw)
        if named:
            found.append(title(row, named[1]))
        else:
            found.append(step(row, below[1]) if below else Placed(row, plan_line(raw)))
    return found


OUTLINES = Form(_fits, _lines, lambda raw: _STEP.fullmatch(raw) is not None, _TITLE)
