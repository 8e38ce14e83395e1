"""The check of a program while it is written: the code of `check`, and the faults that `build` would refuse."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.pipelines.checks import free_text_steps, meaning_checks
from hearth.pipelines.checks.text_checks import check_program
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.syntax import parse_program
from hearth.web.annotate.fault_words import in_words, said, scene_in_words
from hearth.web.annotate.program_draft import SPECIAL, Draft, is_plain

REFUSED = frozenset({Code.CONTRADICTION})
"""Codes that `check` warns of and `build` refuses."""


class Found(NamedTuple):
    """A fault or a warning of a step.

    Attributes:
        step: its number from 0; -1 if the program as a whole is meant.
        fault: whether a program with it can't be submitted.
        code: the kind.
        message: for people.
        remedy: the correction.
    """

    step: int
    fault: bool
    code: str
    message: str
    remedy: str


def check_draft(draft: Draft, title: str, description: str, known: Knowledge) -> list[Found]:
    """Return all faults and warnings of a draft, ordered by step."""
    lines = _shown_plain(draft).lines()
    expanded = free_text_steps.expand("\n".join(lines), 0)
    pairs = zip(expanded.text.split("\n"), expanded.lines, strict=True)
    kept = [(line, number) for line, number in pairs if not line.startswith(f"[{SPECIAL}]")]
    source, numbers = [line for line, _ in kept], [number for _, number in kept]
    program, syntax = parse_program("\n".join(source) + "\n")
    program = replace(program, title=title, description=description)
    faults, warnings = check_program(program, known, "", source, affordances=True, lint=True)
    if not draft.blocks:
        return [Found(-1, True, str(Code.EMPTY), *said("no_steps"))]

    def found_of(each: Diagnostic, fault: bool) -> Found:
        step = numbers[each.line - 1] - 1 if 0 < each.line <= len(numbers) else -1
        block = draft.blocks[step] if step >= 0 else None
        return Found(step, fault, str(each.code), *in_words(each, block, draft, known))

    found = [found_of(each, True) for each in (*(syntax if source else ()), *faults)]
    found += [found_of(each, each.code in REFUSED) for each in warnings]
    if not faults:
        scene = {"rooms": _rows(draft.rooms), "props": _rows(draft.props)}
        differing = meaning_checks.scene_and_use(program, scene, known)
        found += [Found(-1, False, str(Code.UNDECLARED), *scene_in_words(kind, names)) for kind, names in differing]
    return sorted((*found, *_unfinished(draft, dict(expanded.replaced))), key=lambda each: (each.step, not each.fault))


def _shown_plain(draft: Draft) -> Draft:
    """Return the draft without texts of special blocks that can't stand in a line; they are faults of their own."""
    blocks = (each if is_plain(each.text) else each._replace(text="") for each in draft.blocks)
    return replace(draft, blocks=tuple(blocks))


def _rows(quantities: Mapping[str, int]) -> list[dict[str, Any]]:
    return [{"name": name, "quantity": quantity} for name, quantity in quantities.items()]


def _unfinished(draft: Draft, replaced: Mapping[int, str]) -> list[Found]:
    """Special blocks: one without text is a fault; one that no steps are known for is waited with."""
    found = []
    for number, block in enumerate(draft.blocks):
        if block.action != SPECIAL:
            continue
        if not is_plain(block.text):
            found.append(Found(number, True, str(Code.SYNTAX), *said("special_unfit")))
        elif not block.text:
            found.append(Found(number, True, str(Code.EMPTY), *said("special_empty")))
        elif number + 1 not in replaced:
            found.append(Found(number, False, str(Code.SPECIAL_BLOCK), *said("special_waits")))
    return found
