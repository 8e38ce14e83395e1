"""Completing predicted steps so that they run: bound to the nearest nodes, repaired, the others left out."""

from typing import NamedTuple

from hearth.grounding.binding import nearest
from hearth.kb.knowledge import Knowledge
from hearth.repair.repair_loop import repair
from hearth.schemas.failures import Failure
from hearth.schemas.program import Program, Step
from hearth.simulation.engine import Execution
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World

Steps = tuple[Step, ...]


class Completion(NamedTuple):
    """A program that runs.

    Attributes:
        execution: of the program.
        left_out: the steps that no repair makes run there, each with its failure.
        sources: for each step, the number of the given step that it is; -1 for one that a repair inserted.
    """

    execution: Execution
    left_out: tuple[tuple[Step, Failure], ...]
    sources: tuple[int, ...]


def complete(steps: Steps, world: World, knowledge: Knowledge, rules: Rules = DEFAULT) -> Completion:
    """Bind each object to the nearest node of its class, repair the program, and leave out what can't be repaired.

    Args:
        steps: of one agent; objects with nodes keep them.
        world: the start.
        knowledge, rules: those of the world.
    """
    program = Program(steps=steps)
    program = nearest(program, world).apply(program)
    left_out: list[tuple[Step, Failure]] = []
    numbers = list(range(len(steps)))
    while True:
        done = repair(program, world, (), knowledge, rules, canonical_only=False)
        failure = done.execution.failure
        if failure is None:
            sources = tuple(numbers[source] if source >= 0 else -1 for source in done.sources)
            return Completion(done.execution, tuple(left_out), sources)
        place = _source(done.sources, len(done.execution.worlds) - 1, len(program.steps))
        left_out.append((program.steps[place], failure))
        del numbers[place]
        program = program.with_steps(program.steps[:place] + program.steps[place + 1 :])


def _source(sources: tuple[int, ...], failed: int, count: int) -> int:
    """Return the step of the original that a failing step is, or that it was inserted for."""
    later = (source for source in sources[failed:] if source >= 0)
    earlier = (source for source in reversed(sources[:failed]) if source >= 0)
    return min(next(later, next(earlier, 0)), count - 1)
