"""Nothing to eat on the plate."""

from hearth.repair.handlers.common import Edit, RepairContext, before
from hearth.simulation.world.bits import indices


def nothing_to_eat(context: RepairContext) -> Edit | None:
    """Fetch something eatable and put it on; the nearest, never out of something closed if it can be helped."""
    home = context.world.home
    food = context.nearest(indices(home.properties["EATABLE"] & home.able("Grab")))
    if food is None:
        return None
    plate, meal = context.refs((context.index(), food))
    steps = (("Walk", meal), ("Grab", meal), ("Walk", plate))
    fetched = [context.does(action, thing) for action, thing in steps]
    return before(context, "nothing_to_eat", *fetched, context.does("PutBack", meal, plate))
