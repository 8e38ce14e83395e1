"""What the ends of two runs in one environment share, counted on their rows: no edge is ever written out."""

from __future__ import annotations

from collections.abc import Iterator, Set

from hearth.schemas.vocabulary import STATE_ID
from hearth.scoring.counts import Match, Matches
from hearth.simulation import rows
from hearth.simulation.agent import Agent
from hearth.simulation.bits import indices, mask_of
from hearth.simulation.home import Home
from hearth.simulation.world import World

_OUT = (rows.on, rows.inside, rows.close, rows.facing)
_INTO = (rows.bears, rows.contents, rows.close, rows.faced)

Rows = Iterator[tuple[int, int]]
"""The same row of a prediction and of its reference, cut to what is asked about."""


def comparable(predicted: World, reference: World) -> bool:
    """Whether rows say all there is: one home, one character, and no edges of other relations."""
    home = predicted.home
    return reference.home is home and len(predicted.agents) == len(reference.agents) == 1 and not home.others


def matches(predicted: World, reference: World, about: Set[int]) -> Matches:
    """The state and relation tuples about some things and the character, by id: in both graphs, and in each.

    Args:
        predicted, reference: worlds that are `comparable`.
        about: node ids; characters, rooms and doors are none of them.
    """
    home = predicted.home
    things = mask_of(home.index[node] for node in about)
    told = things | home.characters
    states = _count((a & told, b & told) for a, b in zip(predicted.states, reference.states, strict=True))
    still = sum(_still_states(home, i) for i in indices(told))
    relations = _count(_rows(predicted, reference, things))
    return Matches(states + Match(still, still, still), relations)


def _rows(predicted: World, reference: World, things: int) -> Rows:
    """Every edge with an end in the things or the character, once."""
    home = predicted.home
    for i in indices(things):
        for read in _OUT:
            yield read(predicted, i), read(reference, i)
        # An edge from another of the things has been told as going out from there.
        for read in _INTO:
            yield read(predicted, i) & ~things, read(reference, i) & ~things
        yield home.between[i], home.between[i]
    yield from zip(_agent_rows(predicted.agents[0]), _agent_rows(reference.agents[0]), strict=True)


def _agent_rows(agent: Agent) -> Iterator[int]:
    out = (agent.on, agent.inside, agent.close, agent.facing)
    into = (agent.worn, agent.contents, agent.close, agent.faced)
    yield from (*out, agent.right, agent.left)
    # An edge from the character to itself may stand in both rows, and is one.
    yield from (row & ~agent.bit | row & agent.bit & ~past for row, past in zip(into, out, strict=True))


def _count(pairs: Rows) -> Match:
    both = ours = theirs = 0
    for a, b in pairs:
        both += (a & b).bit_count()
        ours += a.bit_count()
        theirs += b.bit_count()
    return Match(both, ours, theirs)


def _still_states(home: Home, i: int) -> int:
    """How many states a node has that are not simulated."""
    return len({name for name in home.node(i).states if name not in STATE_ID})
