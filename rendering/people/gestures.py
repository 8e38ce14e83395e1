"""Gestures of actions: targets of hands and gaze, and stride."""

from dataclasses import dataclass

from hearth.schemas.program import Step
from hearth.schemas.yaml_extent import packaged


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


LOOK = Gesture()
STILL = Gesture(gaze="")

GESTURES: dict[str, Gesture] = {
    action: Gesture(**fields) for action, fields in packaged("hearth.rendering.people", "gestures.yaml").items()
}
"""The gesture of each action; an action without an entry is a gaze at its object."""


def gesture_of(step: Step | None) -> Gesture:
    """The gesture of a step; None gives a gaze ahead."""
    return STILL if step is None else GESTURES.get(step.action, LOOK)
