"""Sitting, lying, standing, and no room on the seat."""

from __future__ import annotations

from collections.abc import Iterator

from hearth.repair.handlers.common import Edit, Splice, Trouble, before, removed
from hearth.simulation.holds import PETS
from hearth.simulation.world import rows
from hearth.simulation.world.bits import indices


def sitting(trouble: Trouble) -> Edit | None:
    """Leave out sitting down where one sits; stand up for everything else."""
    return _resting(trouble, "Sit", "sitting")


def lying(trouble: Trouble) -> Edit | None:
    """Leave out lying down where one lies; stand up for everything else."""
    return _resting(trouble, "Lie", "lying")


def not_resting(trouble: Trouble) -> Edit | None:
    """Leave out standing up when one stands; lie or sit down before sleeping or waking up."""
    if trouble.step.action == "StandUp":
        return removed(trouble, "not_sitting_to_stand")
    place = next(_places_to_rest(trouble), None)
    if place is None:
        return None
    action, index = place
    return before(trouble, "not_lying_to_sleep", trouble.does(action, trouble.ref(index)))


def occupied(trouble: Trouble) -> Edit | None:
    """Take things off the seat, one by one, until there is room: pets first, what the program names last."""
    home = trouble.world.home
    seat = trouble.index()
    there = [home.index[node] for node in trouble.failure.objects[1:]]
    too_many = len(there) - home.limit(seat, trouble.step.action == "Lie") + 1
    loose = [i for i in there if home.able("Grab") >> i & 1 and not home.characters >> i & 1]
    taken = trouble.seat_taken()
    if too_many > len(loose):
        mine = too_many == len(loose) + 1 and taken is not None and taken[2].node == trouble.failure.objects[0]
        return Edit("occupied_by_itself", (Splice(taken[0], 1),)) if mine and taken is not None else None
    named = {ref.node for ref in trouble.program.objects()}
    loose.sort(key=lambda i: (home.ids[i] in named, home.classes[i] not in PETS, i))
    steps = []
    for thing in trouble.refs(loose[:too_many]):
        steps += [trouble.does("Find", thing), trouble.does("Grab", thing), trouble.does("Release", thing)]
    return before(trouble, "occupied", *steps)


def _resting(trouble: Trouble, action: str, name: str) -> Edit:
    same = trouble.step.action == action and trouble.agent.on >> trouble.index() & 1
    if same:
        return removed(trouble, f"{name}_to_{action.lower()}")
    return before(trouble, f"{name}_to_walk", trouble.does("StandUp"))


def _places_to_rest(trouble: Trouble) -> Iterator[tuple[str, int]]:
    """Beds to lie on, then seats, with room on them: the program's own first, then the nearest."""
    home = trouble.world.home
    named = {ref.node for ref in trouble.program.objects()}
    for action in ("Lie", "Sit"):
        able = [i for i in indices(home.able(action)) if _has_room(trouble, i, action)]
        able = sorted(trouble.by_distance(able), key=lambda i: home.ids[i] not in named)
        yield from ((action, i) for i in able)


def _has_room(trouble: Trouble, i: int, action: str) -> bool:
    return rows.bearing(trouble.world, i).bit_count() < trouble.world.home.limit(i, action == "Lie")
