"""Tests whether things fit into their places, by the knowledge: placements, seat limits, possible states."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hearth.kb.action_sets import LATEST
from hearth.schemas.failures import Code, Failure
from hearth.schemas.vocabulary import EVERY_STATE_ID, STATE_ID
from hearth.simulation.actions.common import refuse
from hearth.simulation.world import edge_rows

if TYPE_CHECKING:
    from hearth.simulation.world.home import Home
    from hearth.simulation.world.world import World

_USES = {"ON": ("SURFACES", "SITTABLE", "LIEABLE"), "INSIDE": ("CONTAINERS", "CAN_OPEN", "RECIPIENT")}
"""Properties of places for things of which the knowledge names no place."""


def unfit(world: World, i: int, relation: str, j: int) -> Failure | None:
    """Return why node i can't be put ON or INSIDE node j, or None when it can.

    Rooms take everything INSIDE. A character may be ON things that it can sit or lie on. Other things go where the
    placements say, or, when there are none for them, ON things with a surface and INSIDE containers.

    Returns:
        NO_PLACE; or OCCUPIED, when a seat or bed already bears as much as its limit.
    """
    home = world.home
    if home.rooms >> j & 1:
        if relation == "INSIDE":
            return None
    elif _belongs(home, i, relation, j):
        return _full(world, i, j) if relation == "ON" else None
    return refuse(world, Code.NO_PLACE, f"a thing that belongs {relation} it", "another", i, j)


def impossible(home: Home, i: int, state: str) -> Failure | None:
    """Return why node i can't be in a state, or None when it can.

    Characters sit and lie, things what the knowledge says.
    """
    name = home.classes[i]
    thing = home.knowledge.object_class(name)
    posture = state in ("SITTING", "LYING")
    simulated = EVERY_STATE_ID if home.knowledge.action_set == LATEST else STATE_ID
    if state in simulated and (posture == bool(home.characters >> i & 1)):
        if posture or thing is None or state in thing.states:
            return None
        group = home.knowledge.state_groups[home.knowledge.group_of(state)]
        if any(home.properties.get(prop, 0) >> i & 1 for prop in group.given_by | group.needs):
            return None
        if state not in STATE_ID and not group.needs:  # acts and processes bring any thing into it
            return None
    expected = f"a thing that can be {state}"
    return Failure(Code.NOT_AFFORDED, objects=(home.ids[i],), names=(name,), expected=expected, actual="none")


def _belongs(home: Home, i: int, relation: str, j: int) -> bool:
    if home.characters >> j & 1:
        return False
    if home.characters >> i & 1:
        return bool((home.properties["SITTABLE"] | home.properties["LIEABLE"]) >> j & 1)
    placements = home.knowledge.placements(home.classes[i])
    if not placements:
        return any(home.properties[prop] >> j & 1 for prop in _USES[relation])
    place = home.classes[j]
    return any(p.edge == relation and place in home.knowledge.same_class(p.destination) for p in placements)


def _full(world: World, i: int, j: int) -> Failure | None:
    home = world.home
    properties = home.properties
    if not (properties["SITTABLE"] | properties["LIEABLE"]) >> j & 1:
        return None
    limit = max(home.limit(j), home.limit(j, lying=True))
    taken = (edge_rows.bearing(world, j) & ~(1 << i)).bit_count()
    if taken < limit:
        return None
    return refuse(world, Code.OCCUPIED, f"fewer than {limit} on it", str(taken), j, i)
