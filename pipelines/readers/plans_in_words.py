"""The entry point `hearth.parse_steps`: the program of a plan in words."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

from hearth.kb.knowledge import Knowledge
from hearth.kb.language import numbered_steps
from hearth.kb.language.numbered_steps import ParsedSteps
from hearth.kb.language.program_lines import PLAIN
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.language.recognition_knowledge import recognizing
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.text_places import TextPlaces

if TYPE_CHECKING:
    from hearth.schemas.stage_rows import IngestedRow

_FIRST = re.compile(r"^\s*(?:[Ss]tep )?[01][.:)]\s", re.MULTILINE)


def parse_steps(text: str, knowledge: Knowledge | None = None, fuzzy: Fuzzy = Fuzzy.TYPOS) -> ParsedSteps:
    """Read the program of a plan in words, as `hearth check` reads it: numbered, bulleted or in another form of text.

    A line that is not understood is a fault, and no step. A step with words corrected, left out or added has a warning.
    Of a chat the last answer counts. A warning says where another plan begins in the text: the steps of all plans are
    one program then. `parse_program` reads the syntax of programs; `build` and `hearth check` read each plan by itself.

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
    known, how = knowledge or default(), Fuzzy(fuzzy)
    with recognizing(known):
        if PLAIN.fullmatch(text) and len(_FIRST.findall(text)) < 2:  # one plan, as most texts are
            return numbered_steps.parse_steps(text, 0, "", known, how)
        from hearth.pipelines.readers.json_records import read
        from hearth.pipelines.readers.text_chats import items_in

        rows = [row for item in items_in(text) for row in read(item)]
        chats = [row for row in rows if isinstance(row, dict) and row["text"]]
        if chats:
            return _of_chat(chats, known, how)
        found = numbered_steps.parse_steps(text, 0, "", known, how)
        return found._replace(warnings=(*found.warnings, *_others(text)))


def _of_chat(chats: list[IngestedRow], known: Knowledge, how: Fuzzy) -> ParsedSteps:
    """Return the program of the last answer of the first chat in a text."""
    from hearth.pipelines.readers.reader_warnings import diagnostics

    first, *others = chats
    places = TextPlaces(first["line"] or 0, first["places"] or ())
    found = numbered_steps.parse_steps(first["text"] or "", 0, "", known, how)
    faults, warnings = (tuple(map(places.placed, each)) for each in found[1:])
    title, description = first["title"] or found.program.title, first["description"] or found.program.description
    lines = tuple(map(places.line, found.program.lines))
    program = replace(found.program, title=title, description=description, lines=lines)
    left_out = [_fault((row["line"] or 0) + 1, "another chat begins here: it is left out") for row in others]
    return ParsedSteps(program, faults, (*diagnostics(first["warnings"], ""), *warnings, *left_out))


def _others(text: str) -> list[Diagnostic]:
    """Return a warning for each further plan of a text."""
    from hearth.pipelines.readers.natural_language_plans import starts_of

    message = "another plan begins here: the steps of all plans of the text are one program"
    return [_fault(line, message) for line in starts_of(text)[1:]]


def _fault(line: int, message: str) -> Diagnostic:
    remedy = "give one plan at a time; `hearth check` and `hearth build` read each plan of a file by itself"
    return Diagnostic(Code.AMBIGUOUS, message, "", line, suggestion=remedy)
