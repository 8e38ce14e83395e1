"""Executability: whether a program runs in its environment, else its first failing step and the error class (A.3)."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import lru_cache

from hearth.grounding.grounded_run import bound_far
from hearth.kb.action_grammar import affordances, check
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.short_repr import brief
from hearth.scoring.line_sequences import Lines, steps_of
from hearth.scoring.metrics.final_graph import nodes_of
from hearth.scoring.metrics.parsability import parsability
from hearth.scoring.predicted_nodes import bind
from hearth.scoring.signature import signature
from hearth.simulation.engine import act, run
from hearth.simulation.rules import DEFAULT, Rules, suited
from hearth.simulation.world import edge_rows
from hearth.simulation.world.world import World

SIGNATURE = signature("executable", 3, level="program", empty=0)


class ErrorClass(StrEnum):
    """The class of a program's first failure.

    `wrong order`: the program's own steps could fix it, if the failing step stood at the last place where it was
    possible, or if a later step stood before it. `additional step`: its effect already holds. `missing step`: neither.
    """

    SYNTAX = "syntax"
    UNKNOWN_NAME = "unknown name"
    ARITY = "arity"
    AFFORDANCE = "affordance"
    NOT_SIMULATED = "not simulated"
    ADDITIONAL_STEP = "additional step"
    WRONG_ORDER = "wrong order"
    MISSING_STEP = "missing step"


STATIC: dict[Code, ErrorClass] = {
    Code.SYNTAX: ErrorClass.SYNTAX,
    Code.UNKNOWN_ACTION: ErrorClass.UNKNOWN_NAME,
    Code.UNKNOWN_OBJECT: ErrorClass.UNKNOWN_NAME,
    Code.UNKNOWN_AGENT: ErrorClass.UNKNOWN_NAME,
    Code.UNBOUND: ErrorClass.UNKNOWN_NAME,
    Code.WRONG_ARITY: ErrorClass.ARITY,
    Code.NOT_AFFORDED: ErrorClass.AFFORDANCE,
    Code.NOT_SIMULATED: ErrorClass.NOT_SIMULATED,
}
"""The class of failures that do not depend on earlier steps; UNBOUND is an object that the environment lacks."""

ALREADY_IN: dict[Code, str] = {
    Code.IS_OPEN: "OPEN",
    Code.IS_CLOSED: "CLOSED",
    Code.IS_ON: "ON",
    Code.IS_OFF: "OFF",
    Code.IS_PLUGGED: "PLUGGED_IN",
    Code.IS_UNPLUGGED: "PLUGGED_OUT",
    Code.SITTING: "SITTING",
    Code.LYING: "LYING",
}
"""Failures that imply that an action's state already holds."""

ALREADY_SO = {Code.NOT_SITTING_OR_LYING: "rises", Code.NOT_WORN: "dresses", Code.NOT_HOLDING: "lets_go"}
"""Failures that imply that the effect of a group of actions already holds."""


PLACED: dict[str, Callable[[World, int], int]] = {"ON": edge_rows.on, "INSIDE": edge_rows.inside}
"""Relations in which a thing may be put, each with the row of the result.

A repeated action of this kind is an additional step.
"""

First = tuple[int, ErrorClass, Code]


@dataclass(frozen=True, slots=True)
class Executability:
    """The result of running a predicted program.

    Attributes:
        program: its steps, canonical and bound, without lines that do not parse.
        empty: whether it has no lines. Such a program is not executable, and is counted separately.
        afforded: whether the grammar allows every step's objects.
        runs: whether every line is a step, and all of them run.
        failed_line: the first failing line, from 1; None without a failure.
        error: its error class.
        code: its failure code.
        final: the world at its end; None unless it runs.
    """

    program: Program
    empty: bool
    afforded: bool
    runs: bool
    failed_line: int | None = None
    error: ErrorClass | None = None
    code: Code | None = None
    final: World | None = None

    __repr__ = brief

    @property
    def executable(self) -> bool:
        """Return whether the program has steps, the grammar allows every step's objects, and all steps run (A.3)."""
        return not self.empty and self.afforded and self.runs


