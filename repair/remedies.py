"""The known repair of a failing step in words: `open the fridge first`."""

from collections.abc import Sequence

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.step_phrases import say
from hearth.repair.handlers.common import Edit, RepairContext, tick_start
from hearth.repair.handlers.registry import HANDLERS
from hearth.schemas.failure_words import in_program, listed, step_number
from hearth.schemas.program import Step
from hearth.simulation.engine import Execution

MOST_STEPS = 4
"""Steps that a remedy names; longer ones are described as the knowledge does."""


def stop_reason(execution: Execution) -> str:
    """Return why an execution stopped and the remedy, as one sentence; "" where it did not stop."""
    failure = execution.failure
    return "" if failure is None else in_program(failure, execution.program, remedy(execution))


def remedy(execution: Execution) -> str:
    """Return what would fix the failing step of an execution, by our repairs; "" where none of them does."""
    failure, world = execution.failure, execution.final
    handler = HANDLERS.get(failure.code) if failure is not None else None
    if failure is None or handler is None:
        return ""
    at = step_number(execution.program, failure) - 1
    known = world.home.knowledge
    context = RepairContext(execution.program, at, failure, world, known, execution.rules, worlds=execution.worlds)
    try:
        edit = handler(context)
    except Exception:  # repairs are made for programs that are wholly bound; this is but a hint
        return ""
    return _in_words(context, edit, known) if edit is not None else ""


def _in_words(context: RepairContext, edit: Edit, known: Knowledge) -> str:
    if len(edit.splices) == 1:
        at, removed, inserted = edit.splices[0]
        if removed == 1 and at == context.at and not inserted:
            return "leave this step out"
        if not removed and at == tick_start(context.program, context.at) and len(inserted) <= MOST_STEPS:
            return f"{_joined(_phrases(inserted, known))} first"
    row = known.repairs.get(edit.name)
    return row.say if row is not None else ""


def phrase(step: Step, known: Knowledge) -> str:
    """Return a step as people say it: `open the fridge`."""
    said = say(known.actions[step.action], [listed([ref.name]) for ref in step.objects])
    return said[:1].lower() + said[1:]


def _phrases(steps: Sequence[Step], known: Knowledge) -> list[str]:
    """Return steps as people say them; `it` is the only thing that the step before names."""
    said, last = [], None
    for step in steps:
        words = phrase(step, known)
        said.append(words.replace(listed([last.name]), "it") if last in step.objects and last is not None else words)
        last = step.objects[0] if len(step.objects) == 1 else None
    return said


def _joined(phrases: list[str]) -> str:
    *first, last = phrases
    return f"{', '.join(first)} and {last}" if first else last
