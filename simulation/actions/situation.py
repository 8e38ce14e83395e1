"""A world for one agent, with sets of nodes that the masks of actions are made of.

A mask is set algebra over these sets alone, so that it can also be read as a program (see `arrays.mask_tracing`).
"""

from functools import cached_property

from hearth.simulation.motion import positions
from hearth.simulation.motion.stride_ahead import closed_doors, stride_ahead
from hearth.simulation.observation import reach, visible_nodes
from hearth.simulation.rules import Rules
from hearth.simulation.world import edge_rows
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.states import LYING, SITTING
from hearth.simulation.world.world import World


class Situation:
    """A world for one agent; the sets that several actions share are computed once, on first use."""

    def __init__(self, world: World, number: int, rules: Rules) -> None:
        self.world = world
        self.home = world.home
        self.number = number
        self.rules = rules
        self.me: Agent = world.agents[number]
        self.states = world.states
        self.held = self.me.held
        self.free_hand = not (self.me.right and self.me.left)
        self.sitting = bool(world.states[SITTING] & self.me.bit)
        self.lying = bool(world.states[LYING] & self.me.bit)
        self.resting = self.sitting or self.lying

    @cached_property
    def close(self) -> int:
        """Things that the agent is close to."""
        return reach.near_to(self.world, self.me, self.rules.near_hands)

    @cached_property
    def facing(self) -> int:
        """Things that the agent faces."""
        return reach.faced_by(self.world, self.me)

    @cached_property
    def hidden(self) -> int:
        """Things inside closed containers."""
        return visible_nodes.hidden(self.world)

    @cached_property
    def walkable(self) -> int:
        """Things that can be walked to, once the agent stands."""
        return reach.walkable(self.world, self.me, self.rules.doors)

    @cached_property
    def walked_to(self) -> int:
        """Things to which a way over the floor leads."""
        return positions.walked_to(self.world, self.number, closed_doors(self.world, self.rules))

    @cached_property
    def ahead(self) -> bool:
        """Return whether a stride straight ahead is free."""
        return stride_ahead(self.world, self.number, self.rules)[0] is not None

    @cached_property
    def in_use(self) -> int:
        """Seats and beds that a sitting or lying character is on."""
        resting, used = self.states[SITTING] | self.states[LYING], 0
        for agent in self.world.agents:
            if resting & agent.bit:
                used |= agent.on
        return used

    def with_room(self, places: int, lying: bool, made_bed: bool) -> int:
        """Return the seats or beds among some places on which there is room, with the rule `made_bed` or without."""
        world, known = self.world, self.home.free_places
        key = places, lying, made_bed, tuple([(agent.bit, agent.on, agent.worn) for agent in world.agents])
        found = known.find(world.moved, key)
        if found is None:
            taken = ((i, edge_rows.taking_room(world, i, made_bed)) for i in indices(places))
            free = mask_of(i for i, things in taken if things.bit_count() < self.home.limit(i, lying))
            found = known.keep(world.moved, key, free)
        return found

    @cached_property
    def held_by_others(self) -> int:
        """Things that other characters hold."""
        found = 0
        for number, other in enumerate(self.world.agents):
            if number != self.number:
                found |= other.held
        return found

    @cached_property
    def full_handed(self) -> int:
        """Other characters that can't be handed anything."""
        others = (a for n, a in enumerate(self.world.agents) if n != self.number)
        return mask_of(a.index for a in others if a.right and a.left)

    def able(self, action: str, position: int = 0) -> int:
        """Objects that the knowledge allows for an argument."""
        return self.home.able(action, position)