def executability(
    lines: Lines, world: World, reference: Program | None = None, rules: Rules = DEFAULT
) -> Executability:
    """Run a predicted program in an environment (thesis 4.5.2, A.3).

    Args:
        lines: the prediction.
        world: the environment at its start.
        reference: the bound reference, which guides the binding (see `predicted_nodes`). Without one the objects are
            bound as `run` binds them: as many steps as possible run.
        rules: of simulation.

    Examples:
        >>> from hearth.scoring.line_sequences import read
        >>> found = hearth.executability(read(["[Walk] <fridge> (1)", "[Close] <fridge> (1)"]), world)
        >>> found.executable, found.failed_line, str(found.code)
        (False, 2, 'IS_CLOSED')
    """
    knowledge = world.home.knowledge
    faults = {fault.line: fault.code for fault in parsability(lines, knowledge).faults}
    program = Program(steps=tuple([_canonical(step, knowledge) for step in steps_of(lines)]))
    if reference is None:
        rules = suited(program, knowledge, rules)
        program, _ = bound_far(program, world, rules)
    program = bind(program, nodes_of(world.home), knowledge, reference)
    place = [number for number, line in enumerate(lines) if isinstance(line, Step)]
    steps = zip(place, program.steps, strict=True)
    unfit = [line for line, step in steps if line not in faults and not _fits(step, knowledge)]
    sound = sum(line < min(faults, default=len(lines)) for line in place)
    execution = run(world, program.with_steps(program.steps[:sound]), rules)
    failures: list[First] = [(line, STATIC.get(code, ErrorClass.SYNTAX), code) for line, code in sorted(faults.items())]
    failures += [(line, ErrorClass.AFFORDANCE, Code.NOT_AFFORDED) for line in unfit]
    if execution.failure is not None:
        failed = _failed_step(program.steps, execution.failure)
        why = _classify(program.steps, failed, execution.worlds, execution.failure, rules)
        failures.append((place[failed], why, execution.failure.code))
    line, error, code = min(failures, key=lambda failure: failure[0]) if failures else (None, None, None)
    runs = execution.executable and not faults
    final = execution.final if runs else None
    failed_line = None if line is None else line + 1
    return Executability(program, not lines, not unfit and not faults, runs, failed_line, error, code, final)


def _canonical(step: Step, knowledge: Knowledge) -> Step:
    """Return the step with canonical names; unchanged if it has a fault."""
    names = tuple([ref.name for ref in step.objects])
    action, canonical = _names(step.action, names, knowledge)
    if action == step.action and canonical == names:
        return step
    objects = tuple(replace(ref, name=name) for ref, name in zip(step.objects, canonical, strict=True))
    return replace(step, action=action, objects=objects)


@lru_cache(maxsize=65_536)
def _names(action: str, names: tuple[str, ...], knowledge: Knowledge) -> tuple[str, tuple[str, ...]]:
    """Return the canonical names of a step without instances, cached because steps recur in a corpus."""
    program, _ = check(Program(steps=(Step(action, tuple(map(ObjectRef, names))),)), knowledge)
    return program.steps[0].action, tuple(ref.name for ref in program.steps[0].objects)


def _fits(step: Step, knowledge: Knowledge) -> bool:
    """Return whether the grammar allows the step's objects in their roles."""
    return _afforded(step.action, tuple([ref.name for ref in step.objects]), knowledge)


@lru_cache(maxsize=65_536)
def _afforded(action: str, names: tuple[str, ...], knowledge: Knowledge) -> bool:
    return not affordances(Program(steps=(Step(action, tuple(map(ObjectRef, names))),)), knowledge)


def _failed_step(steps: Sequence[Step], failure: Failure) -> int:
    """Return the index of the failing step: the agent's step in the failing tick."""
    starts = [number for number, step in enumerate(steps) if not number or not step.joins]
    start = starts[failure.tick]
    end = starts[failure.tick + 1] if failure.tick + 1 < len(starts) else len(steps)
    return next((n for n in range(start, end) if steps[n].agent == failure.agent), start)


def _classify(
    steps: Sequence[Step], failed: int, worlds: Sequence[World], failure: Failure, rules: Rules
) -> ErrorClass:
    if failure.code in STATIC:
        return STATIC[failure.code]
    already = is_already_so(steps[failed].action, failure.code, worlds[0].home.knowledge)
    if already or (failure.code is Code.NOT_HOLDING and _is_put(steps[failed], worlds[-1])):
        return ErrorClass.ADDITIONAL_STEP
    alone = len(worlds) == failed + 1  # with several agents per tick, worlds and steps do not correspond
    if alone and _mended_by_order(steps, failed, worlds, rules):
        return ErrorClass.WRONG_ORDER
    return ErrorClass.MISSING_STEP


def is_already_so(action: str, code: Code, knowledge: Knowledge) -> bool:
    """Return whether a failure implies that the action's effect already holds."""
    if code in ALREADY_IN:
        return action in knowledge.achieving(ALREADY_IN[code])
    return code in ALREADY_SO and action in knowledge.group(ALREADY_SO[code])


def _is_put(step: Step, world: World) -> bool:
    """Return whether the object of a put is already at its destination."""
    read = PLACED.get(world.home.knowledge.relation_of(step.action))
    if read is None:
        return False
    o, s = (world.home.index[ref.node] for ref in step.objects if ref.node is not None)
    return bool(read(world, o) >> s & 1)


def _mended_by_order(steps: Sequence[Step], failed: int, worlds: Sequence[World], rules: Rules) -> bool:
    """Return whether the failing step succeeds after moving one step: a later one before it, or itself forward."""
    step = steps[failed]
    later = dict.fromkeys(steps[failed + 1 :])
    if any(_runs(worlds[failed], (other, step), rules) for other in later):
        return True
    could = next((n for n in range(failed - 1, -1, -1) if _runs(worlds[n], (step,), rules)), None)
    return could is not None and _runs(worlds[could], (step, *steps[could:failed]), rules)


def _runs(world: World, steps: Sequence[Step], rules: Rules) -> bool:
    for step in steps:
        result = act(world, step, rules)
        if isinstance(result, Failure):
            return False
        world = result
    return True
