"""Checks of the meaning of a well-formed program: contradictions, objects out of reach, descriptions that do not fit.

Faults refuse a program; warnings are stored with it. Each names the step, and most name the correction.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.pipelines.checks.findings import Finding
from hearth.pipelines.crowd import topics
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.literals import NAME_OF
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.row_types import BindingRow, ConditionRow, GraphRow
from hearth.schemas.stage_rows import GroundingRow
from hearth.schemas.syntax import print_object, print_step

_MADE = {"ON": "switched on", "OFF": "switched off", "OPEN": "opened", "CLOSED": "closed"}


def contradictions(program: Program, known: Knowledge) -> Iterator[Finding]:
    """Yield steps that set a state which the program has already set: switched on twice, opened while open."""
    made: dict[tuple[tuple[str, int], str], str] = {}
    for number, step in enumerate(program.steps):
        if step.action in known.group("operates") and step.objects:
            value = known.state_of(step.action)
            key = (step.objects[0].key, known.group_of(value))
            if made.get(key) == value:
                done = _MADE.get(value, f"{step.action} done")
                message = f"{print_object(step.objects[0])} is {done} twice with nothing between"
                remedy = "leave the second one out"
                yield Finding(Code.CONTRADICTION, number, message, remedy, (), True, step.action)
            made[key] = value


def met_at_start(
    program: Program, groundings: Iterable[GroundingRow], conditions: Iterable[ConditionRow], known: Knowledge
) -> Iterator[Finding]:
    """Yield steps whose state already holds at the start, by a stored start graph or by the program's own conditions.

    Args:
        program: in canonical names.
        groundings: those stored with it; their start graph may be None.
        conditions: those stored with it.
        known: the effects of actions.
    """
    stored = [(ref["name"], ref["instance"], one["name"]) for one in conditions for ref in one["objects"][:1]]
    starts = [("by its own conditions", frozenset(stored))]
    starts += [(f"in {one['home']}", _held(one["start"], one["bindings"])) for one in groundings if one["start"]]
    seen: set[tuple[tuple[str, int], str]] = set()
    for number, step in enumerate(program.steps):
        if step.action not in known.group("operates") or not step.objects:
            continue
        ref, state = step.objects[0], known.state_of(step.action)
        aspect = known.group_of(state)
        if (ref.key, aspect) in seen:
            continue
        seen.add((ref.key, aspect))
        where = [name for name, held in starts if {(*ref.key, state), (*ref.key, NAME_OF[state])} & held]
        if where:
            message = f"{print_object(ref)} is {state} at the start already, {', '.join(where[:3])}"
            yield Finding(Code.NO_EFFECT, number, message, "leave the step out", (), True, step.action)


def _held(start: GraphRow, bindings: list[BindingRow]) -> frozenset[tuple[str, int, str]]:
    """Return the states of a program's objects in the start graph of a grounding, as (name, instance, state)."""
    states = {node["id"]: node["states"] for node in start["nodes"]}
    return frozenset(
        (bound["name"], bound["instance"], state) for bound in bindings for state in states.get(bound["node"]) or ()
    )


def not_close(program: Program, known: Knowledge) -> Iterator[Finding]:
    """Objects used without a Walk to them or to anything that they are usually on or in."""
    reached: set[str] = set()
    touched: set[tuple[str, int]] = set()
    for number, step in enumerate(program.steps):
        for ref in _needed_close(step, known):
            if ref.key not in touched and not _within_reach(ref, reached, known):
                walk = Step("Walk", (ref,), step.agent)
                message = f"{print_object(ref)} is used, but nobody went to it"
                remedy = f"write {print_step(walk)} before"
                yield Finding(Code.NOT_CLOSE, number, message, remedy, (walk,), False, ref.name, ref)
                reached.add(ref.name)
            touched.add(ref.key)
        if step.action in known.group("goes") and step.objects:
            touched.add(step.objects[0].key)
            reached.add(step.objects[0].name)
        if step.action in known.group("puts") | known.group("takes"):
            touched.update(ref.key for ref in step.objects)


def _needed_close(step: Step, known: Knowledge) -> tuple[ObjectRef, ...]:
    if any(step.action in known.group(name) for name in ("rests", "takes", "operates")):
        return step.objects[:1]
    return step.objects[1:2] if step.action in known.group("puts") else ()


def _within_reach(ref: ObjectRef, reached: set[str], known: Knowledge) -> bool:
    """Return whether an object may be near, on or in something reached, or the other way round."""
    things = {name for name in reached if not known.is_room(name)}
    thing = known.object_class(ref.name)
    if thing is None or thing.category == "Rooms" or not things.isdisjoint(known.same_class(ref.name)):
        return True
    if {"BODY_PART", "CLOTHES"} & set(thing.properties) or (things and "GRABBABLE" in thing.properties):
        return True
    if thing.category == "Lamps" and reached:
        return True  # its switch is by the door of the room, or near the bed
    destinations = {place.destination for place in known.placements(ref.name)}
    return any(
        name in destinations or _holds(known, ref.name, name) or _associated(known, ref.name, name) for name in things
    )


