"""Natural-language steps to a program: `Step 3: Put the milk in the fridge` to `[PutIn] <milk> (1) <fridge> (1)`."""

import re
from dataclasses import replace
from typing import NamedTuple

from hearth.kb import grammar
from hearth.kb.knowledge import Knowledge
from hearth.kb.language.phrases import say
from hearth.kb.language.plan_lines import PlanLine, header_of, is_step, ordered, plan_line
from hearth.kb.language.understanding import Candidate, understand
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import parse_steps as parse_ticks

_JOINTS = re.compile(r"(?:,|;)?\s+(?:and then|then|and)\s+|[;,]\s+|\.\s+(?=[A-Z])", re.IGNORECASE)
_EXPLAINED = re.compile(r" ?[(–—]| - |:(?= |$)|\. (?=[A-Z])")
_PRONOUN = re.compile(r"\b(?:it|them)\b", re.IGNORECASE)


class ParsedSteps(NamedTuple):
    """The program of the steps understood, faults for those not understood, warnings for fuzzy matches."""

    program: Program
    faults: tuple[Diagnostic, ...]
    warnings: tuple[Diagnostic, ...]


def parse_steps(text: str, before: int, place: str, known: Knowledge) -> ParsedSteps:
    """Parse natural-language steps. They name no instances, so that every object is instance 1.

    A line may ask for several things ("open the fridge and take the milk out"), where each of them is understood; `it`
    is what the last step was about. Steps may also be written as in programs. Below a numbered step, bullets explain
    it; below one that is not understood, as `1. In the kitchen:`, they are its steps.

    Args:
        text: title, description and steps, with or without Markdown.
        before: lines of the file before it.
        place: the file, for diagnostics.
        known: the grammar.
    """
    parser = _StepParser(known, place)
    raw = text.split("\n")
    lines = list(map(plan_line, raw))
    is_ordered = ordered(lines)
    for number, line in enumerate(lines):
        parser.take(line, raw[number], before + number + 1, is_step(line, is_ordered))
    top = header_of(lines)
    if not parser.steps and not parser.faults:
        fault = Diagnostic(Code.EMPTY, f"`{top.title[:60]}` has no steps", place, before + 1)
        parser.faults.append(fault)
    program = Program(top.title, top.description, tuple(parser.steps), tuple(parser.lines))
    return ParsedSteps(program, tuple(parser.faults), tuple(parser.warnings))


class _StepParser:
    def __init__(self, known: Knowledge, place: str) -> None:
        self.known, self.place = known, place
        self.steps: list[Step] = []
        self.lines: list[int] = []
        self.faults: list[Diagnostic] = []
        self.warnings: list[Diagnostic] = []
        self._indent: int | None = None
        self._above = self._is_heading = self._by_headings = False

    def take(self, line: PlanLine, raw: str, number: int, is_own: bool) -> None:
        """Take a line; `is_own` says that it is a step, not an explanation of the one above."""
        if line.number is None:
            self._above = self._above and (line.indent > 0 or not line.text)
            return
        self._indent = line.indent if self._indent is None else self._indent
        self._by_headings = self._by_headings or line.heading
        is_own = is_own and (line.heading or line.bracketed or not self._by_headings)
        if is_own and (line.number or line.bracketed or line.indent <= self._indent):
            found = self._read(line, raw, number)
            self._above, self._is_heading = bool(found) and not line.bracketed, False
            self.faults += found
        elif self._above:
            found = self._read(line, raw, number)
            if not found and not self._is_heading:
                self._is_heading = True
                self.faults.pop()
            self.faults += found if self._is_heading else []

    def _read(self, line: PlanLine, raw: str, number: int) -> list[Diagnostic]:
        """Add the steps of a line; the faults of one that is not understood."""
        if line.bracketed:
            return self._written(line.text, raw, number)
        words = line.text
        parts = self._parts(words)
        if not parts and (shorter := _EXPLAINED.split(words, 1)[0]) not in ("", words):
            parts = self._parts(shorter)
            self.warnings += [self._fuzzy(parts[0], raw, words, number)] if parts else []
        fault = [] if parts else self._nearest(words, raw, number)
        for part in parts:
            self._add(part, number)
        return fault

    def _nearest(self, words: str, raw: str, number: int) -> list[Diagnostic]:
        """Add the step that a line most resembles; the fault of one that resembles none."""
        whole = understand(self.known, self._resolved(words))
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
        at = max(raw.find(text), 0)
        return [replace(f, file=self.place, line=number, column=f.column + at, source=raw) for f in faults]

    def _parts(self, words: str) -> list[Candidate]:
        """The step of which a line is an exact paraphrase, or those of its clauses if each is one; else none."""
        whole = understand(self.known, self._resolved(words)).meant
        if whole and whole.score == 1:
            return [whole]
        clauses = [clause for clause in _JOINTS.split(words) if clause]
        if len(clauses) < 2:
            return []
        found: list[Candidate] = []
        about = self._about()
        for clause in clauses:
            meant = understand(self.known, _PRONOUN.sub(about, clause) if about else clause).meant
            if meant is None or meant.score < 1:
                return []
            found.append(meant)
            about = meant.names[0].replace("_", " ") if meant.names else about
        return found

    def _about(self) -> str:
        return next((step.objects[0].name.replace("_", " ") for step in reversed(self.steps) if step.objects), "")

    def _resolved(self, words: str) -> str:
        about = self._about() if _PRONOUN.search(words) else ""
        return _PRONOUN.sub(about, words) if about else words

    def _add(self, meant: Candidate, number: int) -> None:
        self.steps.append(Step(meant.action.name, tuple(ObjectRef(name) for name in meant.names)))
        self.lines.append(number)

    def _fuzzy(self, meant: Candidate, line: str, words: str, number: int) -> Diagnostic:
        message = f"taken for `{phrase(meant)}`, similarity {meant.score:.2f}"
        return self._diagnostic(Code.FUZZY_MATCH, message, line, words, number)

    def _fault(self, near: tuple[Candidate, ...], ambiguous: bool, line: str, words: str, number: int) -> Diagnostic:
        code = Code.AMBIGUOUS if ambiguous else Code.NOT_UNDERSTOOD
        message = "words that may mean several things" if ambiguous else "could not read this line as a step"
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
