"""Joints of a body pose: forward kinematics, and two-bone inverse kinematics."""

from dataclasses import dataclass
from math import acos, cos, radians, sin, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.schemas.graph import Point

Vector = NDArray[np.floating[Any]]
Joints = dict[str, Vector]

POSTURES = ("standing", "sitting", "lying")

# Lengths as shares of the body's height (common anthropometric tables).
HIP, SHOULDER, NECK, HEAD = 0.525, 0.815, 0.85, 0.93
HIP_HALF, SHOULDER_HALF = 0.055, 0.115
THIGH, SHIN, ANKLE, FOOT = 0.245, 0.235, 0.045, 0.13
UPPER_ARM, FOREARM, HAND = 0.172, 0.155, 0.05
PELVIS_ON_SEAT = 0.055
"""Metres from a seat to the hip joints of a sitting body."""


@dataclass(frozen=True, slots=True)
class BodyPose:
    """Posture, hands and gaze in the body's frame: feet at the origin (sitting: hips above it), front +z, right +x.

    Attributes:
        posture: one of `POSTURES`.
        seat: height of the seat or bed, metres.
        stride: -1 to 1, distance of the right leg in front of the left.
        swing: -1 to 1, height of the right (below 0: left) foot while it swings forward; 0 lifts the hind foot.
        right, left: targets of the hands; None lets the arm hang.
        gaze: point to look at; None looks ahead.
        asleep: whether the eyes are closed.
    """

    posture: str = "standing"
    seat: float = 0.0
    stride: float = 0.0
    swing: float = 0.0
    right: Point | None = None
    left: Point | None = None
    gaze: Point | None = None
    asleep: bool = False


def joints(body_pose: BodyPose, height: float) -> Joints:
    """Positions of the joints, in metres: pelvis, spine, neck, head; hip, knee, ankle, toe, shoulder, elbow, wrist,
    hand of `r` and `l`; `face` is a point in front of the head, in the direction of the gaze.
    """
    if body_pose.posture == "lying":
        return _lying(body_pose, height)
    drop, lean = _bend(body_pose, height)
    found = _legs(body_pose, height, drop)
    _torso(found, height, lean)
    for side, sign in (("r", 1.0), ("l", -1.0)):
        target = body_pose.right if side == "r" else body_pose.left
        _arm(found, side, sign, height, None if target is None else np.array(target, np.float64), body_pose)
    _head(found, height, body_pose.gaze)
    return found


def _bend(body_pose: BodyPose, height: float) -> tuple[float, float]:
    """(metres by which the hips sink, degrees by which the back leans): the least with which the hands reach."""
    targets = [np.array(t) for t in (body_pose.right, body_pose.left) if t is not None]
    base = -4.0 if body_pose.posture == "sitting" else 0.0
    if not targets:
        return 0.0, base
    reach = (UPPER_ARM + FOREARM + HAND) * height * 0.98
    drops = (0.0,) if body_pose.posture == "sitting" else (0.0, 0.12, 0.25, 0.4)
    best = (1e9, 0.0, base)
    for drop in drops:
        for lean in range(0, 75, 6):
            hips = _hips(body_pose, height, drop)
            shoulder = hips + _leaning(lean) @ np.array((0, (SHOULDER - HIP) * height, 0))
            short = max(max(float(np.linalg.norm(t - shoulder)) - reach, 0.0) for t in targets)
            cost = short * 40 + drop * 1.6 + lean / 60
            best = min(best, (cost, drop, float(lean) or base))
    return best[1], best[2]


def _leaning(degrees: float) -> Vector:
    c, s = cos(radians(degrees)), sin(radians(degrees))
    return np.array(((1, 0, 0), (0, c, -s), (0, s, c)))


def _hips(body_pose: BodyPose, height: float, drop: float) -> Vector:
    if body_pose.posture == "sitting":
        return np.array((0.0, body_pose.seat + PELVIS_ON_SEAT, 0.0))
    return np.array((0.0, HIP * height - drop - 0.03 * abs(body_pose.stride) * height, -drop * 0.35))


def _legs(body_pose: BodyPose, height: float, drop: float) -> Joints:
    found: Joints = {"pelvis": _hips(body_pose, height, drop)}
    thigh, shin, ankle = THIGH * height, SHIN * height, ANKLE * height
    for side, sign in (("r", 1.0), ("l", -1.0)):
        hip = found["pelvis"] + (sign * HIP_HALF * height, 0, 0)
        if body_pose.posture == "sitting":
            forward = min(thigh + 0.03, sqrt(max((thigh + shin) ** 2 - (hip[1] - ankle) ** 2, 0.02)))
            foot = np.array((sign * 0.075 * height, ankle, forward))
        else:
            step = sign * body_pose.stride * 0.16 * height
            lift = 0.05 * height * max(sign * body_pose.swing if body_pose.swing else -sign * body_pose.stride, 0.0)
            foot = np.array((sign * HIP_HALF * height * 0.95, ankle + lift, step))
        knee, end = two_bones(hip, foot, thigh, shin, np.array((sign * 0.08, 0.25, 1.0)))
        found |= {f"hip_{side}": hip, f"knee_{side}": knee, f"ankle_{side}": end}
        down = -0.35 if end[1] > ankle * 1.6 else 0.0
        found[f"toe_{side}"] = end + np.array((sign * 0.15, down, 1.0)) * FOOT * height - (0, ankle * 0.55, 0)
    return found


