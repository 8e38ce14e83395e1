"""Natural-language steps to a program: `Step 3: Put the milk in the fridge` to `[PutIn] <milk> (1) <fridge> (1)`."""

import re
from dataclasses import replace
from typing import NamedTuple

from hearth.kb import grammar
from hearth.kb.knowledge import Knowledge
from hearth.kb.language.phrases import say
from hearth.kb.language.plan_lines import PlanLine, header_of
from hearth.kb.language.program_lines import Kind, lines_of_program
from hearth.kb.language.sentences import exact_steps, last_thing, nearest_step
from hearth.kb.language.understanding import Candidate
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import parse_steps as parse_ticks

_EXPLAINED = re.compile(r" ?[(–—]| - |:(?= |$)|\. (?=[A-Z])")


class ParsedSteps(NamedTuple):
    """The program of the steps understood, faults for those not understood, warnings for fuzzy matches."""

    program: Program
    faults: tuple[Diagnostic, ...]
    warnings: tuple[Diagnostic, ...]


def parse_steps(text: str, before: int, place: str, known: Knowledge) -> ParsedSteps:
    """Parse natural-language steps. They name no instances, so that every object is instance 1.

    A line may ask for several things ("open the fridge and take the milk out"), where each of them is understood; `it`
    is what the last step was about. Steps may also be written as in programs. An item below a step, or a line without
    a number, is a step if it reads exactly as one; else it explains, and is counted in a warning. Below a step that is
    not understood, as `1. In the kitchen:`, items are its steps.

    Args:
        text: title, description and steps, with or without Markdown.
        before: lines of the file before it.
        place: the file, for diagnostics.
        known: the grammar.
    """
    parser = _StepParser(known, place)
    raw = text.split("\n")
    lines = lines_of_program(text)
    for row, line, kind in lines:
        parser.take(line, kind, raw[row], before + row + 1)
    top = header_of([line for _, line, _ in lines])
    if not parser.steps and not parser.faults:
        fault = Diagnostic(Code.EMPTY, f"`{top.title[:60]}` has no steps", place, before + 1)
        parser.faults.append(fault)
    program = Program(top.title, top.description, tuple(parser.steps), tuple(parser.lines))
    return ParsedSteps(program, tuple(parser.faults), (*parser.warnings, *parser.explained()))


