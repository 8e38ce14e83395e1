"""The table of actions read straightforwardly, with dicts of sets: slow, plain, and independent of the engine.

It is what the engine is measured and checked against. One character; nothing here is shared with `hearth.simulation`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from hearth.schemas.failures import Code
from hearth.schemas.program import Program, Step
from oracles.world import OPPOSITE, Options, RefusedError, World, need

SEATS = {
    "couch": 4, "bed": 4, "sofa": 4, "loveseat": 2, "love_seat": 2, "pianobench": 2, "piano_bench": 2, "bench": 2,
}  # fmt: skip
BEDS = {"bed": 3, "couch": 2, "sofa": 2, "loveseat": 2, "love_seat": 2, "bathtub": 2}
BEDDING = {"blanket", "comforter", "pillow", "sheets"}
SQUEEZABLE = {
    "cleaning_solution", "tooth_paste", "shampoo", "food_peanut_butter", "dish_soap", "soap", "towel", "rag", "paper",
    "sponge", "food_lemon", "check",
}  # fmt: skip


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
    near = {o} | w.body | (w.to["INSIDE"][o] - w.rooms)
    if w.has(o, "SURFACES"):
        near |= w.back["ON"][o]
    w.isolate(w.me, "INSIDE", "CLOSE", "FACING")
    for x in w.held():
        w.isolate(x, "INSIDE", "CLOSE", "FACING")
    w.link(w.me, "INSIDE", room)
    for x in w.held():
        w.link(x, "INSIDE", room)
    for x in near | w.held():
        w.link(w.me, "CLOSE", x)


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
    near = o in w.back["ON"][w.me] or w.has(o, "BODY_PART") or w.close(o)
    if not near and not w.resting():
        walk(w, o, s, options)
        return
    need(w.close(o), Code.NOT_CLOSE)
    for x in list(w.to["FACING"][w.me]):
        w.unlink(w.me, "FACING", x)
    w.link(w.me, "CLOSE", o)


def sit(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.close(o), Code.NOT_CLOSE)
    need(not w.is_(w.me, "SITTING"), Code.SITTING)
    need(w.has(o, "SITTABLE"), Code.NOT_AFFORDED)
    need(len(taken(w, o, options)) < SEATS.get(w.name[o], 1), Code.OCCUPIED)
    w.link(w.me, "ON", o)
    for x in list(w.to["FACING"][o]):
        w.link(w.me, "FACING", x)
    w.enter(w.me, "SITTING")


def lie(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.close(o), Code.NOT_CLOSE)
    need(not w.is_(w.me, "LYING"), Code.LYING)
    need(w.has(o, "LIEABLE"), Code.NOT_AFFORDED)
    need(len(taken(w, o, options)) < BEDS.get(w.name[o], 1), Code.OCCUPIED)
    w.link(w.me, "ON", o)
    w.enter(w.me, "LYING")


def taken(w: World, o: int, options: Options) -> list[int]:
    """What takes room; a made bed's bedding is turned back."""
    made = options.made_bed and w.has(o, "LIEABLE")
    return [x for x in w.back["ON"][o] if not made or w.name[x] not in BEDDING]


def stand_up(w: World, *_: object) -> None:
    need(w.resting(), Code.NOT_SITTING_OR_LYING)
    w.states[w.me] -= {"SITTING", "LYING"}


def sleep(w: World, *_: object) -> None:
    need(w.resting(), Code.NOT_SITTING_OR_LYING)


def grab(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.has(o, "GRABBABLE") or w.name[o] in ("water", "child"), Code.NOT_AFFORDED)
    need(w.close(o), Code.NOT_CLOSE)
    need(not w.hidden(o), Code.INSIDE_CLOSED)
    hand = w.free_hand()
    need(hand, Code.NO_FREE_HAND)
    assert hand
    place = origin(w, o)
    room = w.room(w.me)
    w.isolate(o, "ON", "INSIDE", "CLOSE")
    w.link(w.me, "CLOSE", o)
    w.link(w.me, hand, o)
    if room is not None:
        w.link(o, "INSIDE", room)
    if place is not None:
        w.origins[o] = place
        w.link(w.me, "CLOSE", place[0])


def origin(w: World, o: int) -> tuple[int, str] | None:
    for relation in ("ON", "INSIDE", "CLOSE"):
        if w.release:
            ascending = sorted(w.to[relation][o])
            # The order in which a set made of the ascending ids iterates is what made the release.
            places = [x for x in set(ascending) if x not in w.rooms]
        else:
            places = sorted(x for x in w.to[relation][o] if x not in w.rooms and x != w.me)
            if relation == "CLOSE":
                places = [x for x in places if x in w.furniture]
        if places:
            return places[0], relation
    return None


def put(w: World, o: int, s: int, relation: str) -> None:
    w.let_go(o)
    w.link(w.me, "CLOSE", s)
    w.link(o, "CLOSE", s)
    w.link(o, relation, s)


