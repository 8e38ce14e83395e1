"""A world as one of its characters sees it: what is out of sight has no states, hands or places."""

from __future__ import annotations

from typing import Any

from hearth.simulation.world.action_set_3_states import WIDTH, counts_of, is_wide
from hearth.simulation.world.agent import Agent, made
from hearth.simulation.world.process_ticks import Ticks
from hearth.simulation.world.world import World


def as_seen(world: World, mask: int) -> World:
    """Return the world as an agent sees it, for questions whose answers must not depend on the rest.

    Doors out of sight are neither open nor closed, so they stop nobody; characters out of sight are nowhere. Edges
    between things stay: a caller that asks about nodes of `mask` alone meets only those among them.

    Args:
        world: now.
        mask: the nodes that are seen, by index (see `visible_nodes.visible`).
    """
    if _LAST and _LAST[0][0] is world and _LAST[0][1] == mask:
        return _LAST[0][2]
    states: tuple[Any, ...] = tuple([row & mask for row in world.states[:WIDTH]])
    if is_wide(world):
        states = (*states, Ticks(tuple([row & mask for row in counts_of(world)])))
    seen = World(world.home, states, tuple([_seen(agent, mask) for agent in world.agents]), world.moved)
    _LAST[:] = [(world, mask, seen)]
    return seen


_LAST: list[tuple[World, int, World]] = []
"""The last world: the masks of legal actions and the counts of a goal ask for the same one."""


def _seen(agent: Agent, mask: int) -> Agent:
    if not agent.bit & mask:
        return Agent(agent.index, agent.bit, stride=agent.stride)
    return made((agent.index, agent.bit, *[row & mask for row in agent[2:11]], *agent[11:]))
