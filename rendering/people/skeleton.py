"""Joints of a body pose: forward kinematics, and two-bone inverse kinematics."""

from dataclasses import replace
from functools import lru_cache
from math import acos, cos, hypot, radians, sin, sqrt

import numpy as np

from hearth.rendering.people.body_pose import BodyPose, Foot
from hearth.rendering.people.proportions import Proportions
from hearth.rendering.people.rotations import Vector, about, leaning, unit, yawed
from hearth.schemas.graph import Point

Joints = dict[str, Vector]

PELVIS_ON_SEAT = 0.05
"""Metres from a seat to the hip joints of a sitting body, for a height of one metre."""

LYING = np.array(((1, 0, 0), (0, 0, 1), (0, -1, 0)), np.float64)
"""The rotation of a standing body onto its back, head towards -z."""

MATTRESS = 0.06
"""Metres from a mattress to the hip joints of a lying body, for a height of one metre."""

STEP = 0.16
"""Distance of each foot from the hips at full stride, as a share of the height."""

NOD, TURN = (-0.75, 0.6), 1.15
"""Limits of nodding and turning the head, radians."""


def joints(body_pose: BodyPose, body: Proportions) -> Joints:
    """Positions of the joints, in metres: pelvis, spine, neck, head; hip, knee, ankle, toe, shoulder, elbow, wrist,
    hand and palm of `r` and `l`; `face` is a point in front of the head, in the direction of the gaze.
    """
    found = upright(body_pose, body)
    turn, offset = laid(body_pose, body)
    if turn is not None:
        found = {name: turn @ point + offset for name, point in found.items()}
    if body_pose.between is None:
        return found
    former, share = body_pose.between, body_pose.between.share
    other, at = joints(former.pose, body), yawed(former.turn)
    return {
        name: (at @ other[name] + former.offset) * (1 - share) + point * share for name, point in found.items()
    }  # fmt: skip


def laid(body_pose: BodyPose, body: Proportions) -> tuple[Vector | None, Vector]:
    """Rotation and translation of a lying body from the upright one; no rotation for other postures."""
    if body_pose.posture != "lying":
        return None, np.zeros(3)
    return LYING, np.array((0, body_pose.seat + MATTRESS * body.height, body.height * 0.5))


def upright(body_pose: BodyPose, body: Proportions) -> Joints:
    """Return the joints, a lying body's as if it stood."""
    drop, lean = bend(body_pose, body)
    found = _legs(body_pose, body, drop)
    _torso(found, body, lean)
    for side, sign in (("r", 1.0), ("l", -1.0)):
        _arm(found, side, sign, body, body_pose)
    _head(found, body, body_pose.gaze, lean)
    return found


def bend(body_pose: BodyPose, body: Proportions) -> tuple[float, float]:
    """(metres by which the hips sink, degrees by which the back leans)."""
    return _stooping(effort_of(body_pose, body), body_pose, body)


@lru_cache(maxsize=64)
def effort_of(body_pose: BodyPose, body: Proportions) -> float:
    """Return how far a body stoops: as its pose says, else the least with which the hands reach their targets."""
    if body_pose.effort is not None:
        return body_pose.effort
    targets = [np.array(t) for t in (body_pose.right, body_pose.left) if t is not None]
    if not targets:
        return 0.0
    reach = body.arm * REACH

    def short(effort: float) -> float:
        drop, lean = _stooping(effort, body_pose, body)
        shoulder = _shoulders(_hips(body_pose, body, drop), body, lean)
        return max(0.0, *(float(np.linalg.norm(t - shoulder)) - reach for t in targets))

    best = min((short(k / EFFORTS) * 40 + k / EFFORTS, k) for k in range(EFFORTS + 1))[1]
    low, high = max(best - 1, 0) / EFFORTS, best / EFFORTS
    # Between two efforts the least that suffices.
    for _ in range(6 if best and short(high) <= 0 else 0):
        middle = (low + high) / 2
        low, high = (middle, high) if short(middle) > 0 else (low, middle)
    return high


