"""A failure as JSON, the same in all commands: its step from 1, as in the text, the data, and a sentence."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hearth.schemas.failures import Failure
    from hearth.schemas.program import Program


def failure_document(failure: Failure | None, program: Program | None = None, step: int = 0) -> dict[str, Any] | None:
    """Return a failure for machines; None for none.

    Args:
        failure: with its tick from 0, as in the tables.
        program: whose step it is about; its number is counted then.
        step: the number of the step from 1, where it is known; 0 where the failure is about no step.
    """
    from hearth.schemas.failure_words import in_program, sentence, step_number

    if failure is None:
        return None
    if program is None:
        return {"code": failure.code, "step": step or None, **asdict(failure), "message": sentence(failure, step)}
    found = step_number(program, failure) if failure.action else 0
    number = found if 0 < found <= len(program.steps) else None
    return {"code": failure.code, "step": number, **asdict(failure), "message": in_program(failure, program)}
