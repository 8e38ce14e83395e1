"""Natural-language steps to a program: `Step 3: Put the milk in the fridge` to `[PutIn] <milk> (1) <fridge> (1)`."""

import re
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.phrases import say
from hearth.kb.language.understanding import Candidate, understand
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Program, Step

NUMBERED = re.compile(r"\s*(?:step\s*\d{1,4}\s*[.:)\]–-]?|\d{1,4}\s*[.:)\]]|[-*•])\s+(?=\S)", re.IGNORECASE)
"""The beginning of a line that is a natural-language step."""

TITLE = re.compile(r"\s*(?:task|title|activity|goal)\s*:\s*", re.IGNORECASE)
"""The optional beginning of a title's line."""


class Header(NamedTuple):
    """The text above the steps."""

    title: str
    description: str


def header(text: str) -> Header:
    """Title and description: the lines before the first numbered one; `Task:` before the title is left out."""
    found: list[str] = []
    for line in text.split("\n"):
        if NUMBERED.match(line):
            break
        if line.strip():
            found.append(line.strip())
    title = TITLE.sub("", found[0], count=1) if found else ""
    return Header(title, "\n".join(found[1:]))


_JOINTS = re.compile(r"(?:,|;)?\s+(?:and then|then|and)\s+|[;,]\s+|\.\s+(?=[A-Z])", re.IGNORECASE)
_PRONOUN = re.compile(r"\b(?:it|them)\b", re.IGNORECASE)


class ParsedSteps(NamedTuple):
    """The program of the steps understood, faults for those not understood, warnings for fuzzy matches."""

    program: Program
    faults: tuple[Diagnostic, ...]
    warnings: tuple[Diagnostic, ...]


def parse_steps(text: str, before: int, place: str, known: Knowledge) -> ParsedSteps:
    """Parse natural-language steps. They name no instances, so that every object is instance 1.

    A line may ask for several things ("open the fridge and take the milk out"), where each of them is understood; `it`
    is what the last step was about.

    Args:
        text: title, description and numbered lines.
        before: lines of the file before it.
        place: the file, for diagnostics.
        known: the grammar.
    """
    parser = _StepParser(known, place)
    for number, line in enumerate(text.split("\n"), before + 1):
        match = NUMBERED.match(line)
        if match:
            parser.line(line, match.end(), number)
    top = header(text)
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

    def line(self, line: str, start: int, number: int) -> None:
        """Take a line whose words begin at `start`."""
        words = line[start:].strip()
        whole = understand(self.known, self._resolved(words))
        if whole.meant and whole.meant.score == 1:
            self._add(whole.meant, number)
            return
        parts = self._parts(words)
        if parts:
            for part in parts:
                self._add(part, number)
        elif whole.meant:
            self._add(whole.meant, number)
            self.warnings.append(self._fuzzy(whole.meant, line, start, words, number))
        else:
            self.faults.append(self._fault(whole.candidates, whole.ambiguous, line, start, words, number))

    def _parts(self, words: str) -> list[Candidate]:
        """The steps of several clauses where every clause is an exact paraphrase; else none."""
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
        about = self._about()
        return _PRONOUN.sub(about, words) if about else words

    def _add(self, meant: Candidate, number: int) -> None:
        self.steps.append(Step(meant.action.name, tuple(ObjectRef(name) for name in meant.names)))
        self.lines.append(number)

    def _fuzzy(self, meant: Candidate, line: str, start: int, words: str, number: int) -> Diagnostic:
        message = f"taken for `{phrase(meant)}`, similarity {meant.score:.2f}"
        return Diagnostic(Code.FUZZY_MATCH, message, self.place, number, start + 1, len(words), words[:200], "", line)

    def _fault(
        self, near: tuple[Candidate, ...], ambiguous: bool, line: str, start: int, words: str, number: int
    ) -> Diagnostic:
        code = Code.AMBIGUOUS if ambiguous else Code.NOT_UNDERSTOOD
        message = "words that may mean several things" if ambiguous else "words that mean no step"
        near_phrases = " or ".join(f"`{phrase(each)}` ({each.score:.2f})" for each in near)
        otherwise = "write one step a line, as in `Walk to kitchen`"
        remedy = f"did you mean {near_phrases}?" if near_phrases else otherwise
        return Diagnostic(code, message, self.place, number, start + 1, len(words), words[:200], remedy, line[:200])


def phrase(candidate: Candidate) -> str:
    """A candidate as a phrase."""
    return say(candidate.action, candidate.names)
