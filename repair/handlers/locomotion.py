"""Not close, not in the room, a closed door on the way: the character goes where it has to be."""

from hearth.repair.handlers.common import Edit, RepairContext, before
from hearth.repair.handlers.seats import brought, done_before_seat, stays
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step


def not_close(context: RepairContext) -> Edit | None:
    """Walk to an object that is not close; nothing helps where the home lacks a tool."""
    if not context.failure.objects:
        return None
    return walked_to(context, "not_close", context.object())


def not_in_room(context: RepairContext) -> Edit | None:
    """Walk to the object to be watched, or to the tool, if it is in another room."""
    if not context.failure.objects:
        return None
    return walked_to(context, "not_in_room", context.object())


def door_closed(context: RepairContext) -> Edit | None:
    """Walk to the closed door that is on the way, and open it."""
    door = context.object()
    opened = context.does("Open", door)
    if context.is_close(context.index()):
        return before(context, "door_closed", opened)
    return before(context, "door_closed", context.does("Walk", door), opened)


def walked_to(context: RepairContext, name: str, target: ObjectRef, *there: Step) -> Edit | None:
    """Walk to something first, and do more there.

    A sitting or lying character gets up for it, unless the program goes on in that seat. Then a step that the original
    does there is done with objects that can be brought to the seat. Inserted steps, and steps with unknown
    circumstances, are done before the seat is taken.
    """
    walk = context.does("Walk", target)
    if not context.resting:
        return before(context, name, walk, *there)
    rests = context.rests_at(context.at)
    if rests and context.step.action not in context.posture:
        return brought(context, name)
    last = _end_of_errand(context, target)
    if rests is None and context.step.action not in context.posture and stays(context, last):
        edit = done_before_seat(context, name, last, walk, *there)
        if edit is not None:
            return edit
    return before(context, name, context.does("StandUp"), walk, *there)


def _end_of_errand(context: RepairContext, target: ObjectRef) -> int:
    """Return the number of the last step that is done next to the target.

    The failing one, and later ones that need to be.
    """
    last = context.at
    for number in range(context.at + 1, len(context.program.steps)):
        step = context.program.steps[number]
        if step.agent != context.failure.agent:
            continue
        mine = target in step.objects and context.is_inserted(number) == context.is_inserted(context.at)
        if step.action in context.posture or not mine or not _needs_to_be_close(context, step):
            break
        last = number
    return last


def _needs_to_be_close(context: RepairContext, step: Step) -> bool:
    action = context.knowledge.actions.get(step.action)
    return action is not None and any(check.code is Code.NOT_CLOSE for check in action.preconditions)
