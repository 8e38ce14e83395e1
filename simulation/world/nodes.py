"""Nodes with the states of a moment."""

from collections.abc import Sequence
from dataclasses import replace

from hearth.schemas.graph import Node
from hearth.schemas.vocabulary import STATE_ID, STATES


def states_of(index: int, states: Sequence[int]) -> tuple[str, ...]:
    """Names of the simulated states of a node, in the vocabulary's order."""
    return tuple(name for name, mask in zip(STATES, states, strict=True) if mask >> index & 1)


def with_states(node: Node, index: int, states: Sequence[int]) -> Node:
    """The node as it is now; states that are not simulated stay as they were."""
    now = states_of(index, states)
    kept = tuple(name for name in node.states if name in now or name not in STATE_ID)
    new = kept + tuple(name for name in now if name not in kept)
    return node if new == node.states else replace(node, states=new)
