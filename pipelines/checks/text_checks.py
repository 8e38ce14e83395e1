"""The faults and warnings of program text: the output of `check`, which annotators see while they write."""

from __future__ import annotations

from dataclasses import dataclass

from hearth.kb import action_grammar
from hearth.kb.knowledge import Knowledge
from hearth.pipelines.checks import meaning_checks
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.program import Program
from hearth.schemas.syntax import parse_programs


@dataclass(frozen=True, slots=True)
class Checked:
    """The counts, faults and warnings of one file."""

    file: str
    programs: int
    steps: int
    faults: tuple[Diagnostic, ...]
    warnings: tuple[Diagnostic, ...] = ()
    diff: str = ""


def check_text(
    text: str, knowledge: Knowledge, file: str = "", *, affordances: bool = False, lint: bool = False
) -> Checked:
    """Find all faults of a text of programs: of syntax, names and arity, ordered by line."""
    parsed = parse_programs(text, file)
    source = text.split("\n")
    faults = list(parsed.diagnostics)
    warnings: list[Diagnostic] = []
    for program in parsed.programs:
        found, warned = check_program(program, knowledge, file, source, affordances=affordances, lint=lint)
        faults += found
        warnings += warned
    faults.sort(key=lambda fault: (fault.line, fault.column))
    steps = sum(len(program.steps) for program in parsed.programs)
    return Checked(file, len(parsed.programs), steps, tuple(faults), tuple(warnings))


def check_program(
    program: Program, knowledge: Knowledge, file: str, source: list[str], *, affordances: bool, lint: bool
) -> tuple[list[Diagnostic], list[Diagnostic]]:
    """Return the faults of a program as parsed, and, if names and arity are right, its warnings.

    Args:
        program: with the lines of its steps.
        knowledge: the grammar.
        file: named in the diagnostics.
        source: the file's lines, for columns and underlining.
        affordances: whether objects must afford their actions.
        lint: whether warnings are asked for.
    """
    canonical, found = action_grammar.check(program, knowledge, file, source)
    afforded = action_grammar.affordances(canonical, knowledge, file, source) if affordances else ()
    return [*found, *afforded], warnings_of(canonical, knowledge, file, source) if lint and not found else []


def warnings_of(program: Program, knowledge: Knowledge, file: str, source: list[str]) -> list[Diagnostic]:
    """Warnings about the meaning of a program in canonical names.

    They are contradictions, actions that no simulation runs, objects out of reach, steps without an effect.
    """
    found = [
        *meaning_checks.contradictions(program, knowledge),
        *meaning_checks.never_executed(program, knowledge),
        *meaning_checks.findings(program, knowledge),
    ]
    return [meaning_checks.diagnostic(each, program, file, source) for each in found]
