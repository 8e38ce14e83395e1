"""Canonical repairs, without unneeded steps.

A step that a repair has inserted stays only if without it the program stops or misses its goal, or if the repair asks
for it; no walk leads to where the character has just walked; nothing is opened only to be closed again.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from hearth.grounding.preconditions.postconditions import Postconditions, nodes_of, reached
from hearth.kb.knowledge import Knowledge
from hearth.schemas.program import Program, Step
from hearth.schemas.vocabulary import OPPOSITE
from hearth.simulation.engine import Execution, run
from hearth.simulation.rules import Rules
from hearth.simulation.world.world import World

INSERTED, STAYING = -1, -2
"""Sources of steps that a repair has inserted: removed where they are not needed, or not."""


def resume(execution: Execution, program: Program, first: int, rules: Rules) -> Execution:
    """Run a program that equals the one already run up to step `first`, from the world before that step.

    Args:
        execution: of the earlier program.
        program: the new one, whole.
        first: number of the first step that differs.
        rules: for the run.
    """
    together = any(step.joins for step in program.steps) or any(step.joins for step in execution.program.steps)
    if together or first >= len(execution.worlds):
        return run(execution.worlds[0], program, rules)
    rest = run(execution.worlds[first], Program(steps=program.steps[first:]), rules)
    failure = rest.failure
    if failure is not None:
        failure = replace(failure, tick=failure.tick + first)
    return Execution(program, (*execution.worlds[:first], *rest.worlds), failure, rules)


def trim(
    original: Program,
    execution: Execution,
    sources: tuple[int, ...],
    goal: Postconditions,
    rules: Rules,
    keeps: Callable[[Execution, Sequence[int]], bool] = lambda _execution, _sources: True,
) -> tuple[Execution, tuple[int, ...]]:
    """Remove unneeded steps, until no more can be removed.

    Args:
        original: the program before any repair.
        execution: of the repaired program, which runs and reaches its goal.
        sources: for each of its steps, the number of the original's step it is, or INSERTED, or STAYING; the
            original's stay, unless repairing made them void.
        goal: what must stay reached; the characters' hands, too, must end up holding what they hold now.
        rules: for the runs.
        keeps: whether a shorter program, with its sources, does its steps as it has to.

    Returns:
        The execution of the remaining steps, and their sources.
    """
    nodes = nodes_of(original, execution.final)
    hands = _hands(execution.final)

    def suffices(shorter: Execution, left: tuple[int, ...]) -> bool:
        end = shorter.final
        reaches = shorter.failure is None and _hands(end) == hands and reached(goal, nodes, end)
        return reaches and keeps(shorter, left)

    while True:
        smaller = next(_smaller(original, execution, sources, suffices, rules), None)
        if smaller is None:
            return execution, sources
        execution, sources = smaller


def _smaller(
    original: Program,
    execution: Execution,
    sources: tuple[int, ...],
    suffices: Callable[[Execution, tuple[int, ...]], bool],
    rules: Rules,
) -> Iterator[tuple[Execution, tuple[int, ...]]]:
    """Yield the program without one step, or without a pair of steps that undo each other, where it still does its
    work.
    """
    for start, end in _candidates(original, execution.program.steps, sources, execution.final.home.knowledge):
        steps = execution.program.steps
        program = execution.program.with_steps(steps[:start] + steps[end:])
        shorter = resume(execution, program, start, rules)
        left = sources[:start] + sources[end:]
        if suffices(shorter, left):
            yield shorter, left


def _candidates(
    original: Program, steps: tuple[Step, ...], sources: tuple[int, ...], knowledge: Knowledge
) -> Iterator[tuple[int, int]]:
    together = {n for n, step in enumerate(steps) if step.joins} | {n - 1 for n, s in enumerate(steps) if s.joins}
    walks = knowledge.group("walks")
    neighbours = set(zip(original.steps, original.steps[1:], strict=False))
    for number in range(len(steps) - 1, -1, -1):
        if number in together or sources[number] == STAYING:
            continue
        if sources[number] == INSERTED or _walks_where_it_is(original, steps, number, walks):
            yield number, number + 1
        pair, of = steps[number : number + 2], sources[number : number + 2]
        undone = len(pair) == 2 and pair not in neighbours and _undo(*pair, max(of) < 0, knowledge)
        if undone and STAYING not in of:
            yield number, number + 2


def _undo(one: Step, other: Step, both_new: bool, knowledge: Knowledge) -> bool:
    """Return whether a step undoes the one before it.

    Sitting down and taking something are only undone where both are new.
    """
    if one.agent != other.agent:
        return False
    if both_new and other.action in knowledge.group("rises"):
        return one.action in knowledge.group("rests")
    if one.objects != other.objects:
        return False
    made = knowledge.state_of(one.action)
    if made:
        return knowledge.state_of(other.action) in (OPPOSITE.get(made), *knowledge.excludes(made))
    return both_new and any(
        first.action in knowledge.group("takes") and then.action in knowledge.group("lets_go")
        for first, then in ((one, other), (other, one))
    )


def _walks_where_it_is(original: Program, steps: tuple[Step, ...], number: int, walks: frozenset[str]) -> bool:
    """Return whether a walk follows one to the same place, and did not in the original."""
    step = steps[number]
    return _last_walk(steps, number, walks) == step.objects and step not in _repeated_walks(original, walks)


def _last_walk(steps: tuple[Step, ...], number: int, walks: frozenset[str]) -> object:
    """Return where the walk before this walk went; None if this is not a walk or the first."""
    if steps[number].action not in walks:
        return None
    earlier = (s for s in reversed(steps[:number]) if s.agent == steps[number].agent and s.action in walks)
    last = next(earlier, None)
    return last.objects if last is not None else None


def _repeated_walks(original: Program, walks: frozenset[str]) -> set[Step]:
    """Walks that the original itself makes to where its last walk went."""
    return {s for n, s in enumerate(original.steps) if _last_walk(original.steps, n, walks) == s.objects}


def _hands(world: World) -> tuple[int, ...]:
    """Return the objects that each character holds."""
    return tuple(agent.held for agent in world.agents)
