"""Plan -> boxes: every wall, tile, door, window, piece of furniture and thing on or in it, in metres, y up."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

from hearth.homes.geometry import EPSILON, Rect, box_over, facing_from, footprint
from hearth.homes.object_shapes import form
from hearth.homes.plans import grid_shapes, home_shell, plan_checks
from hearth.homes.plans.furniture import Furnishing, furnish
from hearth.homes.plans.home_shell import Shell, Thing, interior, span, strip
from hearth.homes.plans.object_packing import contents
from hearth.homes.plans.plan import Plan, Room
from hearth.homes.plans.plan_entries import read_plan
from hearth.homes.plans.walkable_floor import CELL, Floor, grid
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import Box
from hearth.schemas.vocabulary import CHARACTER_CLASS
from hearth.schemas.yaml_fields import Faults

PERSON = (0.45, 1.7, 0.35)
"""Width, height and depth of a character."""
SWITCH_FROM_DOOR = 0.12
SEATS = frozenset({"chair", "stool", "bench", "high_chair"})
"""Classes of vessels from which people eat."""


@dataclass(frozen=True, eq=False)
class Layout:
    """A plan with everything in its place.

    Attributes:
        plan: the plan.
        shell: its walls, tiles, openings.
        things: all but rooms and the character: the shell's things, then the furniture with the things on and in it.
        person: the character, where a file says where it stands.
    """

    plan: Plan
    shell: Shell
    things: tuple[Thing, ...]
    person: Thing | None = None

    @cached_property
    def floor(self) -> Floor:
        """The floor as it is furnished, at 10 cm."""
        return grid(self.plan, self.shell, self.things, CELL)

    @cached_property
    def character(self) -> Thing:
        """The character: as a file says, or in its room, where the main region has the most space around it."""
        return self.person or _character(self)

    def rooms(self) -> Iterator[Thing]:
        """Yield the rooms as boxes."""
        for room in self.plan.rooms:
            box = box_over(interior(room), 0.0, self.plan.height)
            yield Thing(room.name, room.class_name, room.name, box, None, "room", line=room.line)


def read(text: str, file: str, knowledge: Knowledge) -> Layout:
    """Return a plan's text with everything in its place.

    Raises:
        HearthError: every fault of the plan, each naming the thing, the file, the line and the remedy.
    """
    faults = Faults(file)
    plan = read_plan(text, file, knowledge, faults)
    plan_checks.check_rooms(plan, faults)
    if faults and not plan.rooms:
        raise HearthError(faults.underlined(text))
    layout = arrange(plan, knowledge, faults)
    plan_checks.check_layout(layout.plan, layout.shell, layout.things, layout.floor, faults)
    if faults:
        raise HearthError(faults.underlined(text))
    return layout


def arrange(
    plan: Plan, knowledge: Knowledge, faults: Faults, known: dict[int, tuple[Room, tuple[Thing, ...]]] | None = None
) -> Layout:
    """Everything of a plan in its place; what has none is noted and left out.

    Args:
        plan: to arrange.
        knowledge: for sizes.
        faults: what is wrong is added to it.
        known: rooms arranged before by their `id`, with their things, which are taken as they are; rooms without
            faults are added.
    """
    built = home_shell.build(plan, faults)
    things = list(built.things)
    for room in plan.rooms:
        before = len(faults)
        same, found = (known or {}).get(id(room), (None, ()))
        if same is not room:
            found = tuple(_furnished(plan, room, built, knowledge, faults))
            if known is not None and len(faults) == before:
                known[id(room)] = room, found
        things.extend(found)
    return Layout(plan, built, tuple(things))


def _furnished(plan: Plan, room: Room, built: Shell, knowledge: Knowledge, faults: Faults) -> Iterator[Thing]:
    """Return a room's furniture with the things on and in it, and the things that every room has."""
    furnished = furnish(room, plan.height, knowledge, faults)
    yield from _implied(plan, room, built, furnished, knowledge)
    seats = [placed.thing for placed in furnished.placed if placed.thing.class_name in SEATS]
    for placed in furnished.placed:
        thing = standing(placed.thing, built)
        yield thing
        yield from contents(thing, placed.piece, knowledge, faults, seats)