class _StepParser:
    def __init__(self, known: Knowledge, place: str) -> None:
        self.known, self.place = known, place
        self.steps: list[Step] = []
        self.lines: list[int] = []
        self.faults: list[Diagnostic] = []
        self.warnings: list[Diagnostic] = []
        self._notes: list[tuple[str, str, int]] = []
        self._is_open = self._is_heading = False

    def take(self, line: PlanLine, kind: Kind, raw: str, number: int) -> None:
        """Take a line; items below a step that is not understood are its steps, and the step is their heading."""
        if kind == Kind.STEP:
            found = self._read(line, raw, number)
            self._is_open, self._is_heading = bool(found) and not line.bracketed, False
            self.faults += found
        elif kind == Kind.MISSING:
            self._is_open = False
            self.faults += [] if self._detail(line.text, number) else self._nearest(line.text, raw, number)
        elif line.number is not None and self._is_open:
            self._take_item(line, raw, number)
        elif kind == Kind.DETAIL and not self._detail(line.text, number):
            self._is_open = self._is_open and line.indent > 0
            self._notes += [(line.text, raw, number)] if line.indent or line.number is not None else []
        elif kind == Kind.TEXT and line.text:
            self._is_open = self._is_open and line.indent > 0

    def _take_item(self, line: PlanLine, raw: str, number: int) -> None:
        found = self._read(line, raw, number)
        if not found and not self._is_heading:
            self._is_heading = True
            self.faults.pop()
        self.faults += found if self._is_heading else []

    def explained(self) -> list[Diagnostic]:
        """Return a warning that counts the lines that explain steps and are none, if there are any."""
        if not self._notes:
            return []
        words, raw, number = self._notes[0]
        count = len(self._notes)
        message = f"{count} lines explain steps and are none" if count > 1 else "a line that explains a step and is none"
        return [self._diagnostic(Code.NO_STEP, message, raw, words, number, "number it if it is a step")]

    def _detail(self, words: str, number: int) -> bool:
        """Add the steps of a line that may explain; return whether it reads exactly as steps."""
        parts = exact_steps(self.known, words, last_thing(self.steps))
        for part in parts:
            self._add(part, number)
        return bool(parts)

    def _read(self, line: PlanLine, raw: str, number: int) -> list[Diagnostic]:
        """Add the steps of a line; the faults of one that is not understood."""
        if line.bracketed:
            return self._written(line.text, raw, number)
        words = line.text
        parts = exact_steps(self.known, words.removesuffix(":"), last_thing(self.steps))
        if not parts and (shorter := _EXPLAINED.split(words, 1)[0]) not in ("", words):
            parts = exact_steps(self.known, shorter, last_thing(self.steps))
            self.warnings += [self._fuzzy(parts[0], raw, words, number)] if parts else []
        fault = [] if parts else self._nearest(words, raw, number)
        for part in parts:
            self._add(part, number)
        return fault

    def _nearest(self, words: str, raw: str, number: int) -> list[Diagnostic]:
        """Add the step that a line most resembles; the fault of one that resembles none."""
        whole = nearest_step(self.known, words, last_thing(self.steps))
        if not whole.meant or words.endswith(":"):
            return [self._fault(whole.candidates, whole.ambiguous, raw, words, number)]
        self._add(whole.meant, number)
        self.warnings.append(self._fuzzy(whole.meant, raw, words, number))
        return []

    def _written(self, text: str, raw: str, number: int) -> list[Diagnostic]:
        """Add the steps of a line in the syntax of programs."""
        found = parse_ticks(text)
        faults: tuple[Diagnostic, ...] = (found,) if isinstance(found, Diagnostic) else ()
        if not isinstance(found, Diagnostic):
            written = Program(steps=found, lines=(1,) * len(found))
            program, faults = grammar.check(written, self.known, self.place, [text])
            if not faults:
                self.steps += program.steps
                self.lines += [number] * len(found)
        return [self._placed(fault, text, raw, number) for fault in faults]

    def _placed(self, fault: Diagnostic, text: str, raw: str, number: int) -> Diagnostic:
        """Place a fault of the syntax of programs; that of a line in another form stands at the line's first word."""
        at = raw.find(text)
        if at >= 0:
            return replace(fault, file=self.place, line=number, column=fault.column + at, source=raw[:200])
        start = len(raw) - len(raw.lstrip())
        found = raw.strip()[:200]
        return replace(
            fault, file=self.place, line=number, column=start + 1, length=len(found), found=found, source=raw[:200]
        )

    def _add(self, meant: Candidate, number: int) -> None:
        self.steps.append(Step(meant.action.name, tuple(ObjectRef(name) for name in meant.names)))
        self.lines.append(number)

    def _fuzzy(self, meant: Candidate, line: str, words: str, number: int) -> Diagnostic:
        message = f"taken for `{phrase(meant)}`, similarity {meant.score:.2f}"
        return self._diagnostic(Code.FUZZY_MATCH, message, line, words, number)

    def _fault(self, near: tuple[Candidate, ...], ambiguous: bool, line: str, words: str, number: int) -> Diagnostic:
        code = Code.AMBIGUOUS if ambiguous else Code.NOT_UNDERSTOOD
        message = "words that may mean several things" if ambiguous else "words that mean no step"
        near_phrases = " or ".join(f"`{phrase(each)}` ({each.score:.2f})" for each in near)
        otherwise = "write one step a line, as in `Walk to kitchen`"
        remedy = f"did you mean {near_phrases}?" if near_phrases else otherwise
        return self._diagnostic(code, message, line, words, number, remedy)

    def _diagnostic(self, code: Code, message: str, line: str, words: str, number: int, remedy: str = "") -> Diagnostic:
        column = max(line.find(words.split(maxsplit=1)[0]), 0) + 1
        return Diagnostic(code, message, self.place, number, column, len(words), words[:200], remedy, line[:200])


def phrase(candidate: Candidate) -> str:
    """A candidate as a phrase."""
    return say(candidate.action, candidate.names)
