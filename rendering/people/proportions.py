"""Proportions of a body: where its joints are when it stands in the rest pose."""

from functools import lru_cache
from typing import NamedTuple

from hearth.schemas.graph import Point

# Lengths as shares of the body's height (common anthropometric tables).
HIP, SHOULDER, NECK, HEAD = 0.525, 0.815, 0.85, 0.93
HIP_HALF, SHOULDER_HALF = 0.055, 0.115
THIGH, SHIN, ANKLE, FOOT = 0.245, 0.235, 0.045, 0.13
UPPER_ARM, FOREARM, HAND = 0.172, 0.155, 0.05
PALM = 0.008


class Proportions(NamedTuple):
    """Joints in the rest pose and lengths of bones, in metres; feet on y = 0, front +z, right +x.

    Attributes:
        height: of the body.
        pelvis: the point between the hip joints.
        spine, chest, neck, head: from the joint below, in this order, to each joint.
        shoulder, hip: from chest and pelvis to the right joint.
        thigh, shin, upper_arm, forearm: lengths.
        ankle: height of the ankle above the floor.
        ball, toe: distances on the floor from below the ankle to the ball of the foot and to the tip of the toes.
        hand: from the wrist to the middle of the hand.
        palm: from the middle of the hand to its palm.
        waist: half the width of the trunk at the belly.
    """

    height: float
    pelvis: float
    spine: Point
    chest: Point
    neck: Point
    head: Point
    shoulder: Point
    hip: float
    thigh: float
    shin: float
    upper_arm: float
    forearm: float
    ankle: float
    ball: float
    toe: float
    hand: float
    palm: float

    @property
    def arm(self) -> float:
        """From the shoulder to the middle of the hand."""
        return self.upper_arm + self.forearm + self.hand


@lru_cache(maxsize=64)
def standard(height: float) -> Proportions:
    """Return the proportions of the simple figure."""
    h = height
    return Proportions(
        h, HIP * h,
        (0.0, (SHOULDER - HIP) / 2 * h, 0.0), (0.0, (SHOULDER - HIP) / 2 * h, 0.0), (0.0, (NECK - SHOULDER) * h, 0.0),
        (0.0, (HEAD - NECK) * h, 0.0), (SHOULDER_HALF * h, -0.012 * h, 0.0), HIP_HALF * h,
        THIGH * h, SHIN * h, UPPER_ARM * h, FOREARM * h, ANKLE * h, 0.75 * FOOT * h, FOOT * h, HAND * h, PALM * h,
    )  # fmt: skip
