"""The changes that literals say, made in a world: effects of acts of action set 3, and of processes."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache

from hearth.kb.formula import GONE, Term
from hearth.kb.knowledge import Knowledge
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import EVERY_STATE_ID
from hearth.simulation.world import moved_edges as kinds
from hearth.simulation.world.edge_rows import Numbered
from hearth.simulation.world.moved_edges import Moved, unlink_all
from hearth.simulation.world.single_edge_changes import linked, unlinked
from hearth.simulation.world.world import World

Change = tuple[Literal[Term], tuple[int, ...]]
"""A literal and the indices of its terms; names of states have none."""


def made(changes: Iterable[Change], world: World) -> World:
    """Return a world after changes: what ends first, then what begins, then what is gone."""
    every = list(changes)
    added = [change for change in every if not change[0].negated and change[0].name not in ("state", GONE)]
    removed = [change for change in every if change[0].negated and change[0].name not in ("state", "REMEMBERS")]
    for literal, nodes in every:
        if literal.name == "REMEMBERS":
            world = _forgotten(world, 1 << nodes[0])
    world = unlinked(world, map(_edge, removed)) if removed else world
    world = _restated(world, every)
    world = linked(world, map(_edge, added)) if added else world
    for literal, nodes in every:
        if literal.name == GONE:
            world = gone(world, nodes[0])
    return world


def _edge(change: Change) -> Numbered:
    literal, (i, j) = change
    return i, literal.name, j


def _restated(world: World, changes: Iterable[Change]) -> World:
    states = None
    excludes = excluded(world.home.knowledge)
    for begins in (False, True):
        for literal, nodes in changes:
            if literal.name == "state" and literal.negated != begins:
                states = list(world.states) if states is None else states
                number, bit = EVERY_STATE_ID[literal.terms[1].name], 1 << nodes[0]
                if begins:
                    states[number] |= bit
                    for other in excludes[number]:
                        states[other] &= ~bit
                else:
                    states[number] &= ~bit
    return world if states is None else World(world.home, tuple(states), world.agents, world.moved)


@lru_cache(maxsize=8)
def excluded(knowledge: Knowledge) -> tuple[tuple[int, ...], ...]:
    """For each row of a state the rows of those that it excludes."""
    return tuple(
        tuple(EVERY_STATE_ID[other] for other in knowledge.excludes(name) if other in EVERY_STATE_ID)
        for name in EVERY_STATE_ID
    )


_ALL = (kinds.ON, kinds.BEARS, kinds.INSIDE, kinds.CONTENTS, kinds.CLOSE, kinds.FACING, kinds.FACED)


def gone(world: World, i: int) -> World:
    """Return a world in which a thing is used up.

    Nowhere, in no hand, close to nothing, remembered by nobody, and GONE.
    """
    bit = 1 << i
    moved = world.moved
    extra = dict(moved.extra)
    unlink_all(extra, i, _ALL)
    nowhere = Moved(moved.on | bit, moved.inside | bit, moved.close | bit, moved.facing | bit, extra)
    states = list(world.states)
    states[EVERY_STATE_ID["GONE"]] |= bit
    agents = tuple(agent.without(bit) for agent in world.agents)
    return _forgotten(World(world.home, tuple(states), agents, nowhere), bit)


def is_gone(world: World, i: int) -> bool:
    """Return whether a thing of a world of action set 3 is used up."""
    return bool(world.states[EVERY_STATE_ID["GONE"]] >> i & 1)


def _forgotten(world: World, bit: int) -> World:
    agents = tuple(
        agent._replace(origins=tuple(entry for entry in agent.origins if not bit >> entry[0] & 1))
        for agent in world.agents
    )
    return World(world.home, world.states, agents, world.moved)
