"""Checks of a plan's entries together: rooms do not overlap, doors lead somewhere, furniture can be reached."""

from collections.abc import Iterable, Sequence
from typing import TypeVar

import numpy as np

from hearth.homes.geometry import Rect, bottom, footprint, front_of, intrusion, top, wall_of
from hearth.homes.plans.home_shell import Shell, Thing, before, interior, strip
from hearth.homes.plans.plan import OUTSIDE, Plan
from hearth.homes.plans.walkable_floor import REACH, Floor, stands_on_floor
from hearth.schemas.failures import Code
from hearth.schemas.yaml_fields import Faults

Id = TypeVar("Id", int, str)

TOUCH = 0.011
"""Things may stand this far in each other: plans are rounded to centimetres."""
FRONT = 0.6
"""Metres before its front from which a thing is used."""
LEAST_ROOM = 0.9


def check_rooms(plan: Plan, faults: Faults) -> None:
    """Rooms have names of their own, are large enough, do not overlap, and can all be entered through doors."""
    seen: dict[str, int] = {}
    for room in plan.rooms:
        if room.name in seen:
            faults.add(Code.DUPLICATE, f"two rooms are called `{room.name}`", room.line,
                       f"as in line {seen[room.name]}: give one a `name` of its own and its `class`")  # fmt: skip
        seen.setdefault(room.name, room.line)
        if min(room.rect.width, room.rect.depth) < LEAST_ROOM:
            faults.add(Code.NO_PLACE, f"{room.name} is too narrow", room.line, f"at least {LEAST_ROOM} m")
        if room.name == OUTSIDE:
            faults.add(Code.SYNTAX, f"a room cannot be called `{OUTSIDE}`", room.line)
    for i, a in enumerate(plan.rooms):
        for b in plan.rooms[:i]:
            area = a.rect.inset(TOUCH / 2).overlap(b.rect.inset(TOUCH / 2))
            if area > 0:
                faults.add(Code.CONTRADICTION, f"{a.name} and {b.name} overlap by {area:.2f} square metres", a.line,
                           f"{b.name} (line {b.line}) covers {_bounds(b.rect)}")  # fmt: skip
    _check_doors(plan, faults)
    if plan.character and plan.character not in seen:
        faults.add(Code.UNKNOWN_OBJECT, f"the character stands in `{plan.character}`, which is not a room of the plan")


def check_layout(plan: Plan, shell: Shell, things: Sequence[Thing], floor: Floor, faults: Faults) -> None:
    """Furniture stays within its room's walls, out of other furniture, of doors and openings, and can be reached."""
    for room in plan.rooms:
        own = [thing for thing in things if thing.room == room.name and _placed(thing)]
        for thing in own:
            _check_walls(thing, interior(room), plan.height, faults)
            _check_openings(thing, interior(room), shell, faults)
        _check_apart(own, faults)
    _check_kept_free(things, shell, faults)
    _check_reach(plan, things, floor, faults)


def _placed(thing: Thing) -> bool:
    held = thing.on or thing.inside
    return thing.mount in ("floor", "flat", "wall", "ceiling") or (thing.mount == "item" and not held)


def _bounds(rect: Rect) -> str:
    return f"{rect.x0:g} to {rect.x1:g} m east, {rect.z0:g} to {rect.z1:g} m north"


def _short(thing: Thing) -> str:
    return f"`{thing.name.partition('/')[2]}` in {thing.room}"


def _check_doors(plan: Plan, faults: Faults) -> None:
    if not plan.rooms:
        return
    reached = joined(plan.rooms[0].name, [set(door.rooms) - {OUTSIDE} for door in plan.doorways])
    for room in plan.rooms:
        if room.name not in reached:
            faults.add(Code.NO_PATH, f"nobody can enter {room.name} from {plan.rooms[0].name}", room.line,
                       f"add a door, such as `between: [{plan.rooms[0].name}, {room.name}]`")  # fmt: skip


def _check_walls(thing: Thing, inner: Rect, height: float, faults: Faults) -> None:
    rect = footprint(thing.box)
    for wall in ("west", "south", "east", "north"):
        distance = rect.reach(wall) - inner.reach(wall)
        if distance > TOUCH:
            faults.add(Code.NO_PLACE, f"{_short(thing)} stands {distance:.2f} m through the {wall} wall", thing.line,
                       "move it or make it smaller")  # fmt: skip
    if top(thing.box) > height + TOUCH or bottom(thing.box) < -TOUCH:
        faults.add(Code.NO_PLACE, f"{_short(thing)} reaches from {bottom(thing.box):.2f} to {top(thing.box):.2f} m",
                   thing.line, f"the room is {height:g} m high")  # fmt: skip


