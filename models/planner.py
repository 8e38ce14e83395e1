"""The planner: a sketch's steps bound to nodes, and what must come between them from the repairs; nothing is learned.

It is the yardstick of table 5.2: bound to the nearest nodes, it runs always and reaches half of the goals.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from hearth.grounding.binding import nearest
from hearth.repair.loop import repair
from hearth.schemas.program import Program, Step
from hearth.simulation.engine import run
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World

Steps = tuple[Step, ...]


class Planned(NamedTuple):
    """A step of a plan, and the number of the sketch's step it does; -1 for one that only prepares others."""

    step: Step
    source: int


def bound_to_nearest(sketch: Sequence[Step], world: World) -> Steps:
    """A sketch with its objects bound to the nearest nodes of their classes, without steps whose objects the home lacks."""
    program = Program(steps=tuple(sketch))
    return complete_steps(nearest(program, world).apply(program).steps)


def complete_steps(steps: Sequence[Step]) -> Steps:
    """The steps of which every object has a node."""
    return tuple(step for step in steps if all(ref.node is not None for ref in step.objects))


def plan(steps: Sequence[Step], world: World, rules: Rules = DEFAULT) -> tuple[Planned, ...]:
    """What to do so that steps can be done one after the other; it always runs.

    A step that no repair makes possible is left out, and the rest is planned from where the character then is.

    Args:
        steps: bound to nodes.
        world: as it is now.
        rules: of the engine.

    Examples:
        >>> from hearth.models.planner import plan
        >>> [each.step.action for each in plan(execution.program.steps[1:2], world)]
        ['Walk', 'Open']
    """
    done: list[Planned] = []
    first = 0
    while first < len(steps):
        repaired = repair(
            Program(steps=tuple(steps[first:])), world, (), world.home.knowledge, rules, canonical_only=False
        )
        ran = len(repaired.execution.worlds) - 1
        done += [
            Planned(step, first + source if source >= 0 else -1)
            for step, source in zip(repaired.program.steps[:ran], repaired.sources[:ran], strict=True)
        ]
        if repaired.failure is None:
            break
        world = repaired.execution.final
        first += _stuck(repaired.sources, ran, len(steps) - first) + 1
    return tuple(done)


def _stuck(sources: Sequence[int], ran: int, count: int) -> int:
    """The number of the step that cannot be done: the first of the sketch's that is still to come."""
    return next((source for source in sources[ran:] if source >= 0), count - 1)


def planned_program(sketch: Sequence[Step], world: World, rules: Rules = DEFAULT) -> Steps:
    """The program that the planner writes for a sketch without nodes."""
    return tuple(each.step for each in plan(bound_to_nearest(sketch, world), world, rules))


def runs(steps: Sequence[Step], world: World, rules: Rules = DEFAULT) -> bool:
    """Whether a program can be done."""
    return run(world, Program(steps=tuple(steps)), rules).executable
