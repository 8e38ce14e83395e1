"""What a body does during an action: which hand goes where, where it looks, how the legs stand."""

from __future__ import annotations

from dataclasses import dataclass

from hearth.schemas.program import Step


@dataclass(frozen=True, slots=True)
class Gesture:
    """The picture of an action.

    Attributes:
        hand: where the acting hand goes: `object`, `second`, `mouth`, `chest`, `carry`, `wave`, or "" (stays).
        both: whether both hands go there.
        gaze: `object`, `second`, or "" (ahead).
        stride: how far the legs are apart.
        near: whether one must be within arm's reach of the object.
        about: which of the objects hands or eyes go to.
        rests: whether the object is a seat or bed that is taken.
        asleep: whether the eyes stay shut afterwards, until the next action.
    """

    hand: str = ""
    both: bool = False
    gaze: str = "object"
    stride: float = 0.0
    near: bool = False
    about: int = 0
    rests: bool = False
    asleep: bool = False


REACH = Gesture("object", near=True)
PUT = Gesture("object", near=True, about=1)
LOOK = Gesture()
MOUTH = Gesture("mouth")
STILL = Gesture(gaze="")
REST = Gesture(gaze="", rests=True)

GESTURES: dict[str, Gesture] = {
    "Walk": Gesture(stride=0.75),
    "Run": Gesture(stride=1.0),
    "Find": LOOK,
    "LookAt": LOOK,
    "TurnTo": LOOK,
    "Watch": LOOK,
    "PointAt": REACH,
    "Grab": Gesture("carry", near=True),
    "PutBack": PUT,
    "PutIn": PUT,
    "PutObjBack": REACH,
    "Drop": LOOK,
    "Release": LOOK,
    "Open": REACH,
    "Close": REACH,
    "SwitchOn": REACH,
    "SwitchOff": REACH,
    "PlugIn": REACH,
    "PlugOut": REACH,
    "Touch": REACH,
    "Push": Gesture("object", both=True, near=True),
    "Pull": Gesture("object", both=True, near=True),
    "Move": Gesture("object", both=True, near=True),
    "Wipe": REACH,
    "Wash": Gesture("object", both=True, near=True),
    "Rinse": Gesture("object", both=True, near=True),
    "Scrub": Gesture("object", both=True, near=True),
    "Squeeze": Gesture("object", near=True),
    "Cut": REACH,
    "Pour": Gesture("second", gaze="second", near=True, about=1),
    "Type": Gesture("object", both=True, near=True),
    "Read": Gesture("chest", both=True),
    "Drink": MOUTH,
    "Eat": MOUTH,
    "PutOn": Gesture("chest", both=True, gaze=""),
    "PutOff": Gesture("chest", both=True, gaze=""),
    "Greet": Gesture("wave"),
    "Sit": REST,
    "Lie": REST,
    "StandUp": STILL,
    "Sleep": Gesture(gaze="", asleep=True),
    "WakeUp": STILL,
}
"""The gesture of each action; those without an entry only look."""


def gesture_of(step: Step | None) -> Gesture:
    """The gesture of a step; one looks ahead where there is none."""
    return STILL if step is None else GESTURES.get(step.action, LOOK)
