"""A person's joints for a posture and what the hands do: forward kinematics, and two-bone inverse kinematics."""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, cos, radians, sin, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.schemas.graph import Point

Vector = NDArray[np.floating[Any]]
Joints = dict[str, Vector]

POSTURES = ("standing", "sitting", "lying")

# Lengths as shares of the body's height (after common anthropometric tables).
HIP, SHOULDER, NECK, HEAD = 0.525, 0.815, 0.85, 0.93
HIP_HALF, SHOULDER_HALF = 0.055, 0.115
THIGH, SHIN, ANKLE, FOOT = 0.245, 0.235, 0.045, 0.13
UPPER_ARM, FOREARM, HAND = 0.172, 0.155, 0.05
PELVIS_ON_SEAT = 0.055
"""From a seat to the hip joints of who sits on it."""


@dataclass(frozen=True, slots=True)
class Stance:
    """What a body does, in its own frame: on its feet at the origin (sitting: hips above it), facing +z, right is +x.

    Attributes:
        posture: one of `POSTURES`.
        seat: height of what it sits or lies on, metres.
        stride: -1 to 1, how far the right leg is before the left one.
        swing: -1 to 1, how high the right (below 0: left) foot is while it swings forward; 0 lifts the hind foot.
        right, left: where the hands are to be; None lets the arm hang.
        gaze: what it looks at; None looks ahead.
        asleep: whether the eyes are shut.
    """

    posture: str = "standing"
    seat: float = 0.0
    stride: float = 0.0
    swing: float = 0.0
    right: Point | None = None
    left: Point | None = None
    gaze: Point | None = None
    asleep: bool = False


def joints(stance: Stance, height: float) -> Joints:
    """Positions of the joints, in metres: pelvis, spine, neck, head; hip, knee, ankle, toe, shoulder, elbow, wrist,
    hand of `r` and `l`; `face` is a point before the head that says where it looks.
    """
    if stance.posture == "lying":
        return _laid(stance, height)
    drop, lean = _bend(stance, height)
    found = _legs(stance, height, drop)
    _torso(found, height, lean)
    for side, sign in (("r", 1.0), ("l", -1.0)):
        target = stance.right if side == "r" else stance.left
        _arm(found, side, sign, height, None if target is None else np.array(target, np.float64), stance)
    _head(found, height, stance.gaze)
    return found


def _bend(stance: Stance, height: float) -> tuple[float, float]:
    """(metres the hips sink, degrees the back leans), the least of both with which the hands reach their targets."""
    targets = [np.array(t) for t in (stance.right, stance.left) if t is not None]
    base = -4.0 if stance.posture == "sitting" else 0.0
    if not targets:
        return 0.0, base
    reach = (UPPER_ARM + FOREARM + HAND) * height * 0.98
    drops = (0.0,) if stance.posture == "sitting" else (0.0, 0.12, 0.25, 0.4)
    best = (1e9, 0.0, base)
    for drop in drops:
        for lean in range(0, 75, 6):
            hips = _hips(stance, height, drop)
            shoulder = hips + _leaning(lean) @ np.array((0, (SHOULDER - HIP) * height, 0))
            short = max(max(float(np.linalg.norm(t - shoulder)) - reach, 0.0) for t in targets)
            cost = short * 40 + drop * 1.6 + lean / 60
            best = min(best, (cost, drop, float(lean) or base))
    return best[1], best[2]


def _leaning(degrees: float) -> Vector:
    c, s = cos(radians(degrees)), sin(radians(degrees))
    return np.array(((1, 0, 0), (0, c, -s), (0, s, c)))


def _hips(stance: Stance, height: float, drop: float) -> Vector:
    if stance.posture == "sitting":
        return np.array((0.0, stance.seat + PELVIS_ON_SEAT, 0.0))
    return np.array((0.0, HIP * height - drop - 0.03 * abs(stance.stride) * height, -drop * 0.35))


