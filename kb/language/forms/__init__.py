"""The forms in which steps are written, besides numbered and bulleted lines."""

from collections.abc import Sequence

from hearth.kb.language.forms.code import CODE
from hearth.kb.language.forms.commands import COMMANDS
from hearth.kb.language.forms.form import Form
from hearth.kb.language.forms.markdown_tables import MARKDOWN_TABLE
from hearth.kb.language.forms.pddl import PDDL
from hearth.kb.language.forms.quoted import QUOTED
from hearth.kb.language.forms.react import REACT
from hearth.kb.language.forms.say_can_pay import SAY_CAN_PAY

FORMS: dict[str, Form] = {
    "quoted list": QUOTED,
    "SayCanPay": SAY_CAN_PAY,
    "ReAct": REACT,
    "ALFWorld": COMMANDS,
    "PDDL": PDDL,
    "code": CODE,
    "Markdown table": MARKDOWN_TABLE,
}
"""Forms by name, in the order in which they are tried."""


def form_of(lines: Sequence[str]) -> Form | None:
    """Return the form that the lines of a text are written in; None for numbered, bulleted and bracketed lines."""
    return next((form for form in FORMS.values() if form.fits(lines)), None)
