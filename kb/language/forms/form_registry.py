"""The forms in which steps are written, besides numbered and bulleted lines."""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.action_pairs import PAIRS
from hearth.kb.language.forms.alfworld_commands import COMMANDS
from hearth.kb.language.forms.code_calls import CODE
from hearth.kb.language.forms.commented_steps import COMMENTED
from hearth.kb.language.forms.form import Form
from hearth.kb.language.forms.operator_lines import OPERATORS
from hearth.kb.language.forms.order_dialogues import ORDERS
from hearth.kb.language.forms.org_mode import ORG_MODE
from hearth.kb.language.forms.outlines import OUTLINES
from hearth.kb.language.forms.pddl_plans import PDDL
from hearth.kb.language.forms.python_tuples import TUPLES
from hearth.kb.language.forms.quoted_lists import QUOTED
from hearth.kb.language.forms.react_logs import REACT
from hearth.kb.language.forms.robot_logs import SPEAKERS
from hearth.kb.language.forms.say_can_pay import SAY_CAN_PAY
from hearth.kb.language.forms.table_rows import TABLES
from hearth.kb.language.forms.text_games import PROMPTS
from hearth.kb.language.forms.titled_lines import TITLED_LINES
from hearth.kb.language.forms.todo_txt import TODO_LISTS
from hearth.kb.language.forms.yaml_lists import YAML
from hearth.kb.language.recognition_knowledge import recognized_cache

FORMS: dict[str, Form] = {
    "quoted list": QUOTED,
    "YAML": YAML,
    "tuples": TUPLES,
    "SayCanPay": SAY_CAN_PAY,
    "ReAct": REACT,
    "ALFWorld": COMMANDS,
    "prompts": PROMPTS,
    "PDDL": PDDL,
    "code": CODE,
    "Org mode": ORG_MODE,
    "todo.txt": TODO_LISTS,
    "orders": ORDERS,
    "speakers": SPEAKERS,
    "outlines": OUTLINES,
    "comments": COMMENTED,
    "titled lines": TITLED_LINES,
    "tables": TABLES,
    "pairs": PAIRS,
    "operators": OPERATORS,
}
"""Forms by name, in the order in which they are tried."""

_HINT = re.compile(
    r".*(?:->|→|@)|\s*[A-Z][a-z]+[A-Z]|\s*(?:- )?(?:steps|plan|actions|program):|\s*\*+ (?:TODO|DONE)|[^:]{0,40}:\s"
    r"|\s*x\s|\s*[\[(]?\d\d?\d?\d?[-./:].{8,40}:|\s*\[?(?:INFO|DEBUG|\d{9})|[a-z]{3}\s+\d+ \d+:\d\d"
    r"|\W*(?:\d+\W+)?(?-i:[A-Z_]{3,})|[(\[|]|\s*>|.*[│┃║&\t]|.*\S {3,}\S|[\w ]*\[|\s*<[A-Za-z]|[\w.]+\s*[{<]"
    r"|\s*<t[adr]|.*\s(?:#|//)\s|.*\s\|\s|[\s*]*act|.* \d{1,3}\.?\s*$|.*[(\[|]|\s{2,}[a-z]"
    r"|.*\bcharacter\b|(?!\s*\d)[^:=\d]{2,80}(?:[:=]|(?<= [-–—]) ).{0,400}(?:[,;>→]|then)",
    re.IGNORECASE,
).match
"""Tests whether a line has the marks of some form: most plans have none, so that no form is tried."""


def form_of(lines: Sequence[str]) -> Form | None:
    """Return the form that the lines of a text are written in; None for numbered, bulleted and bracketed lines."""
    if not any(map(_HINT, lines)):
        return None
    return next((form for form in FORMS.values() if form.fits(lines)), None)


def form_of_line(line: str) -> Form | None:
    """Return the form that a text of one line is written in; titles of plans are asked again and again."""
    return _form_of_short(line) if len(line) <= _SHORT else form_of([line])


_SHORT = 200


@recognized_cache(maxsize=16_384)
def _form_of_short(line: str) -> Form | None:
    return form_of([line])
