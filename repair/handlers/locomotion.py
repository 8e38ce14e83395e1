"""Not close, not in the room, a closed door on the way: the character goes where it has to be."""

from __future__ import annotations

from hearth.repair.handlers.common import Edit, Splice, Trouble, around, before
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.world import rows


def not_close(trouble: Trouble) -> Edit | None:
    """Walk to what is not close."""
    return gone_to(trouble, "not_close", trouble.object())


def not_in_room(trouble: Trouble) -> Edit | None:
    """Walk to what is to be watched and is in another room."""
    return gone_to(trouble, "not_in_room", trouble.object())


def door_closed(trouble: Trouble) -> Edit | None:
    """Walk to the closed door that is on the way, and open it."""
    door = trouble.object()
    opened = trouble.does("Open", door)
    if trouble.is_close(trouble.index()):
        return before(trouble, "door_closed", opened)
    return before(trouble, "door_closed", trouble.does("Walk", door), opened)


def gone_to(trouble: Trouble, name: str, target: ObjectRef, *there: Step) -> Edit:
    """Walk to something first, and do more there.

    Who sits or lies gets up for it. If the program had the character take that seat, it returns to it when what has to
    be done beside the target is done; where the seat is too small to be taken twice (who has sat on it stays ON it, as
    in the release), it is only taken then.
    """
    walk = trouble.does("Walk", target)
    if not trouble.resting:
        return before(trouble, name, walk, *there)
    going = (trouble.does("StandUp"), walk, *there)
    seat = trouble.seat_taken()
    last = _end_of_errand(trouble, target)
    if seat is None or trouble.step.action in _posture(trouble) or _leaves_anyway(trouble, last):
        return before(trouble, name, *going)
    number, action, place = seat
    back = trouble.does("Walk", place)
    index = trouble.world.home.index[place.node] if place.node is not None else -1
    if rows.bearing(trouble.world, index).bit_count() < trouble.world.home.limit(index, action == "Lie"):
        return around(trouble, name, going, last, (back, trouble.does(action, place)))
    later = around(trouble, name, (walk, *there), last, (back, trouble.program.steps[number]))
    return Edit(name, (Splice(number, 1), *later.splices))


def _end_of_errand(trouble: Trouble, target: ObjectRef) -> int:
    """Number of the last step that is done beside the target: the failing one, and those after it that need to be."""
    last = trouble.at
    for number in range(trouble.at + 1, len(trouble.program.steps)):
        step = trouble.program.steps[number]
        if step.agent != trouble.failure.agent:
            continue
        if step.action in _posture(trouble) or target not in step.objects or not _needs_to_be_close(trouble, step):
            break
        last = number
    return last


def _posture(trouble: Trouble) -> frozenset[str]:
    """Actions that leave a seat or a place, or take a seat."""
    return trouble.group("rests") | trouble.group("rises") | trouble.group("walks")


def _needs_to_be_close(trouble: Trouble, step: Step) -> bool:
    action = trouble.knowledge.actions.get(step.action)
    return action is not None and any(check.code is Code.NOT_CLOSE for check in action.preconditions)


def _leaves_anyway(trouble: Trouble, last: int) -> bool:
    """Whether the character's next step gets up or walks away."""
    later = (s for s in trouble.program.steps[last + 1 :] if s.agent == trouble.failure.agent)
    following = next(later, None)
    return following is not None and following.action in _posture(trouble)
