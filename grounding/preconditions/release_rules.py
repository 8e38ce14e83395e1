"""The release's own rules for preconditions, to be compared with a program's real needs.

They read the program once, in order, and look at names only (facts worked out from the release; thesis 5.5.2).
"""

from collections.abc import Iterator
from typing import NamedTuple

from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.grounding.preconditions.minimal_home import sketch
from hearth.kb.knowledge import Knowledge
from hearth.schemas.literals import CHARACTER, NAME_OF, Key, Literal
from hearth.schemas.program import Program, Step
from hearth.schemas.vocabulary import OPPOSITE
from hearth.simulation.engine import run
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World

SEATS = frozenset({"couch", "bed", "chair", "loveseat", "sofa", "toilet", "pianobench", "bench"})


class Compared(NamedTuple):
    """A condition of the release's rules, compared with ours.

    Attributes:
        condition: as the rules have it.
        ours: whether it is among ours.
        why: why not: the step it would stop, or that no step needs it.
    """

    condition: Condition
    ours: bool
    why: str = ""


def by_rules(program: Program, knowledge: Knowledge) -> Preconditions:
    """Return the conditions that the release's rules name, each once, in step order.

    Contradictions are left standing.
    """
    found = sorted(_by_rules(program, knowledge), key=lambda condition: condition.step)
    return Preconditions().plus(*found)


def compare(
    program: Program, ours: Preconditions, knowledge: Knowledge, rules: Rules = DEFAULT
) -> tuple[Compared, ...]:
    """Each of the release's conditions with ours: the same, or the reason why it is not among them."""
    facts = {condition.literal for condition in ours}
    return tuple(
        Compared(condition, True) if condition.literal in facts else _tried(condition, program, ours, knowledge, rules)
        for condition in by_rules(program, knowledge)
    )


def _tried(condition: Condition, program: Program, ours: Preconditions, knowledge: Knowledge, rules: Rules) -> Compared:
    """Run the program with the condition as well: reports whether it runs, else the step that fails."""
    place = sketch(program, ours.plus(condition), knowledge)
    execution = run(World.start(place.home), place.program, rules)
    if execution.failure is None:
        return Compared(condition, False, "not needed: every step runs without it")
    step = execution.failure.tick
    action = program.steps[step].action
    return Compared(condition, False, f"refused: with it step {step + 1}, [{action}], fails: {execution.failure.code}")


def _by_rules(program: Program, knowledge: Knowledge) -> Iterator[Condition]:
    yield from _states(program, knowledge)
    yield from _rest(program, knowledge)
    yield from _places(program, knowledge)
    yield from _seats(program, knowledge)
    yield from _rooms(program, knowledge)
    yield from _opened(program)
    yield from _tables(program, knowledge)


def _soft(name: str, step: int, *objects: Key) -> Condition:
    return Condition(Literal(name, objects), step, hard=False)


def _states(program: Program, knowledge: Knowledge) -> Iterator[Condition]:
    """Rule 1: an object first switched, plugged in, opened or closed was the other way before."""
    seen: set[tuple[str, Key]] = set()
    operated = knowledge.group("operates") - knowledge.achieving("PLUGGED_OUT")
    for number, step in enumerate(program.steps):
        if step.action not in operated or not step.objects:
            continue
        before = OPPOSITE[knowledge.state_of(step.action)]
        kind, key = knowledge.group_of(before), step.objects[0].key
        if (kind, key) in seen:
            continue
        seen.add((kind, key))
        if key[0] != "eyes":
            yield _soft(NAME_OF[before], number, key)
        switched = before in ("ON", "OFF")
        if switched and knowledge.has(key[0], "HAS_PLUG") and (knowledge.group_of("PLUGGED_IN"), key) not in seen:
            yield _soft("plugged", number, key)


