"""States of action set 3: an empty thing is filled, a dirty one washed, a cold one heated; done steps are left out."""

from hearth.grounding.preconditions.usual_states import Restoring, UsualState, usual_states
from hearth.repair.handlers.common import Edit, RepairContext, before, removed
from hearth.schemas.literals import STATE_OF, STATE_OF_SET_3
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.vocabulary import EVERY_STATE_ID
from hearth.simulation.world.bits import indices
from hearth.simulation.world.state import WorldState

_STATES = STATE_OF | STATE_OF_SET_3


_WALKS = "Walk"
_TAKES = "Grab"


def wrong_state(context: RepairContext) -> Edit | None:
    """Bring the thing out of its state where the knowledge has a way; leave the step out where it is done already.

    Nothing helps where the state stops the act and the act does not make it: nobody drinks from a broken glass.
    """
    state = context.failure.actual
    for row in usual_states().values():
        if row.violated is not None and _STATES[row.violated[1]] == state and row.restored and context.failure.objects:
            steps = restoring(context, row, context.index())
            return before(context, f"not_{row.condition}", *steps)._replace(stays=operates(steps)) if steps else None
    known = context.knowledge.actions[context.step.action]
    makes = any(str(effect.literal).endswith(f", {state})") for effect in known.effects)
    return removed(context, "already_so") if makes or state not in EVERY_STATE_ID else None


def restoring(context: RepairContext, row: UsualState, index: int) -> tuple[Step, ...]:
    """Return the steps by which a condition of a thing is brought about; none where the home allows no way.

    Args:
        context: of the failure.
        row: of the condition.
        index: of the thing.
    """
    for way in row.restored:
        things = _things(context, way, index)
        if things is not None:
            steps = tuple(context.does(action, *(things[name] for name in names)) for action, names in way.steps)
            return steps[_left_out(context, steps, index) :]
    return ()


def operates(steps: tuple[Step, ...]) -> bool:
    """Return whether steps switch something on: then they all stay, so that it is switched off again."""
    return any(step.action == "SwitchOn" for step in steps)


def _left_out(context: RepairContext, steps: tuple[Step, ...], index: int) -> int:
    """Return how many steps at the beginning only take a thing up that is held."""
    if not context.agent.held >> index & 1:
        return 0
    return (
        2
        if tuple(step.action for step in steps[:2]) == (_WALKS, _TAKES) and steps[0].objects == steps[1].objects
        else 0
    )


def _things(context: RepairContext, way: Restoring, index: int) -> dict[str, ObjectRef] | None:
    """Return the thing and its helpers by their names in the steps; None where the home lacks a helper."""
    found = {"x": index}
    for name, classes in way.classes.items():
        near = found.get("d")
        number = _nearest(context, classes, index, way.belongs, near)
        if number is None:
            return None
        found[name] = number
    return dict(zip(found, context.refs(found.values()), strict=True))


def _nearest(
    context: RepairContext, classes: tuple[str, ...], index: int, belongs: bool, beside: int | None
) -> int | None:
    """Return the nearest thing of some classes, or that close to another; never a thing that is used up or broken."""
    world, home = context.world, context.world.home
    wanted = {home.classes[index], *context.knowledge.same_class(home.classes[index])}
    found = 0
    for name in classes:
        fits = not belongs or any(each.destination in wanted for each in context.knowledge.placements(name))
        found |= home.by_class.get(name, 0) if fits else 0
    found &= ~_useless(world) & ~(1 << index)
    if beside is not None:
        found &= home.close[beside]
    return context.nearest(indices(found))


def _useless(world: WorldState) -> int:
    """Return the things that are used up, broken or empty."""
    rows = (EVERY_STATE_ID[name] for name in ("GONE", "BROKEN", "EMPTY"))
    found = world.home.absent
    for number in rows:
        found |= world.states[number] if number < len(world.states) else 0
    return found
