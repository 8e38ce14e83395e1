"""Whether conditions hold in a world: what sampling promises, checked."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from hearth.grounding.conditions import CHARACTER, STATE_OF, Condition, Key, Preconditions
from hearth.schemas.vocabulary import STATE_ID
from hearth.simulation import rows
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
}
