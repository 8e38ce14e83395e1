"""Random common-sense objects, so that no two environments are the same (KB-RealEnv, thesis 5.5.2)."""

from bisect import bisect_right

from hearth.grounding.environments.environment_draft import PartialEnvironment
from hearth.schemas.graph import Node
from hearth.schemas.vocabulary import FIRST_FILLED_ID, OPPOSITE
from hearth.simulation.world.edit import Movable

TURNED = 0.25
"""Probability that a pair of states of a thing is swapped."""


def fill(partial: PartialEnvironment, least: int, most: int, some: int) -> None:
    """Add random movable things where they belong.

    Args:
        partial: to add to; nothing else may be added after.
        least, most: nodes the environment should have; the number is drawn from between.
        some: things added to a home that has as many already.
    """
    base = partial.base
    choices, weights, _ = base.fillers
    if not weights:
        return
    random = partial.rng.random
    present = len(base.home) + len(partial.nodes)
    wanted = max(partial.rng.randint(least, most) - present, partial.rng.randint(1, some) if some else 0)
    total = weights[-1]
    home = base.home
    ids, rooms, bears, contents, kinds = home.ids, base.room, home.bears, home.contents, base.kind
    taken, seats = partial.taken, base.seats
    node_id = max(FIRST_FILLED_ID, partial.first_id) + len(partial.nodes)
    for _ in range(wanted):
        name, i, relation = choices[bisect_right(weights, random() * total)]
        if ids[i] in taken or (seats >> i & 1 and _is_full(partial, i, ids[i])):
            continue
        category, properties, states = kinds(name)
        for state in states:
            if random() < TURNED and state in OPPOSITE:
                states = _turned(states, state)
        near = 1 << i | (bears[i] if relation == "ON" else contents[i])
        partial.movable.append(Movable(Node(node_id, name, category, properties, states), relation, i, rooms[i], near))
        node_id += 1
        if seats >> i & 1:
            partial.load[ids[i]] = partial.load.get(ids[i], 0) + 1


def _turned(states: tuple[str, ...], state: str) -> tuple[str, ...]:
    """In the opposite of one of the states."""
    other = OPPOSITE[state]
    return (*(name for name in states if name not in (state, other)), other)


def _is_full(partial: PartialEnvironment, i: int, place: int) -> bool:
    """Return whether a seat or bed has but one place left, which is for the person to sit there."""
    return partial.crowd(place) + 1 >= partial.base.home.limit(i)
