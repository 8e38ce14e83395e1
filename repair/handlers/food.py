"""Nothing to eat on the plate."""

from __future__ import annotations

from hearth.repair.handlers.common import Edit, Trouble, before
from hearth.simulation.world import rows
from hearth.simulation.world.bits import indices


def nothing_to_eat(trouble: Trouble) -> Edit | None:
    """Fetch something eatable and put it on; the nearest, never out of something closed if it can be helped."""
    world, home = trouble.world, trouble.world.home
    food = home.properties["EATABLE"] & home.able("Grab")
    room = rows.agent_room(world, trouble.agent)
    key = {
        i: (rows.closed_container(world, i) >= 0, not trouble.is_close(i), rows.room_of(world, i) != room, i)
        for i in indices(food)
    }
    if not key:
        return None
    plate, meal = trouble.refs((trouble.index(), min(key, key=lambda i: key[i])))
    steps = (("Walk", meal), ("Grab", meal), ("Walk", plate))
    fetched = [trouble.does(action, thing) for action, thing in steps]
    return before(trouble, "nothing_to_eat", *fetched, trouble.does("PutBack", meal, plate))