def _torso(found: Joints, height: float, lean: float) -> None:
    turn = _leaning(lean)
    pelvis = found["pelvis"]
    # The back bends: the lower half leans by two thirds of the upper half's angle.
    spine = pelvis + _leaning(lean * 0.67) @ np.array((0, (SHOULDER - HIP) * 0.5 * height, 0))
    found["spine"] = spine
    found["chest"] = spine + turn @ np.array((0, (SHOULDER - HIP) * 0.5 * height, 0))
    found["neck"] = found["chest"] + _leaning(lean * 0.7) @ np.array((0, (NECK - SHOULDER) * height, 0.0))
    for side, sign in (("r", 1.0), ("l", -1.0)):
        found[f"shoulder_{side}"] = found["chest"] + (sign * SHOULDER_HALF * height, -0.012 * height, 0)


def _arm(found: Joints, side: str, sign: float, height: float, target: Vector | None, body_pose: BodyPose) -> None:
    shoulder = found[f"shoulder_{side}"]
    upper, fore = UPPER_ARM * height, FOREARM * height
    if target is None:
        target = _relaxed_hand(found, side, sign, height, body_pose)
    wrist_goal = target - _unit(target - shoulder) * HAND * height
    elbow, wrist = two_bones(shoulder, wrist_goal, upper, fore, np.array((sign * 0.45, -1.0, -0.55)))
    found |= {
        f"elbow_{side}": elbow,
        f"wrist_{side}": wrist,
        f"hand_{side}": wrist + _unit(target - wrist) * HAND * height,
    }


def _relaxed_hand(found: Joints, side: str, sign: float, height: float, body_pose: BodyPose) -> Vector:
    shoulder = found[f"shoulder_{side}"]
    if body_pose.posture == "sitting":
        knee, hip = found[f"knee_{side}"], found[f"hip_{side}"]
        on_thigh: Vector = hip + (knee - hip) * 0.62 + np.array((0, 0.075, 0))
        return on_thigh
    swing = -sign * body_pose.stride * 0.13 * height
    hanging: Vector = shoulder + np.array(
        (sign * 0.035 * height, -(UPPER_ARM + FOREARM + HAND) * height * 0.97, 0.02 * height + swing)
    )
    return hanging


def _head(found: Joints, height: float, gaze: Point | None) -> None:
    ahead = np.array((0.0, 0.0, 1.0))
    up = _unit(found["neck"] - found["chest"])
    center = found["neck"] + (HEAD - NECK) * height * _unit(up + np.array((0, 0.6, 0)))
    if gaze is not None:
        way = _unit(np.array(gaze) - center)
        # Turning and nodding of the head are limited.
        flat = max(float(np.hypot(way[0], way[2])), 1e-6)
        side = float(np.clip(np.arctan2(way[0], way[2]), -1.15, 1.15))
        nod = float(np.clip(np.arctan2(way[1], flat), -0.75, 0.6))
        ahead = np.array((sin(side) * cos(nod), sin(nod), cos(side) * cos(nod)))
    found["head"], found["face"] = center, center + ahead * 0.1


def _lying(body_pose: BodyPose, height: float) -> Joints:
    """Joints lying on the back in the middle of the bed, head towards -z."""
    rest = BodyPose(right=body_pose.right, left=body_pose.left)
    found = joints(rest, height)
    turn = np.array(((1, 0, 0), (0, 0, 1), (0, -1, 0)), np.float64)
    offset = np.array((0, body_pose.seat + 0.12, height * 0.5))
    return {name: turn @ point + offset for name, point in found.items()}


def two_bones(root: Vector, goal: Vector, first: float, second: float, pole: Vector) -> tuple[Vector, Vector]:
    """(middle joint, end) of a chain of two bones from `root` towards `goal`; the middle bends towards `pole`.

    A goal out of reach is approached as far as the bones allow.
    """
    way = goal - root
    length = float(np.linalg.norm(way))
    along = way / length if length > 1e-9 else np.array((0.0, -1.0, 0.0))
    reach = min(max(length, abs(first - second) + 1e-4), (first + second) * 0.999)
    side = pole - along * float(pole @ along)
    bend = _unit(side) if np.linalg.norm(side) > 1e-9 else np.array((0.0, 0.0, 1.0))
    angle = acos(min(max((first * first + reach * reach - second * second) / (2 * first * reach), -1.0), 1.0))
    middle = root + along * first * cos(angle) + bend * first * sin(angle)
    return middle, root + along * reach


def _unit(vector: Vector) -> Vector:
    return vector / max(float(np.linalg.norm(vector)), 1e-9)