def shut(w: World, x: int) -> bool:
    return w.has(x, "CAN_OPEN") and not w.is_(x, "OPEN")


def put_back(w: World, o: int, s: int | None, options: Options) -> None:
    assert s is not None
    need(o != s, Code.NOT_AFFORDED)
    need(o in w.held(), Code.NOT_HOLDING)
    need(w.close(s), Code.NOT_CLOSE)
    put(w, o, s, "ON")


def put_in(w: World, o: int, s: int | None, options: Options) -> None:
    assert s is not None
    need(o != s, Code.NOT_AFFORDED)
    need(o in w.held(), Code.NOT_HOLDING)
    need(w.close(s), Code.NOT_CLOSE)
    need(not shut(w, s), Code.IS_CLOSED)
    put(w, o, s, "INSIDE")


def put_obj_back(w: World, o: int, _: int | None, options: Options) -> None:
    need(o in w.origins, Code.NO_ORIGIN)
    place, relation = w.origins[o]
    need(o in w.held(), Code.NOT_HOLDING)
    need(w.close(place), Code.NOT_CLOSE)
    need(relation != "INSIDE" or not shut(w, place), Code.IS_CLOSED)
    put(w, o, place, relation)
    del w.origins[o]


def drop(w: World, o: int, _: int | None, options: Options) -> None:
    need(o in w.held(), Code.NOT_HOLDING)
    w.let_go(o)
    room = w.room(w.me)
    if room is not None:
        w.link(o, "INSIDE", room)
    w.origins.pop(o, None)


def can_open(w: World, o: int) -> bool:
    return w.has(o, "CAN_OPEN") or w.name[o] in ("desk", "window")


def open_(w: World, o: int, _: int | None, options: Options) -> None:
    need(can_open(w, o), Code.NOT_AFFORDED)
    need(w.close(o), Code.NOT_CLOSE)
    need(w.free_hand(), Code.NO_FREE_HAND)
    need(not w.is_(o, "OPEN"), Code.IS_OPEN)
    need(w.is_(o, "CLOSED"), Code.NOT_OPENABLE_STATE)
    need(not w.is_(o, "ON"), Code.IS_ON)
    w.enter(o, "OPEN")


def close(w: World, o: int, _: int | None, options: Options) -> None:
    need(can_open(w, o), Code.NOT_AFFORDED)
    need(w.close(o), Code.NOT_CLOSE)
    need(not w.is_(o, "CLOSED"), Code.IS_CLOSED)
    need(w.is_(o, "OPEN"), Code.NOT_OPENABLE_STATE)
    w.enter(o, "CLOSED")


def switch_on(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.has(o, "HAS_SWITCH"), Code.NOT_AFFORDED)
    need(w.close(o), Code.NOT_CLOSE)
    need(w.is_(o, "OFF"), Code.IS_ON)
    need(not w.is_(o, "PLUGGED_OUT"), Code.IS_UNPLUGGED)
    w.enter(o, "ON")


def switch_off(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.has(o, "HAS_SWITCH"), Code.NOT_AFFORDED)
    need(w.close(o), Code.NOT_CLOSE)
    need(w.is_(o, "ON"), Code.IS_OFF)
    w.enter(o, "OFF")


def plug(state: str, code: Code) -> Action:
    def act(w: World, o: int, _: int | None, options: Options) -> None:
        need(w.has(o, "HAS_PLUG"), Code.NOT_AFFORDED)
        need(w.close(o), Code.NOT_CLOSE)
        need(w.free_hand(), Code.NO_FREE_HAND)
        need(w.is_(o, OPPOSITE[state]), code)
        w.enter(o, state)

    return act


def turn_to(w: World, o: int, _: int | None, options: Options) -> None:
    for x in list(w.to["FACING"][w.me]):
        w.unlink(w.me, "FACING", x)
    w.link(w.me, "FACING", o)


def look_at(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.facing(o), Code.NOT_FACING)


def watch(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.has(o, "LOOKABLE"), Code.NOT_AFFORDED)
    need(w.room(o) == w.room(w.me), Code.NOT_IN_ROOM)
    if w.resting() and w.name[o] != "computer":
        need(o in w.to["FACING"][w.me], Code.NOT_FACING)
    need(w.facing(o), Code.NOT_FACING)
    if options.watch_needs_on:
        need(not w.has(o, "HAS_SWITCH") or w.is_(o, "ON"), Code.IS_OFF)


def read(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.has(o, "READABLE"), Code.NOT_AFFORDED)
    need(o in w.held(), Code.NOT_HOLDING)


def drink(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.has(o, "DRINKABLE", "RECIPIENT"), Code.NOT_AFFORDED)
    need(o in w.held(), Code.NOT_HOLDING)


def eat(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.close(o), Code.NOT_CLOSE)
    need(any(w.has(x, "EATABLE") for x in {o} | w.back["ON"][o]), Code.NOTHING_TO_EAT)


