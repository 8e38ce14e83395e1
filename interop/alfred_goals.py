"""Goals of ALFRED's seven kinds of task, in the goal language."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.pipelines.readers.alfred_steps import UnreadableStepError, class_of
from hearth.schemas.failures import Code

DONE = {
    "pick_heat_then_place_in_recep": "HOT({})",
    "pick_cool_then_place_in_recep": "COLD({})",
    "pick_clean_then_place_in_recep": "[Wash]({})",
}
"""Treatment of the object of a kind of task: a state at the end, or an act, as things of ours begin clean."""


def alfred_goal(trajectory: Mapping[str, Any], knowledge: Knowledge) -> str:
    """Return the goal of a trajectory, as `read_goal` reads it.

    Raises:
        UnreadableStepError: its object or receptacle is of no class of ours.

    Examples:
        >>> from hearth.interop.alfred_goals import alfred_goal
        >>> wanted = {"object_target": "Egg", "parent_target": "SinkBasin", "mrecep_target": "Bowl"}
        >>> task = {"task_type": "pick_and_place_with_movable_recep", "pddl_params": wanted}
        >>> alfred_goal(task, known)
        '(ON(food_egg, bowl) or INSIDE(food_egg, bowl)) and (ON(bowl, sink) or INSIDE(bowl, sink))'
    """
    given, kind = trajectory.get("pddl_params", {}), str(trajectory.get("task_type", ""))
    thing = _class(given, "object_target", knowledge)
    if kind == "look_at_obj_in_light":
        parts = [f"HOLDS(agent, {thing})", f"ON({_class(given, 'toggle_target', knowledge)})"]
    elif given.get("mrecep_target"):
        carrier = _class(given, "mrecep_target", knowledge)
        parts = [_placed(thing, carrier), _placed(carrier, _class(given, "parent_target", knowledge))]
    else:
        count = 2 if kind == "pick_two_obj_and_place" else 1
        parts = [_placed(thing, _class(given, "parent_target", knowledge), count)]
    if kind in DONE:
        parts.append(DONE[kind].format(thing))
    if given.get("object_sliced"):
        parts.append(f"CUT({thing})")
    return " and ".join(parts)


def _placed(thing: str, holder: str, count: int = 1) -> str:
    more = f": {count}" if count > 1 else ""
    return f"(ON({thing}, {holder}){more} or INSIDE({thing}, {holder}){more})"


def _class(given: Mapping[str, Any], key: str, knowledge: Knowledge) -> str:
    name = str(given.get(key, ""))
    found = class_of(name, knowledge)
    if not found:
        raise UnreadableStepError(Code.UNKNOWN_OBJECT, f"no class of ours is a `{name[:40]}`")
    return found
