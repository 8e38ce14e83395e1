"""Whether conditions hold in a world, as sampling guarantees."""

from collections.abc import Mapping

from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.schemas.literals import Key
from hearth.simulation.holds import holds
from hearth.simulation.world.world import World


def unmet(conditions: Preconditions, world: World, nodes: Mapping[Key, int]) -> tuple[Condition, ...]:
    """The conditions that do not hold; one about an object that is bound to nothing does not."""
    return tuple(condition for condition in conditions if not holds(condition.literal, world, nodes))
