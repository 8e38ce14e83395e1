"""Items that stand below a step: whether the step only heads them."""

import re
from collections.abc import Sequence

from hearth.kb.language.plan_lines import PlanLine
from hearth.kb.language.step_like_lines import is_like_step
from hearth.kb.language.title_marks import GOES

_WORD = re.compile(r"[a-z]+")
_SMALL = frozenset(("the", "a", "an", "my", "your", "to", "of"))


def is_head(line: PlanLine, below: Sequence[PlanLine]) -> bool:
    """Return whether a step only names the items below it, `Get the milk`: they begin with a walk, or repeat it."""
    if line.heading or line.bracketed:
        return False
    items: list[str] = []
    for each in below:
        if each.text and (each.number is None or each.heading or each.indent <= line.indent):
            break
        items += [each.text] if each.text else []
    if len(items) < 2 or not all(map(is_like_step, items)):
        return False
    if GOES.match(items[0]):
        return True
    return any(_words(line.text) <= _words(item) for item in items)


def _words(text: str) -> set[str]:
    return set(_WORD.findall(text.lower())) - _SMALL