def _holds(known: Knowledge, name: str, other: str) -> bool:
    return any(place.destination == name for place in known.placements(other))


_CLOSELY = 4


def _associated(known: Knowledge, one: str, other: str) -> bool:
    """Return whether two things nearly always occur together, as a faucet and a bathtub."""
    return any(
        {row.name, row.other} == {one, other} and row.weight >= _CLOSELY
        for row in known.associations
        if row.relation == "goes_with"
    )


def without_effect(program: Program, known: Knowledge) -> Iterator[Finding]:
    """Yield a program that only walks and looks, unless its title names one of these actions."""
    passing = known.group("goes") | known.group("idle")
    if not program.steps or any(step.action not in passing for step in program.steps):
        return
    if {topics.stem(step.action.lower()) for step in program.steps}.isdisjoint(topics.stems(program.title)):
        yield Finding(Code.NO_EFFECT, -1, "this program only walks and looks", "write the steps that are done there")


_DIFFERING = {
    "missing": "used, but not declared as props",
    "unused": "declared as props, but not used",
    "more": "used in more pieces than were declared",
    "fewer": "declared in more pieces than are used",
    "no_room": "walked to, but not declared as rooms",
}
"""The ways in which a scene and a program differ, with their words."""


def undeclared(program: Program, row: Mapping[str, Any], known: Knowledge) -> Iterator[Finding]:
    """Yield declared rooms and props that are not used, and those used but not declared (thesis figure 3-3)."""
    for kind, names in scene_and_use(program, row, known):
        shown = ", ".join(names[:4])
        yield Finding(Code.UNDECLARED, -1, f"{_DIFFERING[kind]}: {shown}", found=shown)


def scene_and_use(program: Program, row: Mapping[str, Any], known: Knowledge) -> Iterator[tuple[str, list[str]]]:
    """Yield how a declared scene and a program differ: a kind of `_DIFFERING`, and the classes that it concerns."""
    rooms, props = ({one["name"]: one["quantity"] for one in row.get(part) or ()} for part in ("rooms", "props"))
    if not props and not rooms:
        return
    used = _used(program, known)
    differing = {
        "missing": {name for name in used if name not in props},
        "unused": {name for name in props if name not in used and not known.has(name, "BODY_PART")},
        "more": {name for name in used if name in props and used[name] > (props[name] or 1)},
        "fewer": {name for name in used if name in props and used[name] < (props[name] or 1)},
        "no_room": {r.name for s in program.steps for r in s.objects if known.is_room(r.name)} - rooms.keys(),
    }
    yield from ((kind, sorted(names)) for kind, names in differing.items() if names)


def _used(program: Program, known: Knowledge) -> dict[str, int]:
    """Return the number of objects of each class in a program, without rooms and parts of the body, which are not
    props.
    """
    instances: dict[str, set[int]] = {}
    for ref in program.objects():
        thing = known.object_class(ref.name)
        if thing and thing.category != "Rooms" and not known.has(ref.name, "BODY_PART"):
            instances.setdefault(ref.name, set()).add(ref.instance)
    return {name: len(found) for name, found in instances.items()}


def never_executed(program: Program, known: Knowledge) -> Iterator[Finding]:
    """Yield steps whose action no simulation runs: they can be written, and the program fails there."""
    for number, step in enumerate(program.steps):
        if not known.actions[step.action].executed:
            message = f"[{step.action}] can be written, but the simulator does not execute it"
            yield Finding(Code.NOT_SIMULATED, number, message, found=step.action)


def diagnostic(finding: Finding, program: Program, place: str, source: Sequence[str] = ()) -> Diagnostic:
    """Return a finding as a diagnostic with its place.

    Args:
        finding: one of the program's.
        program: with the lines of its steps.
        place: the file.
        source: the file's lines, for columns and underlining.
    """
    line = program.line(finding.step) if finding.step >= 0 else 0
    text = source[line - 1].rstrip("\n") if 0 < line <= len(source) else ""
    words = finding.object.name if finding.object else finding.found
    spelt = r"[\s_]+".join(map(re.escape, words.replace("_", " ").split()))
    match = re.search(spelt, text, re.IGNORECASE) if spelt and text else None
    column, length = (match.start() + 1, len(match[0])) if match else (0, 0)
    return Diagnostic(finding.code, finding.message, place, line, column, length, finding.found, finding.remedy, text)


def findings(program: Program, known: Knowledge) -> Iterable[Finding]:
    """Return the warnings of a program by itself."""
    yield from not_close(program, known)
    yield from without_effect(program, known)
    yield from topics.off_topic(program, known)
