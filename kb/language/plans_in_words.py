"""The entry point `hearth.parse_steps`: the program of a plan in words."""

from hearth.kb.knowledge import Knowledge
from hearth.kb.language import numbered_steps
from hearth.kb.language.numbered_steps import ParsedSteps
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.loading.load import default


def parse_steps(text: str, knowledge: Knowledge | None = None, fuzzy: Fuzzy = Fuzzy.TYPOS) -> ParsedSteps:
    """Read the program of a plan in words, as `hearth check` reads it: numbered, bulleted or in another form of text.

    A line that is not understood is a fault, and no step. A step with words corrected, left out or added has a warning.
    `parse_program` reads the syntax of programs; `build` and `hearth check` also read files of several plans.

    Args:
        text: title, description and steps of one plan, with or without Markdown.
        knowledge: the grammar; by default ours.
        fuzzy: how far a step may be from one that is known: `off`, `typos` or `loose`.

    Examples:
        >>> plan = hearth.parse_steps("Tea\\n1. Walk to the kitchen\\n2. Grab the kettle quickly\\n3. Zap the tea")
        >>> [step.action for step in plan.program.steps], plan.warnings[0].message
        (['Walk', 'Grab'], 'taken for `Grab kettle`; left out: quickly')
        >>> plan.faults[0].line, plan.faults[0].found
        (4, 'Zap the tea')
    """
    return numbered_steps.parse_steps(text, 0, "", knowledge or default(), Fuzzy(fuzzy))
