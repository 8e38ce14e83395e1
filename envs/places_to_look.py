"""Places where a thing that an agent does not see may be: closed things that it sees, and other rooms."""

from __future__ import annotations

from hearth.simulation.observation.views import View
from hearth.simulation.world.bits import indices
from hearth.simulation.world.states import CLOSED

MOST_CLOSED = 3
"""Closed things that a remedy names."""

MOST_ROOMS = 2
"""Other rooms that a remedy names."""


def places_to_look(name: str, view: View) -> str:
    """Return places that may have a thing, by the agent's own sight: `you see none; open fridge 137, ...`.

    Furniture is in no closed thing, so for it only other rooms are named.
    """
    home, known = view.world.home, view.world.home.knowledge
    kind = known.object_class(name)
    closed = home.properties["CAN_OPEN"] & home.properties["CONTAINERS"] & ~home.doors & view.mask
    closed &= view.world.states[CLOSED]
    portable = kind is not None and "GRABBABLE" in kind.properties
    likely = [*indices(closed & home.furniture), *indices(closed & ~home.furniture)][:MOST_CLOSED] if portable else []
    inside = [f"{home.classes[i]} {home.ids[i]}" for i in likely]
    rooms = [f"{home.classes[i]} {home.ids[i]}" for i in indices(home.rooms) if home.ids[i] != view.me.room][
        :MOST_ROOMS
    ]
    ways = [*([f"open {' or '.join(inside)}"] if inside else []), *([f"look in {' or '.join(rooms)}"] if rooms else [])]
    return f"you see none; {', or '.join(ways)}" if ways else "you see none"
