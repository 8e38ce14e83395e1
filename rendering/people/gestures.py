"""Gestures of actions: targets of hands and gaze, and stride."""

from dataclasses import dataclass

from hearth.schemas.program import Step
from hearth.schemas.yaml_limits import packaged


@dataclass(frozen=True, slots=True)
class Gesture:
    """The gesture of an action.

    Attributes:
        hand: what the hands do (step_hands_and_gaze.py): `object`, `put`, `pour`, `mouth`, `type`, `read`, `rub`,
            `push`, `wear`, `wave`, `free`, or "" (nothing but carrying).
        grip: form of the hand that touches an object, of `GRIPS`.
        free: the row of free_gestures.yaml.
        enters: whether the actor ends in the middle of the object.
        motion: of the hands while they act: `rub`, `keys`, `beat`, `shake`, `circle`, of the body `hop`, `sway`, or ""
            (none).
        seconds: for which they act.
        gaze: `object`, `second`, or "" (ahead).
        stride: above 0 if the actor walks there.
        near: whether the actor must be within arm's reach of the object.
        about: index of the object that hands or gaze go to.
        rests: whether the object is a seat or bed to sit or lie on.
        asleep: whether the eyes stay closed until the next action.
        tools: classes and kinds of the tools that act if a hand holds them.
        moves: metres by which the object slides away from the actor; below 0 towards it.
        swings: whether doors or drawers of the object swing.
        into: whether hands go into an open container, that of the object or the object itself.
    """

    hand: str = ""
    gaze: str = "object"
    stride: float = 0.0
    near: bool = False
    about: int = 0
    rests: bool = False
    asleep: bool = False
    grip: str = ""
    motion: str = ""
    seconds: float = 0.0
    tools: tuple[str, ...] = ()
    moves: float = 0.0
    swings: bool = False
    into: bool = False
    free: str = ""
    enters: bool = False


LOOK = Gesture()
STILL = Gesture(gaze="")

GESTURES: dict[str, Gesture] = {
    action: Gesture(**{**fields, "tools": tuple(fields.get("tools", ()))})
    for action, fields in packaged("hearth.rendering.people", "gestures.yaml").items()
}
"""The gesture of each action; an action without an entry is a gaze at its object."""


def gesture_of(step: Step | None) -> Gesture:
    """Return the gesture of a step; None gives a gaze ahead."""
    return STILL if step is None else GESTURES.get(step.action, LOOK)