def in_reach(target: Point, body_pose: BodyPose, body: Proportions) -> Point:
    """Return a target of a hand, raised until who does not stoop reaches it, or brought nearer where that is too
    little.
    """
    drop, lean = _stooping(0.0, body_pose, body)
    shoulder = _shoulders(_hips(body_pose, body, drop), body, lean)
    way, reach = np.array(target) - shoulder, body.arm * REACH
    far = float(np.linalg.norm(way))
    if far <= reach:
        return target
    down = reach**2 - float(way[0] ** 2 + way[2] ** 2)
    if down > 0 and way[1] < 0:
        return target[0], float(shoulder[1]) - sqrt(down), target[2]
    x, y, z = (shoulder + way * reach / far).tolist()
    return x, y, z


EFFORTS = 10
"""Number of steps in which stooping is tried."""

REACH = 0.985
"""Share of an arm's length to which it is stretched."""


def _stooping(effort: float, body_pose: BodyPose, body: Proportions) -> tuple[float, float]:
    """Drop of the hips and lean of the back by an effort from 0 to 1: first the back, then the knees too."""
    base = -4.0 * seated(body_pose, body)
    if body_pose.posture != "standing":
        return 0.0, base + (62.0 - base) * effort
    knees = max(2 * effort - 1, 0.0)
    return 0.30 * body.height * knees, 50.0 * min(2 * effort, 1.0) + 12.0 * knees


def seated(body_pose: BodyPose, body: Proportions) -> float:
    """0 for a body that stands to 1 for one that sits; between them while it sits down."""
    if body_pose.posture != "sitting":
        return 0.0
    sunk = body.pelvis - body_pose.seat - PELVIS_ON_SEAT * body.height
    return min(max(sunk / (0.2 * body.height), 0.0), 1.0)


def _shoulders(hips: Vector, body: Proportions, lean: float) -> Vector:
    """Return the point between the shoulders of a body that leans by some degrees."""
    found: Vector = hips + leaning(lean * 0.67) @ body.spine + leaning(lean) @ body.chest
    return found


def feet_of(body_pose: BodyPose, body: Proportions) -> tuple[Foot, Foot]:
    """Return the right and the left foot of a pose."""
    if body_pose.feet is not None:
        return body_pose.feet
    if body_pose.posture == "sitting":
        high = body_pose.seat + PELVIS_ON_SEAT * body.height - body.ankle
        legs = body.thigh + body.shin
        forward = min(body.thigh + 0.03, sqrt(max(legs**2 - high**2, 0.02)))
        lift = max(0.0, high - 0.985 * body.shin) if high > 1.2 * body.shin else 0.0
        return Foot(0.075 * body.height, forward, lift, 6.0), Foot(-0.075 * body.height, forward, lift, -6.0)
    step = body_pose.stride * STEP * body.height
    across = body.hip * 0.95
    return Foot(across, step, 0.0, 6.0), Foot(-across, -step, 0.0, -6.0)


def _hips(body_pose: BodyPose, body: Proportions, drop: float) -> Vector:
    if body_pose.posture == "sitting":
        return np.array((0.0, body_pose.seat + PELVIS_ON_SEAT * body.height, 0.0))
    high = body.pelvis - drop - body_pose.sink
    # Both feet are reached with knees that are never quite straight.
    legs = (body.thigh + body.shin) * 0.995
    for foot, sign in zip(feet_of(body_pose, body), (1.0, -1.0), strict=True):
        ankle = ankle_of(foot, body)
        far = hypot(ankle[0] - sign * body.hip, ankle[2] + drop * 0.35)
        high = min(high, float(ankle[1]) + sqrt(max(legs**2 - far**2, 0.01)))
    return np.array((0.0, high, -drop * 0.35))


