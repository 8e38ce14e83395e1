"""Defaults: soft conditions that the author of a program assumes (rules 1, 7, 8, 9 and 11 of the release).

They make environments realistic; a program that can't run with one of them runs without it.
"""

from collections.abc import Iterator

from hearth.grounding.preconditions.conditions import Condition
from hearth.grounding.preconditions.usual_states import usual_conditions
from hearth.kb.knowledge import Knowledge
from hearth.schemas.literals import Key, Literal
from hearth.schemas.program import Program


def default_conditions(program: Program, knowledge: Knowledge) -> Iterator[Condition]:
    """Yield the soft conditions of a program: states of its things first, which are given up last."""
    yield from usual_conditions(program, knowledge)
    yield from _locations(program, knowledge)
    yield from _contents(program, knowledge)
    yield from _supports(program, knowledge)
    yield from _free_seats(program, knowledge)
    yield from _plugs(program, knowledge)


def _locations(program: Program, knowledge: Knowledge) -> Iterator[Condition]:
    """Rule 7: after a room was named, what is first used then is in that room, until another is named."""
    room: Key | None = None
    seen: set[Key] = set()
    for number, step in enumerate(program.steps):
        for ref in step.objects:
            if knowledge.is_room(ref.name):
                room = ref.key if step.action in knowledge.group("goes") else room
            elif ref.key not in seen:
                seen.add(ref.key)
                if room is not None and not knowledge.has(ref.name, "BODY_PART"):
                    yield Condition(Literal("location", (ref.key, room)), number, hard=False)


def _contents(program: Program, knowledge: Knowledge) -> Iterator[Condition]:
    """Rule 8: what is grabbed while something that the program opened is open, comes from inside it."""
    opened: list[Key] = []
    handled: set[Key] = set()
    for number, step in enumerate(program.steps):
        keys = [ref.key for ref in step.objects]
        if step.action == "Open":
            opened.append(keys[0])
        elif step.action == "Close" and keys[0] in opened:
            opened.remove(keys[0])
        elif step.action == "Grab" and keys[0] not in handled:
            container = next((key for key in reversed(opened) if _belongs(keys[0], "IN", key, knowledge)), None)
            if container is not None:
                yield Condition(Literal("inside", (keys[0], container)), number, hard=False)
        if step.action in knowledge.group("frees_hand") or step.action == "Grab":
            handled.add(keys[0])


def _belongs(thing: Key, relation: str, place: Key, knowledge: Knowledge) -> bool:
    """Return whether the knowledge places such a thing there."""
    same = knowledge.same_class(place[0])
    return any(p.relation == relation and p.destination in same for p in knowledge.placements(thing[0]))


def _supports(program: Program, knowledge: Knowledge) -> Iterator[Condition]:
    """Rule 9: a character that goes to a table, then uses another thing, expects it there; at a chair, near it."""
    last: Key | None = None
    seen: set[Key] = set()
    for number, step in enumerate(program.steps):
        for ref in step.objects:
            new = ref.key not in seen
            seen.add(ref.key)
            movable = new and knowledge.has(ref.name, "GRABBABLE")
            if not movable or last is None:
                continue
            if last[0] in knowledge.table_like and _belongs(ref.key, "ON", last, knowledge):
                yield Condition(Literal("in", (ref.key, last)), number, hard=False)
            elif last[0] == "chair":
                yield Condition(Literal("atreach", (ref.key, last)), number, hard=False)
        if step.objects and (step.action in knowledge.group("goes") or step.action == "LookAt"):
            last = None if knowledge.is_room(step.objects[0].name) else step.objects[0].key


def _free_seats(program: Program, knowledge: Knowledge) -> Iterator[Condition]:
    """Rule 11: seats and beds that are used are free."""
    for number, step in enumerate(program.steps):
        if step.action in knowledge.group("rests") and step.objects:
            yield Condition(Literal("free", (step.objects[0].key,)), number)


def _plugs(program: Program, knowledge: Knowledge) -> Iterator[Condition]:
    """Rule 1: what is switched on has its plug in, unless the program puts it in."""
    plugged: set[Key] = set()
    for number, step in enumerate(program.steps):
        if not step.objects:
            continue
        key = step.objects[0].key
        if step.action in knowledge.achieving("PLUGGED_IN", "PLUGGED_OUT"):
            plugged.add(key)
        elif step.action in knowledge.achieving("ON", "OFF") and key not in plugged:
            plugged.add(key)
            if knowledge.has(key[0], "HAS_PLUG"):
                yield Condition(Literal("plugged", (key,)), number)
