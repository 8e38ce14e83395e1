"""Inferring preconditions by running a program in a minimal home in which only the preconditions found so far hold.

A precondition is abduced from the first failing step, and the program is run again. So every condition has the step
that needs it, and a contradictory program is reported with the step that fails and the step that violated its
condition (thesis 5.5.2: the function Phi).
"""

from collections.abc import Set
from dataclasses import replace
from itertools import islice

from hearth.grounding.preconditions.abduction import StartContext, conditions_for
from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.grounding.preconditions.default_conditions import default_conditions
from hearth.grounding.preconditions.minimal_home import SketchHome, sketch
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code, Failure
from hearth.schemas.literals import Key, Literal
from hearth.schemas.program import Program, Step
from hearth.simulation.engine import Execution, run
from hearth.simulation.rules import DEFAULT, Rules, suited
from hearth.simulation.world.world import World

MAX_CONDITIONS = 200
"""A program that needs more than this many tries is given up."""

CAUSED_BY_START = frozenset(
    {Code.UNBOUND, Code.NOT_AFFORDED, Code.NOT_SIMULATED, Code.UNKNOWN_ACTION, Code.UNKNOWN_AGENT}
)
"""Failures that no start prevents."""


def infer(program: Program, knowledge: Knowledge, rules: Rules = DEFAULT) -> Preconditions | Failure:
    """Return the conditions under which a program runs, or the failure that no start prevents (thesis 5.5.2).

    A failure of a program that contradicts itself has code CONTRADICTION; its `expected` names the condition and the
    step that needs it, its `actual` the step that violates it.

    Examples:
        >>> list(map(str, hearth.infer(program, known)))
        ['inside(milk (1), fridge (1))', 'closed(fridge (1))']
    """
    program = program.numbered()
    conditions, execution, step = _inferred(program, knowledge, rules)
    if execution.failure is None:
        return conditions
    return _contradiction(program, conditions, execution, step, knowledge, rules)


def at_odds(program: Program, knowledge: Knowledge, rules: Rules = DEFAULT) -> tuple[int, ...]:
    """Return the steps of a contradiction: one that no start makes possible, or it and those that prevent it."""
    program = program.numbered()
    conditions, execution, step = _inferred(program, knowledge, rules)
    if execution.failure is None:
        return ()
    if execution.failure.code in CAUSED_BY_START:
        return (step,)
    return (*_culprits(program, conditions, execution.failure.code, step, knowledge, rules), step)


def _inferred(program: Program, knowledge: Knowledge, rules: Rules) -> tuple[Preconditions, Execution, int]:
    """Return the conditions found, the last try with them, and the step it failed at, if it did."""
    conditions = Preconditions(tuple(default_conditions(program, knowledge)))
    rules = suited(program, knowledge, rules)
    tried: dict[int, set[Literal[Key]]] = {}
    for _ in range(MAX_CONDITIONS):
        place = sketch(program, conditions, knowledge)
        execution = run(World.start(place.home), place.program, rules)
        if execution.failure is None:
            return conditions, execution, -1
        step = _step_of(program, execution.failure.tick)
        found = _next(conditions, execution, place, step, tried.setdefault(step, set()), knowledge)
        if found is None:
            break
        conditions = found
    return conditions, execution, step


def _next(
    conditions: Preconditions,
    execution: Execution,
    place: SketchHome,
    step: int,
    tried: set[Literal[Key]],
    knowledge: Knowledge,
) -> Preconditions | None:
    """Return the conditions with one more that may help at this step, or without a default that conflicts."""
    failure = execution.failure
    assert failure is not None
    if failure.code in CAUSED_BY_START:
        return None
    context = StartContext(place.program, step, failure, execution.final, knowledge, execution.worlds[0], place.keys)
    for condition in conditions_for(context):
        if condition.literal not in tried and not _against(condition, conditions):
            tried.add(condition.literal)
            return _settled(conditions, condition)
    key = context.key() if failure.objects else None
    soft = [c for c in conditions if not c.hard and (key is None or key in c.objects)]
    return conditions.without(soft[-1]) if soft else None


def _against(new: Condition, conditions: Preconditions) -> bool:
    """Return whether a hard condition already says the opposite."""
    opposite = _OPPOSITES.get(new.name)
    return opposite is not None and any(c.name == opposite and c.objects == new.objects and c.hard for c in conditions)


