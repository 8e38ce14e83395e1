"""Body poses: posture, feet, hands and gaze."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

from hearth.schemas.graph import Point

POSTURES = ("standing", "sitting", "lying")


class Foot(NamedTuple):
    """A foot in the body's frame.

    Attributes:
        x, z: the point below its ankle when it is flat, metres.
        lift: of its sole above the floor, metres.
        yaw: degrees from +z towards +x.
        pitch: degrees; above 0 its heel is raised and its toes stay, below 0 its toes are raised.
    """

    x: float
    z: float
    lift: float = 0.0
    yaw: float = 0.0
    pitch: float = 0.0


class Held(NamedTuple):
    """The difference of a held thing's pose from its usual pose in the hand.

    Attributes:
        turn: degrees about y by which it is turned further.
        pitch, roll: degrees by which its top is tilted backwards, towards the person, and to the right.
        gap: from the palm to its grip point, in the body's frame, metres.
        stream: where what is poured from it ends, in the body's frame; None pours nothing.
        opens: whether it is held open.
    """

    turn: float = 0.0
    pitch: float = 0.0
    roll: float = 0.0
    gap: Point = (0.0, 0.0, 0.0)
    stream: Point | None = None
    opens: bool = False


AS_USUAL = Held()


class Hand(NamedTuple):
    """A hand's form and direction.

    Attributes:
        grip: one of `GRIPS` (grips.py), the form of the fingers.
        palm: direction in which the palm looks; None follows the forearm.
        swivel: degrees by which the elbow is turned outwards about the line from shoulder to wrist.
        held: how it holds what it holds.
    """

    grip: str = "relaxed"
    palm: Point | None = None
    swivel: float = 0.0
    held: Held = AS_USUAL


class Between(NamedTuple):
    """A pose that another is changing from.

    Attributes:
        pose: the former pose.
        offset, turn: position and yaw of the former body's frame in the present one's; metres, degrees.
        share: of the present pose, 0 to 1.
    """

    pose: BodyPose
    offset: Point
    turn: float
    share: float


HANGING = Hand()


@dataclass(frozen=True, slots=True)
class BodyPose:
    """Posture, hands and gaze in the body's frame: feet at the origin (sitting: hips above it), front +z, right +x.

    Attributes:
        posture: one of `POSTURES`.
        seat: height of the seat or bed, metres.
        stride: -1 to 1, distance of the right leg in front of the left; arms swing against it.
        right, left: targets of the palms; None lets the arm hang.
        gaze: point to look at; None looks ahead.
        asleep: whether the eyes are closed.
        feet: the right and the left foot; None has them side by side, or `stride` apart.
        right_hand, left_hand: form and direction of the hands.
        effort: 0 to 1, how far the body stoops; None is the least with which the hands reach.
        between: the pose that this one is changing from; None if it has.
        tucked: 0 to 1, how far the right and the left arm are drawn in before the body, for want of room.
        sink: metres by which the hips are lower, so that they do not drop at once where a step needs it.
    """

    posture: str = "standing"
    seat: float = 0.0
    stride: float = 0.0
    right: Point | None = None
    left: Point | None = None
    gaze: Point | None = None
    asleep: bool = False
    feet: tuple[Foot, Foot] | None = None
    right_hand: Hand = HANGING
    left_hand: Hand = HANGING
    effort: float | None = None
    between: Between | None = None
    tucked: tuple[float, float] = (0.0, 0.0)
    sink: float = 0.0

    def target(self, side: str) -> Point | None:
        """Return the target of the `r` or `l` palm."""
        return self.right if side == "r" else self.left

    def hand(self, side: str) -> Hand:
        """Return the `r` or `l` hand."""
        return self.right_hand if side == "r" else self.left_hand

    def tuck(self, side: str) -> float:
        """Return how far the `r` or `l` arm is drawn in."""
        return self.tucked[side == "l"]


STILL = BodyPose()


def drawn_in(pose: BodyPose, tucked: tuple[float, float]) -> BodyPose:
    """Return a pose with arms drawn in, also those that carry something with one hand."""
    right, left = (
        _nearer(pose.target(side), pose.hand(side), tuck) for side, tuck in zip("rl", tucked, strict=True)
    )  # fmt: skip
    return replace(pose, right=right, left=left, tucked=tucked)


def _nearer(target: Point | None, hand: Hand, tuck: float) -> Point | None:
    if target is None or not tuck or hand.grip == "two hands":
        return target
    return target[0] * (1 - 0.6 * tuck), target[1], target[2] * (1 - 0.3 * tuck)
