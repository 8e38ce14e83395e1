"""Gestures of actions: targets of hands and gaze, and stride."""

from dataclasses import dataclass

from hearth.schemas.program import Step


@dataclass(frozen=True, slots=True)
class Gesture:
    """The gesture of an action.

    Attributes:
        hand: target of the acting hand: `object`, `second`, `mouth`, `chest`, `carry`, `wave`, or "" (none).
        both: whether both hands go to the target.
        gaze: `object`, `second`, or "" (ahead).
        stride: as in `BodyPose`.
        near: whether the actor must be within arm's reach of the object.
        about: index of the object that hands or gaze go to.
        rests: whether the object is a seat or bed to sit or lie on.
        asleep: whether the eyes stay closed until the next action.
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
"""The gesture of each action; an action without an entry is a gaze at its object."""


def gesture_of(step: Step | None) -> Gesture:
    """The gesture of a step; None gives a gaze ahead."""
    return STILL if step is None else GESTURES.get(step.action, LOOK)
