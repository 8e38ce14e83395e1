"""Sitting, lying, standing, and no room on the seat."""

from collections.abc import Iterator

from hearth.repair.handlers.common import Edit, Handler, RepairContext, Splice, before, removed
from hearth.repair.handlers.seats import done_before_seat, stays
from hearth.simulation.literal_truth import PETS
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices


def sitting(context: RepairContext) -> Edit | None:
    """Leave out sitting down where one sits; stand up for everything else."""
    return _resting(context, "Sit", "sitting")


def lying(context: RepairContext) -> Edit | None:
    """Leave out lying down where one lies; stand up for everything else."""
    return _resting(context, "Lie", "lying")


def not_resting(context: RepairContext) -> Edit | None:
    """Leave out standing up when one stands; lie or sit down before sleeping or waking up."""
    if context.step.action == "StandUp":
        return removed(context, "not_sitting_to_stand")
    place = next(places_to_rest(context), None)
    if place is None:
        return None
    action, index = place
    return before(context, "not_lying_to_sleep", context.does(action, context.ref(index)))


def occupied(context: RepairContext, everything: bool = False) -> Edit | None:
    """Take things off the seat, one by one, until there is room: pets first, what the program names last."""
    home = context.world.home
    if context.step.action not in context.knowledge.group("rests"):
        return None  # somebody else rests on the thing to be taken
    seat = context.index()
    there = [home.index[node] for node in context.failure.objects[1:]]
    too_many = len(there) - home.limit(seat, context.step.action == "Lie") + 1
    movable = [i for i in there if home.able("Grab") >> i & 1 and not home.characters >> i & 1]
    taken = context.seat_taken()
    if too_many > len(movable):
        mine = too_many == len(movable) + 1 and taken is not None and taken[2].node == context.failure.objects[0]
        return Edit("occupied_by_itself", (Splice(taken[0], 1),)) if mine and taken is not None else None
    named = {ref.node for ref in context.program.objects()}
    movable.sort(key=lambda i: (home.ids[i] in named, home.classes[i] not in PETS, i))
    unnamed = sum(home.ids[i] not in named for i in movable)
    steps = []
    for thing in context.refs(movable[: max(too_many, unnamed * everything)]):
        steps += [context.does("Find", thing), context.does("Grab", thing), context.does("Release", thing)]
    return before(context, "occupied", *steps)._replace(stays=everything)


def cleared(context: RepairContext) -> Edit | None:
    """Take everything off the seat that the program does not name, needed or not (thesis, table A.4, figure 5-6)."""
    return occupied(context, everything=True)


CLEARS: dict[str, Handler] = {"enough": occupied, "all": cleared}
"""The repair of a seat without room, by how much it takes off."""


def _resting(context: RepairContext, action: str, name: str) -> Edit | None:
    same = context.step.action == action and context.agent.on >> context.index() & 1
    if same:
        return removed(context, f"{name}_to_{action.lower()}")
    last = context.at
    while last + 1 < len(context.program.steps) and context.is_inserted(last + 1):
        last += 1
    if context.is_inserted(context.at) and stays(context, last):
        return done_before_seat(context, f"{name}_to_walk", last)
    return before(context, f"{name}_to_walk", context.does("StandUp"))


def places_to_rest(context: RepairContext) -> Iterator[tuple[str, int]]:
    """Beds to lie on, then seats, with room on them: the program's own first, then the nearest."""
    home = context.world.home
    named = {ref.node for ref in context.program.objects()}
    for action in sorted(context.knowledge.group("rests")):
        able = [i for i in indices(home.able(action)) if _has_room(context, i, action)]
        able = sorted(context.by_distance(able), key=lambda i: home.ids[i] not in named)
        yield from ((action, i) for i in able)


def _has_room(context: RepairContext, i: int, action: str) -> bool:
    taken = edge_rows.taking_room(context.world, i, context.rules.made_bed)
    return taken.bit_count() < context.world.home.limit(i, action == "Lie")
