"""A list of texts as JSON and Python print it: `["[Walk] <fridge> (1)", "Open fridge"]`."""

import ast
import re
from collections.abc import Sequence

from hearth.kb.language.forms.form import Form, Placed, step
from hearth.kb.language.plan_lines import plan_line

_LONGEST = 100_000


def _texts(lines: Sequence[str]) -> list[str]:
    """Return the texts of the list; none where the lines are not one."""
    text = "\n".join(lines).strip()
    if not (text.startswith(('["', "['")) and text.endswith("]") and len(text) <= _LONGEST):
        return []
    try:
        value = ast.literal_eval(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return []
    return value if isinstance(value, list) and all(isinstance(each, str) for each in value) else []


def _lines(lines: Sequence[str]) -> list[Placed]:
    found: list[Placed] = []
    row = 0
    for text in _texts(lines):
        row = next((at for at in range(row, len(lines)) if text[:40] in lines[at]), row)
        read = plan_line(text)
        found.append(Placed(row, read) if read.bracketed else step(row, read.text))
    return found


QUOTED = Form(lambda lines: bool(_texts(lines)), _lines, lambda raw: True, re.compile(r"(?!)"))
