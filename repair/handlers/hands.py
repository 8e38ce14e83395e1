"""Full hands, empty hands, and things whose place nobody remembers."""

from __future__ import annotations

from hearth.repair.handlers.common import Edit, Trouble, around, before, removed, replaced
from hearth.schemas.literals import HOLDS
from hearth.schemas.program import ObjectRef
from hearth.simulation.world import rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.states import OPEN

_CLOTHS = ("rag", "towel", "sponge", "paper_towel", "cloth_napkin", "napkin", "dish_towel", "toilet_paper")
"""What one wipes with, best first."""


def no_free_hand(trouble: Trouble) -> Edit | None:
    """Put one thing down, and take it up again after: at once, or when the hand is free again that the step fills."""
    held = [trouble.world.home.index[node] for node in trouble.failure.objects[1:]]
    spare = [thing for thing in trouble.refs(held) if not _is_tool(trouble, thing)]
    if not spare:
        return None
    thing = max(spare, key=lambda one: _idleness(trouble, one))
    down, up = trouble.does("Release", thing), trouble.does("Grab", thing)
    after = _hand_is_free(trouble, thing)
    if after is None:
        return before(trouble, "no_free_hand", down)
    return around(trouble, "no_free_hand", (down,), after, (up,))


def not_holding(trouble: Trouble) -> Edit | None:
    """Find and take it first."""
    index = _wanted(trouble)
    if index is None or not trouble.world.home.able("Grab") >> index & 1:
        return None
    thing = trouble.ref(index)
    return before(trouble, "not_holding", trouble.does("Find", thing), trouble.does("Grab", thing))


def no_origin(trouble: Trouble) -> Edit | None:
    """Put it where such things belong, since it has not been taken from anywhere; leave it if it is not held."""
    if not trouble.agent.held >> trouble.index() & 1:
        return removed(trouble, "never_taken")
    place = _where_it_belongs(trouble)
    if place is None:
        return replaced(trouble, "no_origin", trouble.does("Release", trouble.object()))
    relation, index = place
    thing, support = trouble.refs((trouble.index(), index))
    return replaced(trouble, "no_origin", trouble.does("PutBack" if relation == "ON" else "PutIn", thing, support))


def _is_tool(trouble: Trouble, thing: ObjectRef) -> bool:
    """Whether the failing step is done with the thing: its own object, or the knife that cuts."""
    return thing in trouble.step.objects or (trouble.step.action == "Cut" and "knife" in thing.name)


def _idleness(trouble: Trouble, thing: ObjectRef) -> tuple[bool, int]:
    """How little a thing is missed: what the program is to end up holding most, then what it needs soonest."""
    return (not _is_wanted(trouble, thing), _needed_in(trouble, thing))


def _is_wanted(trouble: Trouble, thing: ObjectRef) -> bool:
    """Whether the program is to end up holding the thing."""
    return any(fact.name == HOLDS and fact.target == thing.key for fact in trouble.goal)


def _needed_in(trouble: Trouble, thing: ObjectRef) -> int:
    """In how many steps the program needs a thing; one more than it has left when never."""
    later = trouble.program.steps[trouble.at :]
    return next((number for number, step in enumerate(later) if thing in step.objects), len(later) + 1)


def _hand_is_free(trouble: Trouble, thing: ObjectRef) -> int | None:
    """Number of the step after which the thing can be taken up again; None when it can't.

    That is the failing step, unless it fills the hand; then the step that empties it if the thing is of use, else the
    last one if a hand is empty and the character on its feet by then.
    """
    if trouble.step.action != "Grab":
        return trouble.at
    needed = trouble.at + _needed_in(trouble, thing)
    steps = trouble.program.steps
    useful = needed <= len(steps) or _is_wanted(trouble, thing)
    last = len(steps) - 1
    filled, resting = 0, trouble.resting
    takes, frees = trouble.group("takes"), trouble.group("frees_hand")
    for number in range(trouble.at, len(steps)):
        step = steps[number]
        if step.agent != trouble.failure.agent:
            continue
        filled += (step.action in takes) - (step.action in frees)
        resting = step.action in trouble.group("rests") or (resting and step.action != "StandUp")
        if filled <= 0 and useful:
            return number if number < needed else None
    return last if filled <= 0 and not resting else None


def _wanted(trouble: Trouble) -> int | None:
    """Index of what the step has to hold: a knife to cut with, a cloth to wipe with, else its object."""
    if trouble.step.action == "Cut":
        home = trouble.world.home
        knives = (i for name, mask in home.by_class.items() if "knife" in name for i in indices(mask))
        return trouble.nearest(knives)
    if trouble.step.action == "Wipe":
        return _cloth(trouble)
    return trouble.index()


def _cloth(trouble: Trouble) -> int | None:
    home = trouble.world.home
    for name in _CLOTHS:
        found = trouble.nearest(indices(home.by_class.get(name, 0) & home.able("Grab")))
        if found is not None:
            return found
    things = home.able("Grab") & ~home.characters & ~(1 << trouble.index())
    return trouble.nearest(indices(things & ~home.by_class.get("cat", 0) & ~home.by_class.get("dog", 0)))


def _where_it_belongs(trouble: Trouble) -> tuple[str, int] | None:
    """(relation, index) of a place that the knowledge allows: close by if there is one, never one that is closed."""
    world, home = trouble.world, trouble.world.home
    room = rows.agent_room(world, trouble.agent)
    found: list[tuple[tuple[bool, bool, int, int], str, int]] = []
    for placement in trouble.knowledge.placements(home.classes[trouble.index()]):
        if placement.edge not in ("ON", "INSIDE"):
            continue
        for i in indices(home.by_class.get(placement.destination, 0)):
            if placement.edge == "ON" or not home.properties["CAN_OPEN"] >> i & 1 or world.states[OPEN] >> i & 1:
                rank = (not trouble.is_close(i), rows.room_of(world, i) != room, -placement.weight, i)
                found.append((rank, placement.edge, i))
    return min(found)[1:] if found else None
