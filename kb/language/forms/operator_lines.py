"""Lines that are actions with their things in any brackets, `Walk[kitchen]`, elements of XML, or a list of them."""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.form import Form, Placed, step
from hearth.kb.language.operator_step_syntax import operator_step
from hearth.kb.language.plan_lines import PlanLine, plan_line
from hearth.kb.language.step_like_lines import is_like_step
from hearth.kb.language.steps_in_a_line import listed

_ITEM = re.compile(r"\s*(?:[-*+•]|(?:step\s*)?\d{1,3}\s*[.):])\s+", re.IGNORECASE)
_LAYOUT = re.compile(r"[\w ]{0,40}[=:]?\s?[\[({]|[\])};,]{1,9}|[A-Z]{3,8}|</?\w+[^<>]*>|`{3}.*|#.*|")
_PROGRAM = re.compile(r"\s*(?:<\w+>\s*)?\[[A-Za-z ]+\]\s*(?:<|$)")
"""A step in the syntax of programs, which is read as such."""

_SHARE = 0.6
_FEWEST = 2


def _steps(raw: str) -> list[str]:
    if _PROGRAM.match(raw):
        return []
    text = _ITEM.sub("", raw, count=1).strip()
    one = operator_step(text)
    return [one] if one else [operator_step(each) or each for each in listed(text.rstrip(";"))]


def _fits(lines: Sequence[str]) -> bool:
    """Return whether most lines are such actions, and there are two at least."""
    texts = [line for line in lines if not _LAYOUT.fullmatch(line.strip()) or _steps(line)]
    found = [steps for line in texts if (steps := _steps(line))]
    return sum(map(len, found)) >= _FEWEST and len(found) >= _SHARE * len(texts)


def _lines(lines: Sequence[str]) -> list[Placed]:
    found: list[Placed] = []
    begun = False
    tags = {tag[1] for raw in lines if (tag := _TAG.match(raw)) and _steps(raw)}
    for row, raw in enumerate(lines):
        steps, read = _steps(raw), plan_line(raw)
        tag = _TAG.match(raw)
        if steps:
            found += [step(row, each) for each in steps]
        elif (tag and tag[1] in tags) or (read.numbered and read.text and not read.heading):
            found.append(step(row, read.text or raw))
        elif read.heading or not read.text or not begun:
            found.append(Placed(row, read._replace(number=None, numbered=False)))
        elif _LAYOUT.fullmatch(raw.strip()) and not _ELEMENT.match(raw):
            found.append(Placed(row, PlanLine("")))
        elif read.number is not None or _ELEMENT.match(raw) or is_like_step(read.text):
            found.append(step(row, read.text or raw))
        else:
            found.append(Placed(row, read))
        begun = begun or bool(steps)
    return found


_TAG = re.compile(r"\s*<(\w+)\s[^<>]*/>\s*$")
"""An element without contents, whose attributes are an action and its things where it is a step."""

_ELEMENT = re.compile(r"\s*<\w+[^<>]*/>|\s*[A-Z]{3,}\s+\S")

OPERATORS = Form(_fits, _lines, lambda raw: bool(_steps(raw)), re.compile(r"\s*(?:#|\**task\b.*:)", re.IGNORECASE))