def _rest(program: Program, knowledge: Knowledge) -> Iterator[Condition]:
    """Rules 3 and 6: a character that first gets up was sitting; a garment first taken off is worn."""
    seated = False
    worn: set[Key] = set()
    for number, step in enumerate(program.steps):
        if step.action in knowledge.group("gets_up") and not seated:
            yield _soft("sitting", number, CHARACTER)
        elif step.action == "PutOff" and step.objects[0].key not in worn:
            yield _soft("in", number, step.objects[0].key, CHARACTER)
        elif step.action == "PutOn":
            worn.add(step.objects[0].key)
        seated = seated or step.action in knowledge.group("rests")


def _places(program: Program, knowledge: Knowledge) -> Iterator[Condition]:
    """Rules 2, 4 and 5: what is used is at reach of the seat, near at the start, or at reach of a target."""
    sought: set[Key] = set()
    held: set[Key] = set()
    at: Key | None = None
    seat: Key | None = None
    goes, walks = knowledge.group("goes"), knowledge.group("walks")
    for number, step in enumerate(program.steps):
        keys = [ref.key for ref in step.objects]
        for key in keys:
            used = step.action not in goes and step.action != "PutOff" and key not in held
            if not used or knowledge.is_room(key[0]) or knowledge.has(key[0], "BODY_PART"):
                continue
            if seat is not None and key != seat:
                yield _soft("atreach", number, seat, key)
            elif key not in sought and (at is None or (not knowledge.is_room(at[0]) and key != at)):
                yield _soft("nearby", number, key, CHARACTER) if at is None else _soft("atreach", number, key, at)
        if step.action in goes and keys:
            sought.add(keys[0])
            at = keys[0] if step.action in walks else at
        elif step.action == "Grab":
            held.add(keys[0])
        seat = _seat(seat, step, knowledge)


def _seat(seat: Key | None, step: Step, knowledge: Knowledge) -> Key | None:
    """Return the character's seat or bed after a step."""
    if step.action in knowledge.group("rests"):
        return step.objects[0].key
    return None if step.action in knowledge.group("gets_up") else seat


def _seats(program: Program, knowledge: Knowledge) -> Iterator[Condition]:
    """Rules 10 and 11: what is watched from a seat is faced by it; every seat that is named is free."""
    seat: Key | None = None
    for number, step in enumerate(program.steps):
        for ref in step.objects:
            if ref.name in SEATS:
                yield _soft("free", number, ref.key)
        if step.action == "Watch" and seat is not None:
            yield _soft("facing", number, seat, step.objects[0].key)
        seat = _seat(seat, step, knowledge)


def _rooms(program: Program, knowledge: Knowledge) -> Iterator[Condition]:
    """Rule 7: after a room was named, what is used is in it, until another is."""
    room: Key | None = None
    for number, step in enumerate(program.steps):
        for ref in step.objects:
            if knowledge.is_room(ref.name):
                room = ref.key
            elif room is not None:
                yield _soft("location", number, ref.key, room)


def _opened(program: Program) -> Iterator[Condition]:
    """Rule 8: what is grabbed while something is open comes from inside what was opened last."""
    opened: list[Key] = []
    for number, step in enumerate(program.steps):
        if step.action == "Open":
            opened.append(step.objects[0].key)
        elif step.action == "Close" and step.objects[0].key in opened:
            opened.remove(step.objects[0].key)
        elif step.action == "Grab" and opened and opened[-1] != step.objects[0].key:
            yield _soft("inside", number, step.objects[0].key, opened[-1])


def _tables(program: Program, knowledge: Knowledge) -> Iterator[Condition]:
    """Rule 9: what is used after something table-like was walked to is on it; after a chair, near it."""
    last: Key | None = None
    for number, step in enumerate(program.steps):
        for ref in step.objects:
            if last is None or ref.key == last or knowledge.is_room(ref.name):
                continue
            if last[0] == "chair":
                yield _soft("atreach", number, ref.key, last)
            else:
                yield _soft("in", number, ref.key, last)
        if step.objects and (step.action in knowledge.group("goes") or step.action == "LookAt"):
            key = step.objects[0].key
            last = key if key[0] in knowledge.table_like or key[0] == "chair" else None
        else:
            last = None
