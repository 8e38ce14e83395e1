"""Plans as planners of PDDL print them: `(walk_towards character washing_machine)`."""

import re
from collections.abc import Sequence

from hearth.kb.language.forms.form import Form, Placed, step
from hearth.kb.language.plan_lines import plan_line
from hearth.kb.language.program_names import action_of
from hearth.kb.language.recognition_knowledge import recognition
from hearth.kb.language.steps_from_calls import written

_STEP = re.compile(
    r"\s*(?:(?:step\s*)?\d+(?:\.\d+)?\s*[:.)]\s*)?\(\s*([a-z][a-z_-]*)((?:\s+[\w.-]+)*)\s*\)\s*(?:\[[\d.]+\])?\s*(?:;.*)?",
    re.IGNORECASE,
)
_CALLED = re.compile(
    r"\s*(?:(?:step\s*)?\d+\s*[:.)]\s*)?([a-z]+(?:[_-][a-z]+)*)((?:\s+[\w.-]+)*\s+character\d*\b(?:\s+[\w.-]+)*)\s*",
    re.IGNORECASE,
)
_ACTORS = re.compile(r"character\d*|char\d+|robot\d*|agent\d*|player\d*|human\d*", re.IGNORECASE)
_ACTIONS = {"walk_towards": "Walk", "walk_into": "Walk", "walktowards": "Walk", "pick_up": "Grab", "put_on": "PutBack"}
"""Actions of VirtualHome's domain that have another name here; there `put_on` is upon a thing, not on the body."""

_NUMBER = re.compile(r"(.*?[a-z_])[._-]?(\d+)", re.IGNORECASE)
_LONGEST = 500


def pddl_step(raw: str) -> str:
    """Return the step of a line, in the syntax of programs, without who does it; empty for a line that is none."""
    found = (_STEP.fullmatch(raw) or _CALLED.fullmatch(raw)) if len(raw) <= _LONGEST else None
    if not found:
        return ""
    action, names = (
        found[1].lower().replace("-", "_"),
        [each for each in found[2].split() if not _ACTORS.fullmatch(each)],
    )
    if names and action not in _ACTIONS and recognition().action(action) is None:
        action = action_of(recognition(), action, names) or action
    return written(_ACTIONS.get(action, action) if names else action, list(map(_name, names)))


def _name(word: str) -> str:
    number = _NUMBER.fullmatch(word)
    return f"{number[1].rstrip('_-.')} {number[2]}" if number else word


def _fits(lines: Sequence[str]) -> bool:
    """Return whether at least half of the lines are steps of a planner."""
    texts = [line for line in lines if line.strip() and not line.lstrip().startswith((";", "#"))]
    return 0 < len(texts) <= 2 * sum(bool(pddl_step(line)) for line in texts)


def _lines(lines: Sequence[str]) -> list[Placed]:
    """Return the steps; lines in parentheses that are none are faults, comments behind `;` are left out."""
    found: list[Placed] = []
    for row, raw in enumerate(lines):
        meant = pddl_step(raw)
        if meant:
            found.append(step(row, meant))
        elif raw.strip().startswith("("):
            found.append(step(row, raw))
        elif not raw.lstrip().startswith(";"):
            found.append(Placed(row, plan_line(raw)))
    return found


PDDL = Form(
    _fits, _lines, lambda raw: bool(pddl_step(raw)), re.compile(r"[\s#;*]*(?:task|problem|plan)\b.*:", re.IGNORECASE)
)