def standing(thing: Thing, built: Shell) -> Thing:
    """Return the same thing, with the floor tile or wall panel it is on."""
    x, z = footprint(thing.box).center
    if thing.mount in ("floor", "flat"):
        on = next((t.name for t in _shell(built, thing.room, "floor") if footprint(t.box).holds(x, z)), "")
        return replace(thing, on=on)
    if thing.mount == "wall" and thing.yaw is not None:
        reach = footprint(thing.box).inset(-0.02)
        panels = [t for t in _shell(built, thing.room, "wall") if t.yaw == thing.yaw]
        best = max(panels, key=lambda t: _contact(t.box, reach, thing.box), default=None)
        if best is not None and _contact(best.box, reach, thing.box) > 0:
            return replace(thing, on=best.name)
    return thing


def _contact(panel: Box, reach: Rect, box: Box) -> float:
    low = max(panel.center[1] - panel.size[1] / 2, box.center[1] - box.size[1] / 2)
    high = min(panel.center[1] + panel.size[1] / 2, box.center[1] + box.size[1] / 2)
    return footprint(panel).overlap(reach) * max(0.0, high - low)


def _shell(built: Shell, room: str, class_name: str) -> Iterator[Thing]:
    return (thing for thing in built.things if thing.room == room and thing.class_name == class_name)


def _implied(plan: Plan, room: Room, built: Shell, furnished: Furnishing, knowledge: Knowledge) -> Iterator[Thing]:
    """Return the things that every room has even if the plan lists none.

    A lamp at the ceiling and a switch next to a door.
    """
    classes = {placed.thing.class_name for placed in furnished.placed}
    if not classes & {"ceilinglamp", "ceilingfan"}:
        known = form("ceilinglamp", knowledge)
        if known is not None:
            (x, z), (width, height, depth) = interior(room).center, known.size
            box = box_over(Rect.around(x, z, width, depth), plan.height - height, plan.height)
            yield Thing(f"{room.name}/ceilinglamp.1", "ceilinglamp", room.name, box, 0.0, "ceiling", line=room.line)
    if "light" not in classes:
        switch = _switch(room, built, knowledge)
        if switch is not None:
            yield standing(switch, built)


def _switch(room: Room, built: Shell, knowledge: Knowledge) -> Thing | None:
    """Return a light switch next to the room's first doorway, on the side opposite to the door's hinges, where there is
    wall.
    """
    known = form("light", knowledge)
    inner = interior(room)
    for opening in built.openings:
        if opening.room != room.name or opening.door is None or known is None:
            continue
        low, high = span(inner, opening.wall)
        width, height, depth = known.size
        after, before = opening.end + SWITCH_FROM_DOOR, opening.start - SWITCH_FROM_DOOR - width
        starts = (after, before) if opening.door.hinge == "low" else (before, after)
        for start in starts:
            on_wall = start >= low - EPSILON and start + width <= high + EPSILON
            if on_wall and not _pierced(built, opening, start, start + width):
                box = box_over(strip(inner, opening.wall, start, start + width, depth), known.up, known.up + height)
                yaw = facing_from(opening.wall)
                return Thing(f"{room.name}/light.1", "light", room.name, box, yaw, "wall", line=room.line)
    return None


def _pierced(built: Shell, beside: home_shell.Opening, start: float, end: float) -> bool:
    return any(
        (o.room, o.wall) == (beside.room, beside.wall) and o is not beside and o.start < end and start < o.end
        for o in built.openings
    )


def _character(layout: Layout) -> Thing:
    plan, floor = layout.plan, layout.floor
    names = [room.name for room in plan.rooms]
    number = names.index(plan.character) if plan.character in names else 0
    space = grid_shapes.clearance(floor.free) * (floor.main & (floor.room == number))
    i, j = divmod(int(space.argmax()), space.shape[1])
    x, z = floor.center(i, j)
    width, height, depth = PERSON
    box = box_over(Rect.around(x, z, width, depth), 0.0, height)
    inner = interior(plan.rooms[number])
    toward_x = abs(inner.center[0] - x) > abs(inner.center[1] - z)
    yaw = (90.0 if inner.center[0] > x else 270.0) if toward_x else (0.0 if inner.center[1] >= z else 180.0)
    return Thing(CHARACTER_CLASS, CHARACTER_CLASS, names[number], box, yaw, "character")