def _legs(stance: Stance, height: float, drop: float) -> Joints:
    found: Joints = {"pelvis": _hips(stance, height, drop)}
    thigh, shin, ankle = THIGH * height, SHIN * height, ANKLE * height
    for side, sign in (("r", 1.0), ("l", -1.0)):
        hip = found["pelvis"] + (sign * HIP_HALF * height, 0, 0)
        if stance.posture == "sitting":
            forward = min(thigh + 0.03, sqrt(max((thigh + shin) ** 2 - (hip[1] - ankle) ** 2, 0.02)))
            foot = np.array((sign * 0.075 * height, ankle, forward))
        else:
            step = sign * stance.stride * 0.16 * height
            lift = 0.05 * height * max(sign * stance.swing if stance.swing else -sign * stance.stride, 0.0)
            foot = np.array((sign * HIP_HALF * height * 0.95, ankle + lift, step))
        knee, end = two_bones(hip, foot, thigh, shin, np.array((sign * 0.08, 0.25, 1.0)))
        found |= {f"hip_{side}": hip, f"knee_{side}": knee, f"ankle_{side}": end}
        down = -0.35 if end[1] > ankle * 1.6 else 0.0
        found[f"toe_{side}"] = end + np.array((sign * 0.15, down, 1.0)) * FOOT * height - (0, ankle * 0.55, 0)
    return found


def _torso(found: Joints, height: float, lean: float) -> None:
    turn = _leaning(lean)
    pelvis = found["pelvis"]
    # The back bends: the lower half leans by two thirds of what the upper half does.
    spine = pelvis + _leaning(lean * 0.67) @ np.array((0, (SHOULDER - HIP) * 0.5 * height, 0))
    found["spine"] = spine
    found["chest"] = spine + turn @ np.array((0, (SHOULDER - HIP) * 0.5 * height, 0))
    found["neck"] = found["chest"] + _leaning(lean * 0.7) @ np.array((0, (NECK - SHOULDER) * height, 0.0))
    for side, sign in (("r", 1.0), ("l", -1.0)):
        found[f"shoulder_{side}"] = found["chest"] + (sign * SHOULDER_HALF * height, -0.012 * height, 0)


def _arm(found: Joints, side: str, sign: float, height: float, target: Vector | None, stance: Stance) -> None:
    shoulder = found[f"shoulder_{side}"]
    upper, fore = UPPER_ARM * height, FOREARM * height
    if target is None:
        target = _at_rest(found, side, sign, height, stance)
    wrist_goal = target - _unit(target - shoulder) * HAND * height
    elbow, wrist = two_bones(shoulder, wrist_goal, upper, fore, np.array((sign * 0.45, -1.0, -0.55)))
    found |= {
        f"elbow_{side}": elbow,
        f"wrist_{side}": wrist,
        f"hand_{side}": wrist + _unit(target - wrist) * HAND * height,
    }


def _at_rest(found: Joints, side: str, sign: float, height: float, stance: Stance) -> Vector:
    shoulder = found[f"shoulder_{side}"]
    if stance.posture == "sitting":
        knee, hip = found[f"knee_{side}"], found[f"hip_{side}"]
        on_thigh: Vector = hip + (knee - hip) * 0.62 + np.array((0, 0.075, 0))
        return on_thigh
    swing = -sign * stance.stride * 0.13 * height
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
        # A head turns and nods only so far.
        flat = max(float(np.hypot(way[0], way[2])), 1e-6)
        side = float(np.clip(np.arctan2(way[0], way[2]), -1.15, 1.15))
        nod = float(np.clip(np.arctan2(way[1], flat), -0.75, 0.6))
        ahead = np.array((sin(side) * cos(nod), sin(nod), cos(side) * cos(nod)))
    found["head"], found["face"] = center, center + ahead * 0.1


def _laid(stance: Stance, height: float) -> Joints:
    """On the back, the head towards -z, in the middle of what it lies on."""
    rest = Stance(right=stance.right, left=stance.left)
    found = joints(rest, height)
    turn = np.array(((1, 0, 0), (0, 0, 1), (0, -1, 0)), np.float64)
    offset = np.array((0, stance.seat + 0.12, height * 0.5))
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
