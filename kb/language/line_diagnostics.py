"""Faults of steps in words: messages, places and remedies of lines that are not understood, or only nearly."""

import re
from collections.abc import Sequence
from dataclasses import replace

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import foreign_language
from hearth.kb.language.missing_objects import missing
from hearth.kb.language.pronouns import Mentioned
from hearth.kb.language.refusals import Refusal
from hearth.kb.language.single_clauses import Asked
from hearth.kb.language.step_phrases import say
from hearth.kb.language.step_understanding import Candidate, Understood
from hearth.schemas.diagnostics import Diagnostic, excerpt
from hearth.schemas.failures import Code

TRANSLATE = "translate it into English"
"""The remedy of every line of a plan in another language, which is one fault for people."""


def of_language(faults: list[Diagnostic], understood: int) -> list[Diagnostic]:
    """Return the faults; those of lines name the language where most are not understood, as they are not English."""
    lines = [fault for fault in faults if fault.code == Code.NOT_UNDERSTOOD]
    if len(lines) <= understood or not (language := foreign_language([fault.found for fault in lines])):
        return faults
    message = f"the plan is in {language}; only English is read"
    return [replace(fault, message=message, suggestion=TRANSLATE) if fault in lines else fault for fault in faults]


class LineFaults:
    """The diagnostics of the lines of one file."""

    def __init__(self, known: Knowledge, place: str) -> None:
        self._known, self._place = known, place

    def at(self, code: Code, message: str, line: str, words: str, number: int, remedy: str = "") -> Diagnostic:
        """Return the diagnostic of some words of a line."""
        at = line.find(words)
        column = max(at if at >= 0 else line.find(words.split(maxsplit=1)[0]), 0) + 1
        source, before = excerpt(line, column)
        return Diagnostic(code, message, self._place, number, column, len(words), words[:200], remedy, source, before)

    def not_understood(
        self, whole: Understood, line: str, words: str, number: int, said: Sequence[Mentioned], reason: str = ""
    ) -> Diagnostic:
        """Return the fault of words that are no step.

        Args:
            whole: the nearest readings.
            line, words, number: where they stand.
            said: the steps before, the last first.
            reason: why the steps before do not say which things the words mean.
        """
        if reason and not whole.unknown:
            return self.at(Code.AMBIGUOUS, reason, line, words, number, "name the thing in full")
        if not whole.ambiguous and not whole.unknown and (lacking := missing(self._known, words)):
            message, remedy = f"an object is missing: {lacking.question}", f"`{lacking.example(self._known, said)}`"
            return self.at(Code.NOT_UNDERSTOOD, message, line, words, number, f"name it, as in {remedy}")
        if remedy := _of_whole_line(words):
            return self.at(Code.NOT_UNDERSTOOD, "could not read this line as a step", line, words, number, remedy)
        code = Code.AMBIGUOUS if whole.ambiguous else Code.NOT_UNDERSTOOD
        message = "words that may mean several things" if whole.ambiguous else "could not read this line as a step"
        return self.at(code, message, line, words, number, _remedy(whole))

    def fuzzy(self, asked: Asked, line: str, words: str, number: int) -> Diagnostic:
        """Return the warning of a step that was read with words corrected, left out or added."""
        message = f"taken for `{phrase(asked.meant)}`"
        changes = [f"left out: {asked.left_out}"] if asked.left_out else []
        changes += [f"added: {asked.added}"] if asked.added else []
        message += f"; {'; '.join(changes)}" if changes else f", similarity {asked.meant.score:.2f}"
        return self.at(Code.FUZZY_MATCH, message, line, words, number)

    def refused(self, why: Refusal, raw: str, number: int) -> Diagnostic:
        """Return the fault, or the warning, of a line that may be something else."""
        code = Code.AMBIGUOUS if why.is_warning else Code.SYNTAX
        return self.at(code, why.message, raw, raw.strip(), number, why.remedy)

    def of_syntax(self, fault: Diagnostic, text: str, raw: str, number: int) -> Diagnostic:
        """Place a fault of the syntax of programs; that of a line in another form stands at the line's first word."""
        at = raw.find(text)
        if at < 0:
            at, found = len(raw) - len(raw.lstrip()), raw.strip()[:200]
            fault = replace(fault, column=1, length=len(found), found=found)
        source, before = excerpt(raw, fault.column + at)
        return replace(fault, file=self._place, line=number, column=fault.column + at, source=source, before=before)


_NEGATED = re.compile(
    r"(?:please |also |then |but |and )*(?:(?:you )?(?:do|must|should|shall|can) ?not|do ?n['’]?t|never|avoid)\b",
    re.IGNORECASE,
)
_CHOICE = re.compile(r"\S (?:or|and/or) \S", re.IGNORECASE)


def _of_whole_line(words: str) -> str:
    """Return the remedy of a line that forbids an act or leaves a choice; empty for any other line."""
    if _NEGATED.match(words):
        return "this says what not to do: leave the line out"
    return "choose one of the two, and name it alone" if _CHOICE.search(words) else ""


def _remedy(whole: Understood) -> str:
    """Return a remedy for a line that is not understood: the steps that may be meant, or where the known words are."""
    if whole.candidates:
        return f"did you mean {' or '.join(f'`{phrase(each)}`' for each in whole.candidates)}?"
    if whole.unknown and whole.is_action:
        return f"`{whole.unknown}` is not an action that Hearth knows; `hearth kb export table` lists them"
    if whole.unknown:
        return f"`{whole.unknown}` is not an object that Hearth knows; `hearth kb find` lists them"
    return "write one step a line, as in `Walk to kitchen`"


def phrase(candidate: Candidate) -> str:
    """Return a candidate as a phrase."""
    return say(candidate.action, candidate.names)
