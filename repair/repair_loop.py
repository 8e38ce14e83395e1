"""Repairing: run, look the failure up, edit the program, run on from there (thesis 5.5.4, A.2, algorithm 4)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from hearth.grounding.preconditions.postconditions import Postconditions, missing, nodes_of
from hearth.kb.knowledge import Knowledge
from hearth.repair import repair_trimming
from hearth.repair.handlers.common import Edit, Handler, RepairContext
from hearth.repair.handlers.registry import HANDLERS, UNREPAIRABLE
from hearth.repair.step_context import Lost, lost
from hearth.schemas.failure_words import step_number
from hearth.schemas.failures import Code, Failure
from hearth.schemas.literals import Key
from hearth.schemas.program import Program, Step
from hearth.schemas.short_repr import brief
from hearth.simulation.engine import Execution, run
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World

TRIES = 20
"""Repairs of one program in one environment before it is given up."""


@dataclass(frozen=True, slots=True)
class Attempt:
    """One repair: a broken program, what broke, and the program after it.

    Attributes:
        number: from 0.
        step: number of the step that failed, from 0; the program's length when it ran but missed its goal.
        failure: why.
        handler: name of the repair, or of the handler that gave up.
        before: the steps that broke.
        after: the steps instead; empty when nothing could be done.
        missed: the facts of the goal that did not hold, where the program ran to its end.
    """

    number: int
    step: int
    failure: Failure
    handler: str
    before: tuple[Step, ...]
    after: tuple[Step, ...]
    missed: Postconditions = ()

    __repr__ = brief

    @property
    def cause(self) -> tuple[Code, str, tuple[int, ...], Postconditions]:
        """The failure repaired, whenever it occurs: equal for two attempts at one cause."""
        return self.failure.code, self.failure.action, self.failure.objects, self.missed


@dataclass(frozen=True, slots=True)
class Repaired:
    """The result of repairing a program in an environment that it was not made for.

    Attributes:
        program: the last version.
        execution: of the last version.
        attempts: every repair, in order.
        sources: for each of its steps, the number of the original's step it is; below 0 for one that a repair inserted.
        failure: why it was given up; None when it runs and reaches its goal.
    """

    program: Program
    execution: Execution
    attempts: tuple[Attempt, ...]
    sources: tuple[int, ...]
    failure: Failure | None = None

    __repr__ = brief


def successes(attempts: Sequence[Attempt], failure: Failure | None) -> tuple[bool, ...]:
    """Return the successful attempts of one program: the program changed, and the failure did not come back at once.

    Args:
        attempts: in order.
        failure: why the program was given up after the last of them; None if it was not.
    """
    # A program that was given up still has the last attempt's failure.
    following = [*(attempt.cause for attempt in attempts[1:]), attempts[-1].cause if failure and attempts else None]
    return tuple(bool(each.after) and each.cause != later for each, later in zip(attempts, following, strict=False))


class _Task(NamedTuple):
    """The purpose of a repair: the program's goal, about these nodes, and the circumstances of each of its steps."""

    original: Program
    goal: Postconditions
    nodes: Mapping[Key, int]
    knowledge: Knowledge
    rules: Rules
    wanted: Sequence[Postconditions]

    def lost(self, execution: Execution, sources: Sequence[int]) -> Lost | None:
        """Return the first step done in other circumstances, if they are known."""
        return lost(self.original, self.wanted, sources, execution) if self.wanted else None

    def keeps(self, execution: Execution, sources: Sequence[int]) -> bool:
        """Return whether no step is done in other circumstances."""
        return self.lost(execution, sources) is None


@dataclass(frozen=True, slots=True)
class _Revision:
    """A program under repair; `sources` as in `repair_trimming.trim`."""

    program: Program
    sources: tuple[int, ...]
    execution: Execution


def repair(
    program: Program,
    world: World,
    goal: Postconditions,
    knowledge: Knowledge,
    rules: Rules = DEFAULT,
    handlers: Mapping[Code, Handler] = HANDLERS,
    tries: int = TRIES,
    canonical_only: bool = True,
    wanted: Sequence[Postconditions] = (),
) -> Repaired:
    """Repair a program until it runs and reaches its goal (thesis 5.5.4, algorithm 4).

    Args:
        program: bound to nodes of the world's home.
        world: the start.
        goal: what the original achieves in its own environment.
        knowledge, rules: those of the world.
        handlers: by failure code.
        tries: repairs at most.
        canonical_only: remove the steps that the repaired program does not need; costs more than the repairs.
        wanted: the `circumstances` of each step of the original's run, which its repair has to keep; unknown if empty.

    Returns:
        The repaired program. Or, with `failure`, what remains of it: NO_HANDLER where a failure can't be
        repaired, LOOP where the same program came up again, TOO_MANY_TRIES, GOAL_LOST,
        CIRCUMSTANCES_LOST, or HANDLER_ERROR.

    Examples:
        >>> from hearth.grounding.preconditions.postconditions import achieved
        >>> from hearth.repair.repair_loop import repair
        >>> broken = execution.program.with_steps(execution.program.steps[1:])
        >>> found = repair(broken, world, achieved(execution), known)
        >>> found.failure, [attempt.handler for attempt in found.attempts], found.program == execution.program
        (None, ['not_close'], True)
    """
    revision = _Revision(program, tuple(range(len(program.steps))), run(world, program, rules))
    task = _Task(program, goal, nodes_of(program, world), knowledge, rules, wanted)
    attempts: list[Attempt] = []
    seen = {program.steps}
    while True:
        context = _context(revision, task)
        if context is None:
            break
        if len(attempts) == tries:
            return _given_up(revision, attempts, context, Code.TOO_MANY_TRIES, f"{tries} repairs were not enough")
        name, edit, refusal = _consult(handlers, context)
        if edit is None:
            attempts.append(_attempt(attempts, context, name, ()))
            code = context.failure.code if context.failure.code in _MISSED else Code.NO_HANDLER
            return _given_up(revision, attempts, context, Code.HANDLER_ERROR if refusal else code, refusal)
        revision = _edited(revision, edit, rules)
        attempts.append(_attempt(attempts, context, edit.name, revision.program.steps))
        if revision.program.steps in seen:
            return _given_up(revision, attempts, context, Code.LOOP, f"{edit.name} leads back to an earlier program")
        seen.add(revision.program.steps)
    if not attempts or not canonical_only:
        return Repaired(revision.program, revision.execution, tuple(attempts), revision.sources)
    trimmed, sources = repair_trimming.trim(program, revision.execution, revision.sources, goal, rules, task.keeps)
    return Repaired(trimmed.program, trimmed, tuple(attempts), sources)


