"""Full hands, empty hands, and things without a remembered origin."""

from hearth.repair.handlers.common import Edit, RepairContext, around, before, removed, replaced
from hearth.schemas.literals import HOLDS
from hearth.schemas.program import ObjectRef
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.states import OPEN

_CLOTHS = ("rag", "towel", "sponge", "paper_towel", "cloth_napkin", "napkin", "dish_towel", "toilet_paper")
"""Tools for wiping, best first."""


def no_free_hand(context: RepairContext) -> Edit | None:
    """Put one thing down, and take it up again after: at once, or when the hand is free again that the step fills."""
    held = [context.world.home.index[node] for node in context.failure.objects[1:]]
    spare = [thing for thing in context.refs(held) if not _is_tool(context, thing)]
    if not spare:
        return None
    thing = max(spare, key=lambda one: _priority(context, one))
    down, up = context.does("Release", thing), context.does("Grab", thing)
    after = _hand_is_free(context, thing)
    if after is None:
        return before(context, "no_free_hand", down)
    return around(context, "no_free_hand", (down,), after, (up,))


def not_holding(context: RepairContext) -> Edit | None:
    """Find and take it first."""
    index = _wanted(context) if context.failure.objects else None
    if index is None or not context.world.home.able("Grab") >> index & 1:
        return None
    thing = context.ref(index)
    return before(context, "not_holding", context.does("Find", thing), context.does("Grab", thing))


def no_origin(context: RepairContext) -> Edit | None:
    """Put it where such things belong, since it has not been taken from anywhere; leave it if it is not held."""
    if not context.agent.held >> context.index() & 1:
        return removed(context, "never_taken")
    place = _where_it_belongs(context)
    if place is None:
        return replaced(context, "no_origin", context.does("Release", context.object()))
    relation, index = place
    thing, support = context.refs((context.index(), index))
    return replaced(context, "no_origin", context.does("PutBack" if relation == "ON" else "PutIn", thing, support))


def _is_tool(context: RepairContext, thing: ObjectRef) -> bool:
    """Return whether the failing step is done with the thing: its own object, or the knife that cuts."""
    return thing in context.step.objects or (context.step.action == "Cut" and "knife" in thing.name)


def _priority(context: RepairContext, thing: ObjectRef) -> tuple[bool, int]:
    """Return how little a thing is missed: what the program is to end up holding most, then what it needs soonest."""
    return (not _is_wanted(context, thing), _needed_in(context, thing))


def _is_wanted(context: RepairContext, thing: ObjectRef) -> bool:
    """Return whether the program is to end up holding the thing."""
    return any(fact.name == HOLDS and fact.target == thing.key for fact in context.goal)


def _needed_in(context: RepairContext, thing: ObjectRef) -> int:
    """In how many steps the program needs a thing; one more than it has left when never."""
    later = context.program.steps[context.at :]
    return next((number for number, step in enumerate(later) if thing in step.objects), len(later) + 1)


def _hand_is_free(context: RepairContext, thing: ObjectRef) -> int | None:
    """Return the number of the step after which the thing can be taken up again; None when it can't.

    That is the failing step, unless it fills the hand; then the step that empties it if the thing is of use, else the
    last one if a hand is empty and the character on its feet by then.
    """
    if context.step.action != "Grab":
        return context.at
    needed = context.at + _needed_in(context, thing)
    steps = context.program.steps
    useful = needed <= len(steps) or _is_wanted(context, thing)
    last = len(steps) - 1
    filled, resting = 0, context.resting
    takes, frees = context.group("takes"), context.group("frees_hand")
    for number in range(context.at, len(steps)):
        step = steps[number]
        if step.agent != context.failure.agent:
            continue
        filled += (step.action in takes) - (step.action in frees)
        resting = step.action in context.group("rests") or (resting and step.action != "StandUp")
        if filled <= 0 and useful:
            return number if number < needed else None
    return last if filled <= 0 and not resting else None


def _wanted(context: RepairContext) -> int | None:
    """Return the index of the object that the step has to hold.

    A knife to cut with, a cloth to wipe with, else its object.
    """
    if context.step.action == "Cut":
        home = context.world.home
        knives = (i for name, mask in home.by_class.items() if "knife" in name for i in indices(mask))
        return context.nearest(knives)
    if context.step.action == "Wipe":
        return _cloth(context)
    return context.index()


def _cloth(context: RepairContext) -> int | None:
    home = context.world.home
    for name in _CLOTHS:
        found = context.nearest(indices(home.by_class.get(name, 0) & home.able("Grab")))
        if found is not None:
            return found
    things = home.able("Grab") & ~home.characters & ~(1 << context.index())
    return context.nearest(indices(things & ~home.by_class.get("cat", 0) & ~home.by_class.get("dog", 0)))


def _where_it_belongs(context: RepairContext) -> tuple[str, int] | None:
    """(relation, index) of a place that the knowledge allows: close by if there is one, never one that is closed."""
    world, home = context.world, context.world.home
    room = edge_rows.agent_room(world, context.agent)
    found: list[tuple[tuple[bool, bool, int, int], str, int]] = []
    for placement in context.knowledge.placements(home.classes[context.index()]):
        if placement.edge not in ("ON", "INSIDE"):
            continue
        for i in indices(home.by_class.get(placement.destination, 0)):
            if placement.edge == "ON" or not home.properties["CAN_OPEN"] >> i & 1 or world.states[OPEN] >> i & 1:
                rank = (not context.is_close(i), edge_rows.room_of(world, i) != room, -placement.weight, i)
                found.append((rank, placement.edge, i))
    return min(found)[1:] if found else None
