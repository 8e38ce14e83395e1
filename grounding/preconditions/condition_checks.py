"""Tests whether conditions hold in a world, as sampling guarantees."""

from collections.abc import Mapping

from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.schemas.failures import Code, Failure
from hearth.schemas.literals import Key
from hearth.schemas.program import Program
from hearth.schemas.syntax import print_step
from hearth.simulation.literal_truth import holds
from hearth.simulation.world.world import World


def unmet(conditions: Preconditions, world: World, nodes: Mapping[Key, int]) -> tuple[Condition, ...]:
    """Return the conditions that do not hold; one about an object that is bound to nothing does not."""
    return tuple(condition for condition in conditions if not holds(condition.literal, world, nodes))


def unmet_failure(condition: Condition, program: Program, draws: int) -> Failure:
    """Return the failure of sampling in which a condition of a program held in no environment drawn."""
    names = tuple(name for name, _ in condition.objects)
    expected, actual = condition.in_words(), f"it so in none of {draws} environments drawn"
    if condition.step >= len(program.steps):
        return Failure(Code.CONDITION_UNMET, names=names, expected=expected, actual=actual)
    step = program.steps[condition.step]
    tick = sum(not other.joins for other in program.steps[1 : condition.step + 1])
    expected = f"{expected}, as step {condition.step + 1}, {print_step(step)}, needs"
    return Failure(Code.CONDITION_UNMET, tick, step.agent, step.action, (), names, expected, actual)
