"""Not close, not in the room, a closed door on the way: the character goes where it has to be."""

from hearth.repair.handlers.common import Edit, RepairContext, Splice, around, before
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.world import rows


def not_close(context: RepairContext) -> Edit | None:
    """Walk to what is not close."""
    return walked_to(context, "not_close", context.object())


def not_in_room(context: RepairContext) -> Edit | None:
    """Walk to what is to be watched and is in another room."""
    return walked_to(context, "not_in_room", context.object())


def door_closed(context: RepairContext) -> Edit | None:
    """Walk to the closed door that is on the way, and open it."""
    door = context.object()
    opened = context.does("Open", door)
    if context.is_close(context.index()):
        return before(context, "door_closed", opened)
    return before(context, "door_closed", context.does("Walk", door), opened)


def walked_to(context: RepairContext, name: str, target: ObjectRef, *there: Step) -> Edit:
    """Walk to something first, and do more there.

    Who sits or lies gets up for it. If the program had the character take that seat, it returns to it when what has to
    be done beside the target is done; where the seat is too small to be taken twice (who has sat on it stays ON it, as
    in the release), it is only taken then.
    """
    walk = context.does("Walk", target)
    if not context.resting:
        return before(context, name, walk, *there)
    going = (context.does("StandUp"), walk, *there)
    seat = context.seat_taken()
    last = _end_of_errand(context, target)
    if seat is None or context.step.action in _posture(context) or _leaves_anyway(context, last):
        return before(context, name, *going)
    number, action, place = seat
    back = context.does("Walk", place)
    index = context.world.home.index[place.node] if place.node is not None else -1
    if rows.bearing(context.world, index).bit_count() < context.world.home.limit(index, action == "Lie"):
        return around(context, name, going, last, (back, context.does(action, place)))
    later = around(context, name, (walk, *there), last, (back, context.program.steps[number]))
    return Edit(name, (Splice(number, 1), *later.splices))


def _end_of_errand(context: RepairContext, target: ObjectRef) -> int:
    """Number of the last step that is done beside the target: the failing one, and those after it that need to be."""
    last = context.at
    for number in range(context.at + 1, len(context.program.steps)):
        step = context.program.steps[number]
        if step.agent != context.failure.agent:
            continue
        if step.action in _posture(context) or target not in step.objects or not _needs_to_be_close(context, step):
            break
        last = number
    return last


def _posture(context: RepairContext) -> frozenset[str]:
    """Actions that leave a seat or a place, or take a seat."""
    return context.group("rests") | context.group("rises") | context.group("walks")


def _needs_to_be_close(context: RepairContext, step: Step) -> bool:
    action = context.knowledge.actions.get(step.action)
    return action is not None and any(check.code is Code.NOT_CLOSE for check in action.preconditions)


def _leaves_anyway(context: RepairContext, last: int) -> bool:
    """Whether the character's next step gets up or walks away."""
    later = (s for s in context.program.steps[last + 1 :] if s.agent == context.failure.agent)
    following = next(later, None)
    return following is not None and following.action in _posture(context)