_MISSED = frozenset({Code.GOAL_LOST, Code.CIRCUMSTANCES_LOST})
"""The faults of a program that runs."""


def _context(revision: _Revision, task: _Task) -> RepairContext | None:
    """Return the first thing wrong with a program.

    A step that fails or is done in other circumstances, or a missed goal.
    """
    execution = revision.execution
    if execution.failure is not None:
        at = step_number(revision.program, execution.failure) - 1
        return _at(revision, task, at, execution.failure, execution.final)
    odd = task.lost(execution, revision.sources)
    if odd is not None:
        step = revision.program.steps[odd.step]
        objects = tuple(ref.node for ref in step.objects if ref.node is not None)
        names = tuple(ref.name for ref in step.objects)
        expected = "; ".join(map(str, odd.facts))
        failure = Failure(
            Code.CIRCUMSTANCES_LOST, odd.tick, step.agent, step.action, objects, names, expected, "not so"
        )
        return _at(revision, task, odd.step, failure, execution.worlds[odd.tick], odd.facts)
    missed = missing(task.goal, task.nodes, execution.final)
    if not missed:
        return None
    expected = "; ".join(map(str, missed))
    failure = Failure(Code.GOAL_LOST, len(execution.worlds) - 1, expected=expected, actual="not so at the end")
    return _at(revision, task, len(revision.program.steps), failure, execution.final, missed)


def _at(
    revision: _Revision, task: _Task, at: int, failure: Failure, world: World, missed: Postconditions = ()
) -> RepairContext:
    wanted = tuple(task.wanted[source] if source >= 0 else None for source in revision.sources) if task.wanted else ()
    return RepairContext(
        revision.program, at, failure, world, task.knowledge, task.rules,
        task.goal, task.nodes, missed, wanted, revision.execution.worlds,
    )  # fmt: skip


def _consult(handlers: Mapping[Code, Handler], context: RepairContext) -> tuple[str, Edit | None, str]:
    """(name, edit, what the handler raised): a handler that raises costs only this program."""
    handler = handlers.get(context.failure.code)
    if handler is None:
        return "", None, ""
    name = getattr(handler, "__name__", str(handler))
    try:
        return name, handler(context), ""
    except Exception as error:  # a handler's error is data too
        return name, None, f"{name} raised {type(error).__name__}: {error}"


def _edited(revision: _Revision, edit: Edit, rules: Rules) -> _Revision:
    """Return the program after an edit, run on from the last world that the edit does not touch."""
    steps, sources = list(revision.program.steps), list(revision.sources)
    known = {id(step): source for step, source in zip(steps, sources, strict=True)}
    for splice in reversed(edit.splices):
        end = splice.at + splice.removed
        replaced = sources[splice.at : end]
        new = [
            known.get(id(step), repair_trimming.STAYING if edit.stays else repair_trimming.INSERTED)
            for step in splice.inserted
        ]
        new[: len(replaced)] = replaced[: len(new)]
        steps[splice.at : end] = splice.inserted
        sources[splice.at : end] = new
    program = revision.program.with_steps(steps)
    first = min(splice.at for splice in edit.splices)
    return _Revision(program, tuple(sources), repair_trimming.resume(revision.execution, program, first, rules))


def _attempt(attempts: Sequence[Attempt], context: RepairContext, name: str, after: tuple[Step, ...]) -> Attempt:
    return Attempt(len(attempts), context.at, context.failure, name, context.program.steps, after, context.missed)


def _given_up(revision: _Revision, attempts: list[Attempt], context: RepairContext, code: Code, why: str) -> Repaired:
    """Return the failure keeps the code and text of the one that could not be repaired."""
    last = context.failure
    reason = why or UNREPAIRABLE.get(last.code, "nothing in this environment helps")
    expected = f"{last.code}: {last.expected}" if last.expected else str(last.code)
    failure = replace(last, code=code, expected=expected, actual=f"{last.actual}; {reason}" if last.actual else reason)
    return Repaired(revision.program, revision.execution, tuple(attempts), revision.sources, failure)