def sinking(body_pose: BodyPose, body: Proportions) -> float:
    """Drop of the hips of an upright walking person below standing, metres, so that both feet are reached."""
    return body.pelvis - float(_hips(body_pose, body, 0.0)[1])


def ankle_of(foot: Foot, body: Proportions) -> Vector:
    """Return the position of a foot's ankle."""
    turn = yawed(foot.yaw)
    at = np.array((foot.x, foot.lift, foot.z))
    pitch = radians(abs(foot.pitch))
    if foot.pitch > 0:
        b, h = body.ball, body.ankle
        up, forward = h * cos(pitch) + b * sin(pitch), b * (1 - cos(pitch)) + h * sin(pitch)
    else:
        up, forward = body.ankle * cos(pitch), -body.ankle * sin(pitch)
    found: Vector = at + turn @ np.array((0.0, up, forward))
    return found


def _toe(foot: Foot, ankle: Vector, body: Proportions) -> Vector:
    low = 0.012 * body.height
    if foot.pitch >= 0:
        flat: Vector = np.array((foot.x, foot.lift + low, foot.z)) + yawed(foot.yaw) @ np.array((0.0, 0.0, body.toe))
        return flat
    found: Vector = ankle + yawed(foot.yaw) @ leaning(foot.pitch) @ np.array((0.0, low - body.ankle, body.toe))
    return found


def _legs(body_pose: BodyPose, body: Proportions, drop: float) -> Joints:
    found: Joints = {"pelvis": _hips(body_pose, body, drop)}
    for side, sign, foot in zip("rl", (1.0, -1.0), feet_of(body_pose, body), strict=True):
        hip = found["pelvis"] + (sign * body.hip, 0, 0)
        ankle = ankle_of(foot, body)
        knee, end = _leg(hip, foot, sign, body)
        found |= {f"hip_{side}": hip, f"knee_{side}": knee, f"ankle_{side}": end}
        found[f"toe_{side}"] = _toe(foot, ankle, body) + end - ankle
    return found


def _leg(hip: Vector, foot: Foot, sign: float, body: Proportions) -> tuple[Vector, Vector]:
    """Knee and ankle of a leg."""
    ahead = yawed(foot.yaw * 0.6) @ np.array((sign * 0.06, 0.25, 1.0))
    return two_bones(hip, ankle_of(foot, body), body.thigh, body.shin, ahead)


def _torso(found: Joints, body: Proportions, lean: float) -> None:
    # The back bends: the lower half leans by two thirds of the upper half's angle.
    found["spine"] = found["pelvis"] + leaning(lean * 0.67) @ body.spine
    found["chest"] = found["spine"] + leaning(lean) @ body.chest
    found["neck"] = found["chest"] + leaning(lean * 0.85) @ body.neck
    for side, sign in (("r", 1.0), ("l", -1.0)):
        found[f"shoulder_{side}"] = found["chest"] + leaning(lean) @ (np.array(body.shoulder) * (sign, 1, 1))


def _arm(found: Joints, side: str, sign: float, body: Proportions, body_pose: BodyPose) -> None:
    shoulder, hand = found[f"shoulder_{side}"], body_pose.hand(side)
    given = body_pose.target(side)
    target = _relaxed_hand(found, side, sign, body, body_pose) if given is None else np.array(given, np.float64)
    ahead = unit(target - shoulder)
    if hand.palm is not None:
        palm = unit(np.array(hand.palm, np.float64))
        # The hand is a straight continuation of the forearm as far as the palm's direction allows.
        along = ahead - palm * float(ahead @ palm)
        along = unit(along if np.linalg.norm(along) > 0.25 else along + 0.3 * np.array((0.0, 0.0, 1.0)))
        middle = target - palm * body.palm
    else:
        along, palm, middle = ahead, np.zeros(3), target
    pole = np.array((sign * (0.28 - 0.4 * body_pose.tuck(side)), -1.0, -0.65))
    if hand.swivel:
        pole = about(ahead, -sign * hand.swivel) @ pole
    goal = middle - along * body.hand
    elbow, wrist = two_bones(shoulder, goal, body.upper_arm, body.forearm, pole)
    found |= {f"elbow_{side}": elbow, f"wrist_{side}": wrist, f"hand_{side}": wrist + along * body.hand}
    found[f"palm_{side}"] = found[f"hand_{side}"] + palm * body.palm


