"""Movement in the plain engine: walking, turning, sitting and lying."""

from __future__ import annotations

from collections.abc import Iterable

from hearth.schemas.failures import Code
from oracles.world import Options, World, need

SEATS = {
    "couch": 4, "bed": 4, "sofa": 4, "loveseat": 2, "love_seat": 2, "pianobench": 2, "piano_bench": 2, "bench": 2,
}  # fmt: skip
BEDS = {"bed": 3, "couch": 2, "sofa": 2, "loveseat": 2, "love_seat": 2, "bathtub": 2}
BEDDING = {"blanket", "comforter", "pillow", "sheets"}


def walk(w: World, o: int, _: int | None, options: Options) -> None:
    need(not w.is_(w.me, "LYING"), Code.LYING)
    need(not w.is_(w.me, "SITTING"), Code.SITTING)
    room = w.room(o)
    if options.doors and w.room(w.me) is not None:
        room = side(w, w.room(w.me), o, room)
    need(room is not None, Code.NO_ROOM)
    assert room is not None
    if options.doors:
        need(reachable(w, w.room(w.me), room), Code.DOOR_CLOSED)
    near = near_today(w, o) if options.today else near_then(w, o)
    w.isolate(w.me, "INSIDE", "CLOSE", "FACING")
    for x in w.held():
        w.isolate(x, "INSIDE", "CLOSE", "FACING")
    w.link(w.me, "INSIDE", room)
    for x in w.held():
        w.link(x, "INSIDE", room)
    for x in near | w.held():
        w.link(w.me, "CLOSE", x)


def near_then(w: World, o: int) -> set[int]:
    near = {o} | w.body | (w.to["INSIDE"][o] - w.rooms)
    return near | w.back["ON"][o] if w.has(o, "SURFACES") else near


def near_today(w: World, o: int) -> set[int]:
    """As VirtualHome 2.x has it: nothing in a room; else also what it is ON, and what is INSIDE what can be opened."""
    if o in w.rooms:
        return set()
    near = {o} | w.body | (w.to["INSIDE"][o] - w.rooms) | w.to["ON"][o]
    return near | w.back["INSIDE"][o] if w.has(o, "CAN_OPEN") else near


def side(w: World, start: int | None, o: int, room: int | None) -> int | None:
    """A door can be walked to from either side: from that which no closed door keeps away, one's own if possible."""
    reached = flood(w, start, open_doors(w))
    if room is not None and room in reached:
        return room
    sides = w.to["BETWEEN"][o] & w.rooms & reached
    return start if start in sides else min(sides, default=room)


def open_doors(w: World) -> list[int]:
    return [d for d in list(w.to["BETWEEN"]) if w.to["BETWEEN"][d] and not w.is_(d, "CLOSED")]


def flood(w: World, start: int | None, doors: Iterable[int]) -> set[int | None]:
    reached = {start}
    before = 0
    while len(reached) > before:
        before = len(reached)
        for door in doors:
            if w.to["BETWEEN"][door] & reached:
                reached |= w.to["BETWEEN"][door]
    return reached


def reachable(w: World, start: int | None, goal: int) -> bool:
    """Through doors that are not closed; true as well where the graph knows of no way at all."""
    if start is None or start == goal:
        return True

    doors = [d for d in list(w.to["BETWEEN"]) if w.to["BETWEEN"][d]]
    return goal in flood(w, start, open_doors(w)) or goal not in flood(w, start, doors)


def find(w: World, o: int, s: int | None, options: Options) -> None:
    near = o in w.back["ON"][w.me] or w.has(o, "BODY_PART") or w.close(o, options)
    if not near and not w.resting():
        walk(w, o, s, options)
        return
    need(w.close(o, options), Code.NOT_CLOSE)
    for x in list(w.to["FACING"][w.me]):
        w.unlink(w.me, "FACING", x)
    w.link(w.me, "CLOSE", o)


def turn_to(w: World, o: int, _: int | None, options: Options) -> None:
    for x in list(w.to["FACING"][w.me]):
        w.unlink(w.me, "FACING", x)
    w.link(w.me, "FACING", o)


def sit(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.close(o, options), Code.NOT_CLOSE)
    need(not w.is_(w.me, "SITTING"), Code.SITTING)
    need(w.has(o, "SITTABLE"), Code.NOT_AFFORDED)
    need(len(taken(w, o, options)) < SEATS.get(w.name[o], 1), Code.OCCUPIED)
    leave_seats(w, options)
    w.link(w.me, "ON", o)
    for x in list(w.to["FACING"][o]):
        w.link(w.me, "FACING", x)
    w.enter(w.me, "SITTING")


def lie(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.close(o, options), Code.NOT_CLOSE)
    need(not w.is_(w.me, "LYING"), Code.LYING)
    need(w.has(o, "LIEABLE"), Code.NOT_AFFORDED)
    need(len(taken(w, o, options)) < BEDS.get(w.name[o], 1), Code.OCCUPIED)
    leave_seats(w, options)
    w.link(w.me, "ON", o)
    w.enter(w.me, "LYING")


def taken(w: World, o: int, options: Options) -> list[int]:
    """Return the nodes that take room; a made bed's bedding is turned back."""
    made = options.made_bed and w.has(o, "LIEABLE")
    return [x for x in w.back["ON"][o] if not made or w.name[x] not in BEDDING]


def stand_up(w: World, _: int | None, __: int | None, options: Options) -> None:
    need(w.resting(), Code.NOT_SITTING_OR_LYING)
    w.states[w.me] -= {"SITTING", "LYING"}
    leave_seats(w, options)


def leave_seats(w: World, options: Options) -> None:
    for x in list(w.to["ON"][w.me]):
        if options.leaves_seat and w.has(x, "SITTABLE", "LIEABLE"):
            w.unlink(w.me, "ON", x)


def sleep(w: World, *_: object) -> None:
    need(w.resting(), Code.NOT_SITTING_OR_LYING)