def _settled(conditions: Preconditions, new: Condition) -> Preconditions:
    """Return the new condition instead of soft ones it excludes.

    Two places for one thing, or a thing's opposite state.
    """
    rivals = [
        c
        for c in conditions
        if not c.hard
        and c.objects[0] == new.objects[0]
        and c.literal != new.literal
        and (c.name == _OPPOSITES.get(new.name) or (c.name in _PLACES and new.name in _PLACES))
    ]
    return conditions.without(*rivals).plus(new)


_PLACES = frozenset({"in", "inside", "location", "together", "holds"})

_OPPOSITES = {
    name: opposite
    for pair in (("closed", "open"), ("is_on", "is_off"), ("plugged", "unplugged"), ("sitting", "lying"))
    for name, opposite in (pair, pair[::-1])
}


def _step_of(program: Program, tick: int) -> int:
    """Return the first step of a tick."""
    number = -1
    for index, step in enumerate(program.steps):
        number += not step.joins
        if number == tick:
            return index
    return len(program.steps) - 1


def _contradiction(
    program: Program, conditions: Preconditions, execution: Execution, step: int, knowledge: Knowledge, rules: Rules
) -> Failure:
    failure = execution.failure
    assert failure is not None
    if failure.code in CAUSED_BY_START:
        return failure
    culprits = _culprits(program, conditions, failure.code, step, knowledge, rules)
    named = " and ".join(f"step {number + 1}, [{program.steps[number].action}]" for number in culprits)
    by = f"made impossible by {named}" if culprits else "by no step"
    needed = f"{failure.code}: {failure.expected} at step {step + 1}"
    return replace(failure, code=Code.CONTRADICTION, expected=needed, actual=f"{failure.actual}; {by}")


def _culprits(
    program: Program, conditions: Preconditions, code: Code, step: int, knowledge: Knowledge, rules: Rules
) -> tuple[int, ...]:
    """Return the earlier steps that make a step impossible: without one of them, some start makes it possible.

    Where no single one does, the last step is named without which, and without those after it, the step is possible;
    none where no start makes the step alone possible, unless without a step about the same object it is. A step that
    needs a free hand has a culprit for each hand.
    """
    guess = _likely_culprit(program, conditions, step, knowledge)
    alone = _possible(_until(program, step, {*range(step)}), knowledge, rules)
    before = [n for n in range(step - 1, -1, -1) if alone or _share(program.steps[n], program.steps[step])]
    order = dict.fromkeys([*([] if guess is None else [guess]), *before])
    needed = (number for number in order if _possible(_until(program, step, {number}), knowledge, rules))
    found = tuple(sorted(islice(needed, 2 if code is Code.NO_FREE_HAND else 1)))
    if found:
        return found
    suffixes = ({*range(first, step)} for first in range(step - 1, -1, -1) if alone)
    last = next((left for left in suffixes if _possible(_until(program, step, left), knowledge, rules)), None)
    return () if last is None else (min(last),)


def _share(one: Step, other: Step) -> bool:
    """Return whether two steps are about the same object."""
    return not {ref.key for ref in one.objects}.isdisjoint(ref.key for ref in other.objects)


def _until(program: Program, step: int, left_out: Set[int]) -> Program:
    """Return the program up to a step, without some of the steps before."""
    steps: list[Step] = []
    for number, each in enumerate(program.steps[: step + 1]):
        if number not in left_out:
            begins = each.joins and (not steps or number - 1 in left_out)
            steps.append(replace(each, joins=False) if begins else each)
    return program.with_steps(steps)


def _possible(program: Program, knowledge: Knowledge, rules: Rules) -> bool:
    """Return whether some start makes a program run."""
    _, execution, _ = _inferred(program, knowledge, rules)
    return execution.failure is None


def _likely_culprit(program: Program, conditions: Preconditions, step: int, knowledge: Knowledge) -> int | None:
    """Return the step that probably needed or did the opposite, which is tried first.

    The one a condition on the same object stems from, else the last earlier step about that object, else the last that
    moved the character.
    """
    keys = {ref.key for ref in program.steps[step].objects}
    changing = frozenset[str]().union(*map(knowledge.group, ("operates", "takes", "frees_hand", "dresses")))
    for number in range(step - 1, -1, -1):
        if keys & {ref.key for ref in program.steps[number].objects} and program.steps[number].action in changing:
            return number
    needed = [c.step for c in conditions if c.name in _OPPOSITES and c.objects[0] in keys and c.step < step]
    if needed:
        return needed[-1]
    moving = knowledge.group("goes") | knowledge.group("rests") | knowledge.group("rises")
    return next((n for n in range(step - 1, -1, -1) if program.steps[n].action in moving), None)
