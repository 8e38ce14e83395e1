"""Actions on things in their places in the plain engine: changes of states, and actions that change nothing."""

from __future__ import annotations

from collections.abc import Callable

from hearth.schemas.failures import Code
from oracles.world import OPPOSITE, Options, World, need

SQUEEZABLE = {
    "cleaning_solution", "tooth_paste", "shampoo", "food_peanut_butter", "dish_soap", "soap", "towel", "rag", "paper",
    "sponge", "food_lemon", "check",
}  # fmt: skip

Action = Callable[[World, int, int | None, Options], None]


def can_open(w: World, o: int) -> bool:
    return w.has(o, "CAN_OPEN") or w.name[o] in ("desk", "window")


def open_(w: World, o: int, _: int | None, options: Options) -> None:
    need(can_open(w, o), Code.NOT_AFFORDED)
    need(w.close(o, options), Code.NOT_CLOSE)
    need(w.free_hand(), Code.NO_FREE_HAND)
    need(not w.is_(o, "OPEN"), Code.IS_OPEN)
    need(w.is_(o, "CLOSED"), Code.NOT_OPENABLE_STATE)
    need(not w.is_(o, "ON"), Code.IS_ON)
    w.enter(o, "OPEN")


def close(w: World, o: int, _: int | None, options: Options) -> None:
    need(can_open(w, o), Code.NOT_AFFORDED)
    need(w.close(o, options), Code.NOT_CLOSE)
    need(not w.is_(o, "CLOSED"), Code.IS_CLOSED)
    need(w.is_(o, "OPEN"), Code.NOT_OPENABLE_STATE)
    w.enter(o, "CLOSED")


def switch_on(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.has(o, "HAS_SWITCH"), Code.NOT_AFFORDED)
    need(w.close(o, options), Code.NOT_CLOSE)
    need(w.is_(o, "OFF"), Code.IS_ON)
    need(not w.is_(o, "PLUGGED_OUT"), Code.IS_UNPLUGGED)
    w.enter(o, "ON")


def switch_off(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.has(o, "HAS_SWITCH"), Code.NOT_AFFORDED)
    need(w.close(o, options), Code.NOT_CLOSE)
    need(w.is_(o, "ON"), Code.IS_OFF)
    w.enter(o, "OFF")


def plug(state: str, code: Code) -> Action:
    def act(w: World, o: int, _: int | None, options: Options) -> None:
        need(w.has(o, "HAS_PLUG"), Code.NOT_AFFORDED)
        need(w.close(o, options), Code.NOT_CLOSE)
        need(w.free_hand(), Code.NO_FREE_HAND)
        need(w.is_(o, OPPOSITE[state]), code)
        w.enter(o, state)

    return act


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
    need(w.close(o, options), Code.NOT_CLOSE)
    need(any(w.has(x, "EATABLE") for x in {o} | w.back["ON"][o]), Code.NOTHING_TO_EAT)


def cut(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.free_hand(), Code.NO_FREE_HAND)
    need(w.close(o, options), Code.NOT_CLOSE)
    need({"EATABLE", "CUTTABLE"} <= w.properties[o], Code.NOT_AFFORDED)
    need(any("knife" in w.name[x] for x in w.held()), Code.NOT_HOLDING)


def type_(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.close(o, options), Code.NOT_CLOSE)
    need(w.has(o, "HAS_SWITCH") or w.name[o] == "keyboard", Code.NOT_AFFORDED)


def touch(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.close(o, options), Code.NOT_CLOSE)
    need(not w.hidden(o), Code.INSIDE_CLOSED)


def shift(anything: bool) -> Action:
    def act(w: World, o: int, _: int | None, options: Options) -> None:
        need(anything or w.has(o, "MOVABLE") or w.name[o] in ("chair", "curtain", "button"), Code.NOT_AFFORDED)
        need(w.close(o, options), Code.NOT_CLOSE)
        need(not w.hidden(o), Code.INSIDE_CLOSED)
        need(w.free_hand(), Code.NO_FREE_HAND)

    return act


def wipe(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.close(o, options), Code.NOT_CLOSE)
    need(w.held(), Code.NOT_HOLDING)
    w.enter(o, "CLEAN")


def wash(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.close(o, options), Code.NOT_CLOSE)
    w.enter(o, "CLEAN")


def squeeze(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.free_hand(), Code.NO_FREE_HAND)
    need(w.close(o, options), Code.NOT_CLOSE)
    need(w.has(o, "CLOTHES") or w.name[o] in SQUEEZABLE, Code.NOT_AFFORDED)


def greet(w: World, o: int, _: int | None, options: Options) -> None:
    need(w.has(o, "PERSON"), Code.NOT_AFFORDED)