def _relaxed_hand(found: Joints, side: str, sign: float, body: Proportions, body_pose: BodyPose) -> Vector:
    shoulder, h = found[f"shoulder_{side}"], body.height
    swing = -sign * body_pose.stride * 0.085 * h
    out = 0.022 * h
    hanging: Vector = shoulder + np.array((sign * out, -body.arm * 0.955, 0.03 * h + swing))
    share = seated(body_pose, body)
    hip = found[f"hip_{side}"]
    # Hands rest where the knees will be: a person's hands follow the stepping feet as it sits down.
    foot = feet_of(replace(body_pose, feet=None), body)[side == "l"] if share else None
    knee = _leg(hip, foot, sign, body)[0] if foot else hip
    # A person on the floor with the knees up has the hands before the knees, not between knees and chest.
    raised = min(max(float(knee[1] - hip[1]) / (0.25 * h), 0.0), 1.0)
    on_thigh: Vector = (
        hip + (knee - hip) * (0.62 + 0.36 * raised) + np.array((0, (0.05 - 0.07 * raised) * h, 0.13 * h * raised))
    )
    rests = hanging * (1 - share) + on_thigh * share
    tuck = body_pose.tuck(side)
    return rests + (_before_belly(found, sign, body) - rests) * tuck if tuck else rests


def _before_belly(found: Joints, sign: float, body: Proportions) -> Vector:
    """Return where the hand of an arm that is drawn in rests."""
    up = unit(found["chest"] - found["spine"])
    forward = np.cross((1.0, 0.0, 0.0), up)
    here: Vector = found["spine"] + forward * 0.11 * body.height + (sign * 0.035 * body.height, 0.0, 0.0)
    return here


def _head(found: Joints, body: Proportions, gaze: Point | None, lean: float) -> None:
    ahead = np.array((0.0, 0.0, 1.0))
    # The head stays more upright than the back.
    center = found["neck"] + leaning(lean * 0.4) @ body.head
    if gaze is not None:
        way = unit(np.array(gaze) - center)
        # Turning and nodding of the head are limited.
        flat = max(hypot(way[0], way[2]), 1e-6)
        side = float(np.clip(np.arctan2(way[0], way[2]), -TURN, TURN))
        nod = float(np.clip(np.arctan2(way[1], flat), *NOD))
        ahead = np.array((sin(side) * cos(nod), sin(nod), cos(side) * cos(nod)))
    found["head"], found["face"] = center, center + ahead * 0.1


def two_bones(root: Vector, goal: Vector, first: float, second: float, pole: Vector) -> tuple[Vector, Vector]:
    """(middle joint, end) of a chain of two bones from `root` towards `goal`; the middle bends towards `pole`.

    A goal out of reach is approached as far as the bones allow.
    """
    way = goal - root
    length = float(np.linalg.norm(way))
    along = way / length if length > 1e-9 else np.array((0.0, -1.0, 0.0))
    reach = min(max(length, abs(first - second) + 1e-4), (first + second) * 0.999)
    side = pole - along * float(pole @ along)
    bend_ = unit(side) if np.linalg.norm(side) > 1e-9 else np.array((0.0, 0.0, 1.0))
    angle = acos(min(max((first * first + reach * reach - second * second) / (2 * first * reach), -1.0), 1.0))
    middle = root + along * first * cos(angle) + bend_ * first * sin(angle)
    return middle, root + along * reach
