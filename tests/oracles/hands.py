"""Actions of hands in the plain engine: taking, putting somewhere, pouring and wearing."""

from __future__ import annotations

from hearth.schemas.failures import Code
from oracles.world import Options, World, need


def grab(w: World, o: int, _: int | None, options: Options) -> None:
    need(not options.one_grip or o not in w.held(), Code.HELD_ALREADY)
    need(w.has(o, "GRABBABLE") or w.name[o] in ("water", "child"), Code.NOT_AFFORDED)
    need(w.close(o, options), Code.NOT_CLOSE)
    need(not w.hidden(o), Code.INSIDE_CLOSED)
    hand = w.free_hand()
    need(hand, Code.NO_FREE_HAND)
    assert hand
    if options.leaves_seat and o in w.to["ON"][w.me]:
        need(not w.is_(w.me, "SITTING"), Code.SITTING)
        need(not w.is_(w.me, "LYING"), Code.LYING)
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
    need(w.close(s, options), Code.NOT_CLOSE)
    put(w, o, s, "ON")


def put_in(w: World, o: int, s: int | None, options: Options) -> None:
    assert s is not None
    need(o != s, Code.NOT_AFFORDED)
    need(o in w.held(), Code.NOT_HOLDING)
    need(w.close(s, options), Code.NOT_CLOSE)
    need(not shut(w, s), Code.IS_CLOSED)
    put(w, o, s, "INSIDE")


def put_obj_back(w: World, o: int, _: int | None, options: Options) -> None:
    need(o in w.origins, Code.NO_ORIGIN)
    place, relation = w.origins[o]
    need(o in w.held(), Code.NOT_HOLDING)
    need(w.close(place, options), Code.NOT_CLOSE)
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


def pour(w: World, o: int, s: int | None, options: Options) -> None:
    assert s is not None
    need(o != s, Code.NOT_AFFORDED)
    need(w.has(o, "POURABLE", "DRINKABLE"), Code.NOT_AFFORDED)
    need(w.has(s, "RECIPIENT") or w.name[s] in ("hands_both", "sponge", "face"), Code.NOT_AFFORDED)
    need(o in w.held(), Code.NOT_HOLDING)
    need(w.close(s, options), Code.NOT_CLOSE)
    w.link(o, "INSIDE", s)
    if w.name[o] == "water":
        w.let_go(o)


def put_on(w: World, o: int, _: int | None, options: Options) -> None:
    need(o in w.held(), Code.NOT_HOLDING)
    need(w.has(o, "CLOTHES"), Code.NOT_AFFORDED)
    w.link(o, "ON", w.me)
    w.let_go(o)


def put_off(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.me in w.to["ON"][o], Code.NOT_WORN)
    need(w.has(o, "CLOTHES"), Code.NOT_AFFORDED)
    w.unlink(o, "ON", w.me)