def cut(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.free_hand(), Code.NO_FREE_HAND)
    need(w.close(o), Code.NOT_CLOSE)
    need({"EATABLE", "CUTTABLE"} <= w.properties[o], Code.NOT_AFFORDED)
    need(any("knife" in w.name[x] for x in w.held()), Code.NOT_HOLDING)


def pour(w: World, o: int, s: int | None, options: Options) -> None:
    assert s is not None
    need(o != s, Code.NOT_AFFORDED)
    need(w.has(o, "POURABLE", "DRINKABLE"), Code.NOT_AFFORDED)
    need(w.has(s, "RECIPIENT") or w.name[s] in ("hands_both", "sponge", "face"), Code.NOT_AFFORDED)
    need(o in w.held(), Code.NOT_HOLDING)
    need(w.close(s), Code.NOT_CLOSE)
    w.link(o, "INSIDE", s)
    if w.name[o] == "water":
        w.let_go(o)


def type_(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.close(o), Code.NOT_CLOSE)
    need(w.has(o, "HAS_SWITCH") or w.name[o] == "keyboard", Code.NOT_AFFORDED)


def touch(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.close(o), Code.NOT_CLOSE)
    need(not w.hidden(o), Code.INSIDE_CLOSED)


def shift(anything: bool) -> Action:
    def act(w: World, o: int, _: int | None, options: Options) -> None:
        need(anything or w.has(o, "MOVABLE") or w.name[o] in ("chair", "curtain", "button"), Code.NOT_AFFORDED)
        need(w.close(o), Code.NOT_CLOSE)
        need(not w.hidden(o), Code.INSIDE_CLOSED)
        need(w.free_hand(), Code.NO_FREE_HAND)

    return act


def wipe(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.close(o), Code.NOT_CLOSE)
    need(w.held(), Code.NOT_HOLDING)
    w.enter(o, "CLEAN")


def wash(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.close(o), Code.NOT_CLOSE)
    w.enter(o, "CLEAN")


def squeeze(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.free_hand(), Code.NO_FREE_HAND)
    need(w.close(o), Code.NOT_CLOSE)
    need(w.has(o, "CLOTHES") or w.name[o] in SQUEEZABLE, Code.NOT_AFFORDED)


def put_on(w: World, o: int, _: int | None, options: Options) -> None:
    need(o in w.held(), Code.NOT_HOLDING)
    need(w.has(o, "CLOTHES"), Code.NOT_AFFORDED)
    w.link(o, "ON", w.me)
    w.let_go(o)


def put_off(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.me in w.to["ON"][o], Code.NOT_WORN)
    need(w.has(o, "CLOTHES"), Code.NOT_AFFORDED)
    w.unlink(o, "ON", w.me)


def greet(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.has(o, "PERSON"), Code.NOT_AFFORDED)


Action = Callable[[World, int, int | None, Options], None]

ACTIONS: dict[str, Callable[..., None]] = {
    "Walk": walk, "Run": walk, "Find": find, "Sit": sit, "Lie": lie, "StandUp": stand_up, "Sleep": sleep,
    "WakeUp": sleep, "Grab": grab, "PutBack": put_back, "PutIn": put_in, "PutObjBack": put_obj_back, "Drop": drop,
    "Release": drop, "Open": open_, "Close": close, "SwitchOn": switch_on, "SwitchOff": switch_off,
    "PlugIn": plug("PLUGGED_IN", Code.IS_PLUGGED), "PlugOut": plug("PLUGGED_OUT", Code.IS_UNPLUGGED),
    "TurnTo": turn_to, "LookAt": look_at, "PointAt": look_at, "Watch": watch, "Read": read, "Drink": drink, "Eat": eat,
    "Cut": cut, "Pour": pour, "Type": type_, "Touch": touch, "Push": shift(True), "Pull": shift(False),
    "Move": shift(False), "Wipe": wipe, "Wash": wash, "Rinse": wash, "Scrub": wash, "Squeeze": squeeze,
    "PutOn": put_on, "PutOff": put_off, "Greet": greet,
}  # fmt: skip


def step(w: World, instruction: Step, options: Options) -> Code | None:
    """Do one instruction in place; the failure's code when it can't be done, and then nothing has changed."""
    o, s = [*(ref.node for ref in instruction.objects), None, None][:2]
    try:
        ACTIONS[instruction.action](w, o, s, options)
    except RefusedError as refused:
        return refused.code
    return None


def run(w: World, program: Program, options: Options) -> Code | None:
    """Do a program in place."""
    for instruction in program.steps:
        failure = step(w, instruction, options)
        if failure is not None:
            return failure
    return None


def run_keeping_every_state(w: World, program: Program, options: Options) -> list[World]:
    """Do a program on copies, keeping each."""
    worlds = [w]
    for instruction in program.steps:
        w = w.copy()
        if step(w, instruction, options) is not None:
            break
        worlds.append(w)
    return worlds
