"""Nothing to eat on the plate."""

from __future__ import annotations

from hearth.repair.handlers.common import Edit, Trouble, before
from hearth.simulation.world.bits import indices


def nothing_to_eat(trouble: Trouble) -> Edit | None:
    """Fetch something eatable and put it on; the nearest, never out of something closed if it can be helped."""
    home = trouble.world.home
    food = trouble.nearest(indices(home.properties["EATABLE"] & home.able("Grab")))
    if food is None:
        return None
    plate, meal = trouble.refs((trouble.index(), food))
    steps = (("Walk", meal), ("Grab", meal), ("Walk", plate))
    fetched = [trouble.does(action, thing) for action, thing in steps]
    return before(trouble, "nothing_to_eat", *fetched, trouble.does("PutBack", meal, plate))
