"""Whether conditions hold in a world: what sampling promises, checked."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from hearth.grounding.conditions import CHARACTER, PETS, STATE_OF, Condition, Key, Preconditions
from hearth.schemas.vocabulary import STATE_ID
from hearth.simulation import rows
from hearth.simulation.bits import indices
from hearth.simulation.world import World

Nodes = Mapping[Key, int]
"""The program's objects as node ids."""

Test = Callable[[World, tuple[int, ...], Condition], bool]


def unmet(conditions: Preconditions, world: World, nodes: Nodes) -> tuple[Condition, ...]:
    """The conditions that do not hold; one about an object that is bound to nothing does not."""
    return tuple(condition for condition in conditions if not holds(condition, world, nodes))


def holds(condition: Condition, world: World, nodes: Nodes) -> bool:
    """Whether one condition holds."""
    home = world.home
    agent = world.agents[0]
    index = [agent.index if key == CHARACTER else home.index.get(nodes.get(key, -1), -1) for key in condition.objects]
    return -1 not in index and HOLDS[condition.name](world, tuple(index), condition)


def _state(world: World, index: tuple[int, ...], condition: Condition) -> bool:
    return bool(world.states[STATE_ID[STATE_OF[condition.name]]] >> index[0] & 1)


def _on(world: World, index: tuple[int, ...], _: Condition) -> bool:
    return bool((rows.bearing(world, index[1]) | _worn(world, index[1])) >> index[0] & 1)


def _worn(world: World, i: int) -> int:
    return next((agent.worn for agent in world.agents if agent.index == i), 0)


def _inside(world: World, index: tuple[int, ...], _: Condition) -> bool:
    return bool(rows.inside(world, index[0]) >> index[1] & 1)


def _in_room(world: World, index: tuple[int, ...], _: Condition) -> bool:
    return rows.room_of(world, index[0]) == index[1]


def _together(world: World, index: tuple[int, ...], _: Condition) -> bool:
    return rows.room_of(world, index[0]) == rows.room_of(world, index[1])


def _close(world: World, index: tuple[int, ...], _: Condition) -> bool:
    agent = world.agents[0]
    if agent.index in index:
        return bool(agent.close >> (index[0] if index[1] == agent.index else index[1]) & 1)
    return bool(rows.close(world, index[0]) >> index[1] & 1)


def _facing(world: World, index: tuple[int, ...], _: Condition) -> bool:
    return bool(rows.facing(world, index[0]) >> index[1] & 1)


def _held(world: World, index: tuple[int, ...], _: Condition) -> bool:
    return bool(world.agents[0].held >> index[0] & 1)


def _resting(world: World, index: tuple[int, ...], condition: Condition) -> bool:
    return bool(world.states[STATE_ID[condition.name.upper()]] >> index[0] & 1)


def _is_free(world: World, i: int) -> bool:
    home = world.home
    limit = max(home.limit(i), home.limit(i, lying=True))
    return rows.bearing(world, i).bit_count() < limit


def _free(world: World, index: tuple[int, ...], _: Condition) -> bool:
    return _is_free(world, index[0])


def _occupied(world: World, index: tuple[int, ...], _: Condition) -> bool:
    return not _is_free(world, index[0])


def _apart(world: World, index: tuple[int, ...], _: Condition) -> bool:
    """Whether who has walked to the second object is not close to the first."""
    there = world.home.reach[index[1]] & ~world.home.properties["BODY_PART"]
    return not (1 << index[0] | rows.close(world, index[0]) | rows.on(world, index[0])) & there


def _elsewhere(world: World, index: tuple[int, ...], _: Condition) -> bool:
    return rows.room_of(world, index[0]) != index[1]


def _stowed(world: World, index: tuple[int, ...], _: Condition) -> bool:
    return rows.closed_container(world, index[0]) >= 0


def _averted(world: World, index: tuple[int, ...], condition: Condition) -> bool:
    return not _facing(world, index, condition)


def _full_hands(world: World, index: tuple[int, ...], _: Condition) -> bool:
    return bool(world.agents[0].right and world.agents[0].left)


def _shut_in(world: World, index: tuple[int, ...], _: Condition) -> bool:
    """Whether a way into its room leads through a closed door."""
    room = rows.room_of(world, index[0])
    closed = world.home.doors & world.states[STATE_ID["CLOSED"]]
    return any(world.home.between[door] >> room & 1 for door in indices(closed))


def _pet(world: World, index: tuple[int, ...], _: Condition) -> bool:
    pets = (world.home.by_class.get(name, 0) for name in PETS)
    return any(mask & rows.bearing(world, index[0]) for mask in pets)


HOLDS: dict[str, Test] = {
    **dict.fromkeys(STATE_OF, _state),
    "in": _on,
    "inside": _inside,
    "location": _in_room,
    "together": _together,
    "atreach": _close,
    "nearby": _close,
    "facing": _facing,
    "holds": _held,
    "sitting": _resting,
    "lying": _resting,
    "free": _free,
    "occupied": _occupied,
    "apart": _apart,
    "elsewhere": _elsewhere,
    "stowed": _stowed,
    "averted": _averted,
    "full_hands": _full_hands,
    "shut_in": _shut_in,
    "pet": _pet,
}