def _check_openings(thing: Thing, inner: Rect, shell: Shell, faults: Faults) -> None:
    """Check the walls: a hanging thing needs a wall behind it, and a tall one must not hide a window."""
    if thing.mount != "wall" or thing.yaw is None:
        return
    rect = footprint(thing.box).inset(-0.02)
    for opening in shell.openings:
        if opening.room != thing.room or opening.wall != wall_of(thing.yaw):
            continue
        hole = strip(inner, opening.wall, opening.start, opening.end, 0.02)
        overlap = min(top(thing.box), opening.y1) - max(bottom(thing.box), opening.y0)
        if rect.overlap(hole) > 0.0005 and overlap > TOUCH:
            what = "door" if opening.door else "window"
            faults.add(Code.NO_PLACE, f"{_short(thing)} hangs before a {what} in the {opening.wall} wall", thing.line,
                       f"the {what} takes {opening.start:.2f} to {opening.end:.2f} m of it")  # fmt: skip


def _check_apart(things: Sequence[Thing], faults: Faults) -> None:
    solid = [thing for thing in things if thing.mount != "flat"]
    for i, a in enumerate(solid):
        for b in solid[:i]:
            depth = intrusion(a.box, b.box)
            if depth > TOUCH:
                other = b.name.partition("/")[2]
                faults.add(Code.NO_PLACE, f"{_short(a)} stands {depth:.2f} m in `{other}`", a.line,
                           f"`{other}` (line {b.line}) covers {_bounds(footprint(b.box))}")  # fmt: skip


def _check_kept_free(things: Sequence[Thing], shell: Shell, faults: Faults) -> None:
    leaves = [thing for thing in things if thing.class_name in ("door", "maindoor")]
    for i, leaf in enumerate(leaves):
        for other in leaves[:i]:
            if intrusion(leaf.box, other.box) > 0:
                faults.add(Code.NO_PLACE, f"the open doors of lines {other.line} and {leaf.line} strike each other",
                           leaf.line, "change `hinge` or `into` of one")  # fmt: skip
    for thing in things:
        if not stands_on_floor(thing):
            continue
        for room, zone, line in shell.kept_free:
            if room == thing.room and footprint(thing.box).inset(TOUCH).overlap(zone) > 0:
                faults.add(Code.NO_PLACE, f"{_short(thing)} blocks the door of line {line}", thing.line,
                           f"the door needs {_bounds(zone)}")  # fmt: skip


def _check_reach(plan: Plan, things: Sequence[Thing], floor: Floor, faults: Faults) -> None:
    """Check that all rooms join on foot, and that a character in a room gets to the front of each thing that has one.

    Not checked where rooms, doors or the thing itself are at fault already.
    """
    faulty = {fault.line for fault in faults}
    if faulty & ({room.line for room in plan.rooms} | {door.line for door in plan.doorways}):
        return
    for number, room in enumerate(plan.rooms):
        if not (floor.main & (floor.room == number)).any() and floor.main.any():
            faults.add(Code.NO_PATH, f"furniture leaves no way into {room.name}", room.line,
                       "clear half a metre from its door")  # fmt: skip
    for thing in things:
        if thing.front and thing.mount == "floor" and thing.yaw is not None and thing.line not in faulty:
            zone = before(footprint(thing.box), thing.yaw, max(thing.front, FRONT))
            if not _any_in(floor.main, floor, zone):
                faults.add(Code.NO_PATH, f"nobody can get to the front of {_short(thing)}", thing.line,
                           f"leave {thing.front:g} m free on its {front_of(thing.yaw)} side")  # fmt: skip
    numbers = {room.name: number for number, room in enumerate(plan.rooms)}
    for thing in things:
        if thing.mount == "floor" and thing.line not in {fault.line for fault in faults}:
            far = floor.distance(thing.box, numbers[thing.room])
            if REACH < far < np.inf:
                faults.add(Code.NO_PATH, f"nobody gets nearer than {far:.2f} m to {_short(thing)}", thing.line,
                           f"leave a way of half a metre to within {REACH:g} m of it")  # fmt: skip


def _any_in(mask: np.ndarray, floor: Floor, zone: Rect) -> bool:
    i0, j0 = floor.index(zone.x0, zone.z0)
    i1, j1 = floor.index(zone.x1, zone.z1)
    return bool(mask[max(i0, 0) : i1 + 1, max(j0, 0) : j1 + 1].any())


def joined(start: Id, doors: Iterable[set[Id]]) -> set[Id]:
    """Return the rooms reached from `start` through doors; a door is the set of rooms that it joins."""
    found, left = {start}, list(doors)
    while through := [ends for ends in left if ends & found]:
        left = [ends for ends in left if not ends & found]
        found.update(*through)
    return found
