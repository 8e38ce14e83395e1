"""The known repair of a failing step in words: `open the fridge first`."""

import re
from collections.abc import Sequence
from dataclasses import replace

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.step_phrases import say
from hearth.repair.handlers.common import Edit, RepairContext, tick_start
from hearth.repair.handlers.registry import HANDLERS
from hearth.schemas.failure_words import in_program, listed, step_number
from hearth.schemas.failures import Failure
from hearth.schemas.program import Program, Step
from hearth.simulation.engine import Execution, run

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
    context = _context(execution, failure)
    try:
        edit = handler(context)
        return _in_words(context, edit, world.home.knowledge) if edit is not None else ""
    except Exception:  # repairs are made for programs that are wholly bound; this is but a hint
        return ""


def _context(execution: Execution, failure: Failure) -> RepairContext:
    at = step_number(execution.program, failure) - 1
    known, world = execution.final.home.knowledge, execution.final
    return RepairContext(execution.program, at, failure, world, known, execution.rules, worlds=execution.worlds)


def _in_words(context: RepairContext, edit: Edit, known: Knowledge) -> str:
    if len(edit.splices) == 1 and edit.splices[0][:2] == (context.at, 1) and not edit.splices[0].inserted:
        return "leave this step out"
    if steps := _inserted(context, edit):
        return f"{_joined(_phrases(_all_needed(context, steps), known))} first"
    row = known.repairs.get(edit.name)
    return row.say if row is not None else ""


def _inserted(context: RepairContext, edit: Edit | None) -> tuple[Step, ...]:
    """Return the few steps that a repair only puts before the failing one; none where it does anything else."""
    if edit is None or len(edit.splices) != 1:
        return ()
    at, removed, inserted = edit.splices[0]
    is_before = not removed and at == tick_start(context.program, context.at)
    return inserted if is_before and len(inserted) <= MOST_STEPS else ()


def _all_needed(context: RepairContext, steps: tuple[Step, ...]) -> tuple[Step, ...]:
    """Return all steps that the failing one needs before it; the given ones where that takes more, or other repairs."""
    found, failing = steps, replace(context.step, joins=False)
    while len(found) <= MOST_STEPS:
        tried = run(context.world, Program(steps=(*found, failing)), context.rules)
        failure = tried.failure
        if failure is None:
            return found
        handler = HANDLERS.get(failure.code) if failure.tick == len(found) else None
        next_context = _context(tried, failure)
        more = _inserted(next_context, handler(next_context)) if handler is not None else ()
        if len(more) != 1:  # a longer repair is a choice of its own: fetching a tool
            break
        found = (*found, *more)
    return steps


def phrase(step: Step, known: Knowledge) -> str:
    """Return a step as people say it: `open the fridge`."""
    said = say(known.actions[step.action], [listed([ref.name]) for ref in step.objects])
    return said[:1].lower() + said[1:]


_PARTICLE = re.compile(r"^(switch|turn|plug) (on|off|in|out) it$")
"""The end of a phrase whose particle stands behind the pronoun: `switch it on`."""


def _phrases(steps: Sequence[Step], known: Knowledge) -> list[str]:
    """Return steps as people say them; `it` is the only thing that the step before names."""
    said, last = [], None
    for step in steps:
        words = phrase(step, known)
        if last is not None and last in step.objects:
            words = _PARTICLE.sub(r"\1 it \2", words.replace(listed([last.name]), "it"))
        said.append(words)
        last = step.objects[0] if len(step.objects) == 1 else None
    return said


def _joined(phrases: list[str]) -> str:
    *first, last = phrases
    return f"{', '.join(first)} and {last}" if first else last
