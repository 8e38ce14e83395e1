"""Reader of predictions: lines of programs, natural-language steps, and whole plans as `check` reads them."""

from collections.abc import Sequence

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.numbered_steps import parse_steps as parse_plan
from hearth.kb.language.plan_lines import plan_line
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.language.sentences import asked_steps
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.syntax import parse_steps
from hearth.scoring.line_sequences import Line, Lines, PlanReader, Refused


class LineReader(PlanReader):
    """Reads predictions by a grammar, and counts the steps in which it corrected or left out words.

    Attributes:
        known: the grammar.
        how: how far a sentence may be from one that is known.
        fuzzy: steps read so far that were corrected or shortened.
    """

    def __init__(self, known: Knowledge, how: Fuzzy = Fuzzy.TYPOS) -> None:
        self.known, self.how, self.fuzzy = known, how, 0

    def __call__(self, line: str) -> tuple[Step, ...] | Diagnostic:
        """Read one line: of a program, or a natural-language step such as `2. Put the cup on the table`."""
        parsed = parse_steps(line)
        if not isinstance(parsed, Diagnostic):
            return parsed
        asked = asked_steps(self.known, plan_line(line).text, (), self.how)
        self.fuzzy += sum(bool(each.fuzzy) for each in asked)
        return tuple(Step(each.meant.action.name, tuple(map(ObjectRef, each.meant.names))) for each in asked) or parsed

    def plan(self, text: str) -> Lines:
        """Read a plan as `check` does: its steps, and the lines that are refused, in order."""
        found = parse_plan(text, 0, "", self.known, self.how)
        self.fuzzy += sum(each.code == Code.FUZZY_MATCH for each in found.warnings)
        return in_order(found.program.steps, found.program.lines, found.faults)


def in_order(steps: Sequence[Step], lines: Sequence[int], faults: Sequence[Diagnostic]) -> Lines:
    """Return the steps of a text as they run, and each refused line once, with its code.

    Steps of a loop repeat their lines, so that the order of steps is not that of lines. A refused line stands before
    the first step of a later line.
    """
    refused = {fault.line: fault for fault in reversed(faults) if fault.code != Code.EMPTY}
    waiting = sorted(refused)
    found: list[Line] = []
    for line, step in zip(lines, steps, strict=True):
        while waiting and waiting[0] < line:
            found.append(_refused(refused[waiting.pop(0)]))
        found.append(step)
    return (*found, *(_refused(refused[line]) for line in waiting))


def _refused(fault: Diagnostic) -> Refused:
    return Refused(fault.source or fault.found, fault.code)
