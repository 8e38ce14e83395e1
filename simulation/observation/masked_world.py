"""A world as one of its characters sees it: what is out of sight has no states, hands or places."""

from __future__ import annotations

from hearth.simulation.world.agent import Agent, made
from hearth.simulation.world.world import World


def as_seen(world: World, mask: int) -> World:
    """Return the world as an agent sees it, for questions whose answers must not depend on the rest.

    Doors out of sight are neither open nor closed, so they stop nobody; characters out of sight are nowhere. Edges
    between things stay: a caller that asks about nodes of `mask` alone meets only those among them.

    Args:
        world: now.
        mask: the nodes that are seen, by index (see `visible_nodes.visible`).
    """
    states = tuple([row & mask for row in world.states])
    return World(world.home, states, tuple([_seen(agent, mask) for agent in world.agents]), world.moved)


def _seen(agent: Agent, mask: int) -> Agent:
    if not agent.bit & mask:
        return Agent(agent.index, agent.bit, stride=agent.stride)
    return made((agent.index, agent.bit, *[row & mask for row in agent[2:11]], *agent[11:]))
