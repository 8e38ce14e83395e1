"""The state of a world: all that reading its rows needs (see `edge_rows`)."""

from hearth.simulation.world.agent import Agent
from hearth.simulation.world.home import Home
from hearth.simulation.world.moved_edges import Moved


class WorldState:
    """A home, and the differences from it at one moment.

    Attributes:
        home: what never changes.
        states: one set of nodes for each of `vocabulary.STATES`.
        agents: the characters, in id order.
        moved: what differs from the home's edges between things.
    """

    __slots__ = ("agents", "home", "moved", "states")

    def __init__(self, home: Home, states: tuple[int, ...], agents: tuple[Agent, ...], moved: Moved) -> None:
        self.home = home
        self.states = states
        self.agents = agents
        self.moved = moved
