"""Planning without learning: a sketch's steps bound to nodes, and the steps between them from the repairs."""

from collections.abc import Sequence
from typing import NamedTuple

from hearth.grounding.binding import nearest
from hearth.repair.runnable_predictions import complete
from hearth.schemas.program import Program, Step
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World

Steps = tuple[Step, ...]


class Planned(NamedTuple):
    """A step of a plan, and the number of the sketch's step it does; -1 for one that only prepares others."""

    step: Step
    source: int


def bound_to_nearest(sketch: Sequence[Step], world: World) -> Steps:
    """Return a sketch with its objects bound to the nearest nodes of their classes.

    Steps whose objects the home lacks go.
    """
    program = Program(steps=tuple(sketch))
    return complete_steps(nearest(program, world).apply(program).steps)


def complete_steps(steps: Sequence[Step]) -> Steps:
    """Return the steps of which every object has a node."""
    return tuple(step for step in steps if all(ref.node is not None for ref in step.objects))


def plan(steps: Sequence[Step], world: World, rules: Rules = DEFAULT) -> tuple[Planned, ...]:
    """Return a plan in which the steps can be done one after the other; it always runs.

    A step that no repair makes possible is left out.

    Args:
        steps: bound to nodes.
        world: as it is now.
        rules: of the engine.
    """
    done = complete(tuple(steps), world, world.home.knowledge, rules)
    return tuple(map(Planned, done.execution.program.steps, done.sources))


def planned_program(sketch: Sequence[Step], world: World, rules: Rules = DEFAULT) -> Steps:
    """Return the program that the planner writes for a sketch without nodes."""
    return tuple(each.step for each in plan(bound_to_nearest(sketch, world), world, rules))
