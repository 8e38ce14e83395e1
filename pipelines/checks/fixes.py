"""Safe corrections of program files, made only where a single correction is possible."""

import re
from collections.abc import Iterator, Mapping
from difflib import unified_diff

from hearth.kb import action_grammar
from hearth.kb.knowledge import Knowledge
from hearth.kb.spelling import key_of
from hearth.pipelines.checks import free_text_steps, meaning_checks
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.syntax import parse_programs, print_step

SURE = 0.75
"""Similarity by edit distance from which the nearest name replaces a misspelt one."""

MARGIN = 0.1
"""Least lead of a suggestion's similarity over any other."""

_PASSES = 8
_NO_INSTANCE = re.compile(r"<[^<>\[\]]*>(?!\s*\()(?!\s*\[)\s*(?:\d+(?=\s|$))?")

Edit = tuple[int, int, list[str]]
"""The first line (from 0), the number of lines to remove, and the lines to insert."""


def fixed(text: str, known: Knowledge) -> str:
    """Return the text with every safe correction made, pass by pass until none is left.

    Corrected are: a misspelt name that is similar to only one known name; a missing instance; a step that repeats a
    state change; a missing Walk; a Special block that the reviewed file replaces.
    """
    for _ in range(_PASSES):
        lines = text.split("\n")
        edits = {at: (at, removed, new) for at, removed, new in _edits(text, lines, known)}
        if not edits:
            return text
        for at, removed, new in sorted(edits.values(), reverse=True):
            lines[at : at + removed] = new
        text = "\n".join(lines)
    return text


def difference(before: str, after: str, file: str) -> str:
    """Return a unified diff; empty if nothing changed."""
    lines = unified_diff(before.split("\n"), after.split("\n"), file, f"{file} (fixed)", lineterm="")
    return "".join(f"{line}\n" for line in lines)


def _edits(text: str, lines: list[str], known: Knowledge) -> Iterator[Edit]:
    parsed = parse_programs(text)
    found = False
    for fault in parsed.diagnostics:
        new = _written(fault, lines[fault.line - 1]) if fault.line else None
        if new is not None:
            found = True
            yield fault.line - 1, 1, new
    for program in parsed.programs:
        canonical, faults = action_grammar.check(program, known, "", lines)
        for fault in faults:
            line = _respelt(fault, lines[fault.line - 1], known) if fault.line else None
            if line is not None:
                found = True
                yield fault.line - 1, 1, [line]
        if found or faults:
            continue
        for finding in (*meaning_checks.contradictions(canonical, known), *meaning_checks.not_close(canonical, known)):
            at = canonical.line(finding.step) - 1
            if at < 0 or "|" in lines[at]:
                continue
            yield (at, 1, []) if finding.remove else (at, 0, list(map(print_step, finding.before)))


def _written(fault: Diagnostic, line: str) -> list[str] | None:
    """Return the lines that replace a line which is not a step."""
    if fault.code is Code.SPECIAL_BLOCK:
        expanded = free_text_steps.expand(line, 0).text
        return expanded.split("\n") if expanded != line else None
    if fault.code is Code.SYNTAX and "lacks its instance" in fault.message:
        start, end = fault.column - 1, fault.column - 1 + fault.length
        match = _NO_INSTANCE.match(line, start)
        if match and match.end() >= end:
            name, _, number = match[0].partition(">")
            return [f"{line[:start]}{name}> ({number.strip() or 1}){line[end:]}"]
    return None


def _respelt(fault: Diagnostic, line: str, known: Knowledge) -> str | None:
    spellings: Mapping[str, str]
    if fault.code is Code.UNKNOWN_OBJECT:
        spellings = known.object_spellings
    elif fault.code is Code.UNKNOWN_ACTION:
        spellings = known.action_spellings
    else:
        return None
    name = only_near(fault.found, spellings)
    if name is None or not fault.column:
        return None
    start = fault.column - 1
    return f"{line[:start]}{name}{line[start + fault.length :]}"


def only_near(name: str, spellings: Mapping[str, str]) -> str | None:
    """Return the only known name that is similar to a misspelt one, or None."""
    from rapidfuzz import process
    from rapidfuzz.distance import OSA

    scorer = OSA.normalized_similarity
    close = process.extract(key_of(name), list(spellings), scorer=scorer, limit=8, score_cutoff=SURE - MARGIN)
    best: dict[str, float] = {}
    for key, score, _ in close:
        best.setdefault(spellings[key], score)
    ranked = sorted(best.items(), key=lambda pair: -pair[1])
    if not ranked or ranked[0][1] < SURE or (len(ranked) > 1 and ranked[0][1] - ranked[1][1] < MARGIN):
        return None
    return ranked[0][0]
