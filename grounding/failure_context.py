"""The context of a failed step, which abduction and repairs both start from."""

from dataclasses import dataclass

from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Failure
from hearth.schemas.program import Program
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.world import World


@dataclass(frozen=True, slots=True)
class FailureContext:
    """A failed step and the world before it.

    Attributes:
        program: bound to nodes.
        at: number of the failing step, from 0; one past the last when the program ran but missed its goal.
        failure: why it fails.
        world: the world as the step is tried.
        knowledge: that of the world.
    """

    program: Program
    at: int
    failure: Failure
    world: World
    knowledge: Knowledge

    @property
    def agent(self) -> Agent:
        """The character whose step failed."""
        return self.world.agents[self.failure.agent]

    def index(self, position: int = 0) -> int:
        """Index of the node that the failure names at this position."""
        return self.world.home.index[self.failure.objects[position]]

    def group(self, name: str) -> frozenset[str]:
        """Return the actions of a group (see `kb.action_groups`)."""
        return self.knowledge.group(name)
