"""Safe corrections of program files: what is written is kept wherever only one thing can have been meant."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from difflib import unified_diff

from hearth.kb import grammar
from hearth.kb.knowledge import Knowledge, key_of
from hearth.pipelines.checks import programs, special
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.syntax import parse_programs, print_step

SURE = 0.75
"""Similarity by edit distance from which the nearest name is taken for a misspelt one."""

MARGIN = 0.1
"""How much nearer it must be than any other."""

_PASSES = 8
_NO_INSTANCE = re.compile(r"<[^<>\[\]]*>(?!\s*\()(?!\s*\[)\s*(?:\d+(?=\s|$))?")

Edit = tuple[int, int, list[str]]
"""The line (from 0), how many lines go, and the lines that come."""


def fixed(text: str, known: Knowledge) -> str:
    """The text with every safe correction made, one after another until none is left.

    Safe are: a misspelt name that only one known name is near to; a missing instance; a step that only repeats what
    was just done; a missing Walk; a Special block that the reviewed file replaces.
    """
    for _ in range(_PASSES):
        lines = text.split("\n")
        edits = {at: (at, gone, new) for at, gone, new in _edits(text, lines, known)}
        if not edits:
            return text
        for at, gone, new in sorted(edits.values(), reverse=True):
            lines[at : at + gone] = new
        text = "\n".join(lines)
    return text


def difference(before: str, after: str, file: str) -> str:
    """A unified diff; empty where nothing changed."""
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
        canonical, faults = grammar.check(program, known, "", lines)
        for fault in faults:
            line = _respelt(fault, lines[fault.line - 1], known) if fault.line else None
            if line is not None:
                found = True
                yield fault.line - 1, 1, [line]
        if found or faults:
            continue
        for finding in (*programs.contradictions(canonical, known), *programs.from_afar(canonical, known)):
            at = canonical.line(finding.step) - 1
            if at < 0 or "|" in lines[at]:
                continue
            yield (at, 1, []) if finding.remove else (at, 0, list(map(print_step, finding.before)))


def _written(fault: Diagnostic, line: str) -> list[str] | None:
    """The line or lines to write for one that is no step."""
    if fault.code is Code.SPECIAL_BLOCK:
        expanded = special.expand(line, 0).text
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
    """The one known name that a misspelt one is near to, or None."""
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
