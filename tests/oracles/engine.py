"""The table of actions read straightforwardly, with dicts of sets: slow, plain, and independent of the engine.

It is what the engine is measured and checked against. One character; nothing here is shared with `hearth.simulation`.
The actions themselves are in `locomotion.py`, `hands.py` and `uses.py`.
"""

from __future__ import annotations

from collections.abc import Callable

from hearth.schemas.failures import Code
from hearth.schemas.program import Program, Step
from oracles.hands import drop, grab, pour, put_back, put_in, put_obj_back, put_off, put_on
from oracles.locomotion import find, lie, sit, sleep, stand_up, turn_to, walk
from oracles.uses import (
    close,
    cut,
    drink,
    eat,
    greet,
    look_at,
    open_,
    plug,
    read,
    shift,
    squeeze,
    switch_off,
    switch_on,
    touch,
    type_,
    wash,
    watch,
    wipe,
)
from oracles.world import Options, RefusedError, World

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
