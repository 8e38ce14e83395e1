"""Nodes with the states of a moment."""

from collections.abc import Sequence
from dataclasses import replace

from hearth.schemas.graph import Node
from hearth.schemas.vocabulary import EVERY_STATE, EVERY_STATE_ID, STATE_ID, STATES


def states_of(index: int, states: Sequence[int]) -> tuple[str, ...]:
    """Names of the simulated states of a node, in the vocabulary's order; rows of more than states come after them."""
    return tuple(name for name, mask in zip(EVERY_STATE, states, strict=False) if mask >> index & 1)


def with_states(node: Node, index: int, states: Sequence[int]) -> Node:
    """Return the node as it is now; states that are not simulated stay as they were."""
    now = states_of(index, states)
    known = STATE_ID if len(states) == len(STATES) else EVERY_STATE_ID
    kept = tuple(name for name in node.states if name in now or name not in known)
    new = kept + tuple(name for name in now if name not in kept)
    return node if new == node.states else replace(node, states=new)
