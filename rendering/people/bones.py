"""Bones of a pose: the motion of each from rest, which carries the skin."""

from functools import lru_cache

import numpy as np

from hearth.rendering.arrays import Floats
from hearth.rendering.people.body_pose import BodyPose, Foot
from hearth.rendering.people.body_shape import FORWARD, LOWERED, Shape, body_data, proportions, shaped
from hearth.rendering.people.grips import GRIPS
from hearth.rendering.people.proportions import Proportions
from hearth.rendering.people.rotations import Vector, about, leaning, unit, yawed
from hearth.rendering.people.skeleton import Joints, bend, feet_of, laid, upright

RIG_SIDE = {"r": "l", "l": "r"}
"""The rig's name of each side: its person looks the other way."""

FINGERS = ("index", "middle", "ring", "pinky")

Motions = dict[str, tuple[Floats, Vector, Vector]]
"""Bone -> rotation, pivot in the rest pose, pivot in the pose."""


def matrices(body_pose: BodyPose, shape: Shape, height: float) -> Floats:
    """(B, 3, 4) the motion of each bone from rest to a pose, in the figure's frame."""
    body = proportions(shape, height)
    turns, rests, pivots = _motions(body_pose, shape, height, body)
    if body_pose.between is not None:
        former, share = body_pose.between, body_pose.between.share
        other = matrices(former.pose, shape, height).astype(np.float64)
        at = yawed(former.turn)
        moved = np.einsum("ij,bj->bi", at, np.einsum("bij,bj->bi", other[:, :, :3], rests) + other[:, :, 3])
        pivots = (moved + former.offset) * (1 - share) + pivots * share
        u, _, v = np.linalg.svd((at @ other[:, :, :3]) * (1 - share) + turns * share)
        turns = u @ v
    found = np.empty((len(turns), 3, 4), np.float32)
    found[:, :, :3] = turns
    found[:, :, 3] = pivots - np.einsum("bij,bj->bi", turns, rests)
    return found


def _motions(body_pose: BodyPose, shape: Shape, height: float, body: Proportions) -> tuple[Floats, Floats, Floats]:
    """Rotations (B, 3, 3), pivots in the rest pose and in the pose (B, 3) of all bones."""
    found = upright(body_pose, body)
    rest = _rest(shape, height)
    moves = _trunk(body_pose, body, found, rest)
    for side in "rl":
        foot = feet_of(body_pose, body)[side == "l"]
        moves |= _leg(foot, found, rest, side)
        moves |= _arm(body_pose, found, rest, side, moves[f"clavicle_{RIG_SIDE[side]}"][0], shape, height)
    data = body_data()
    turns = np.stack([moves[bone][0] for bone in data.bones])
    rests, pivots = (np.stack([moves[bone][k] for bone in data.bones]) for k in (1, 2))
    turn, offset = laid(body_pose, body)
    return (turns, rests, pivots) if turn is None else (turn @ turns, rests, pivots @ turn.T + offset)


@lru_cache(maxsize=64)
def _rest(shape: Shape, height: float) -> Joints:
    """Joints and ends of bones in the rest pose, by Hearth's names, and by the rig's names where Hearth has none."""
    data, person, body = body_data(), shaped(shape, height), proportions(shape, height)
    found: Joints = {name: person.heads[number] for number, name in enumerate(data.bones)}
    found |= {f"{name}_end": person.tails[number] for number, name in enumerate(data.bones)}
    found["pelvis"] = np.array((0.0, body.pelvis, 0.0))
    for name, joint, before in (("middle", "spine", "pelvis"), ("chest", "chest", "middle"), ("nape", "neck", "chest")):
        found[name] = found[before] + np.array(getattr(body, joint))
    found["skull"] = found["nape"] + np.array(body.head)
    return found


def _trunk(body_pose: BodyPose, body: Proportions, found: Joints, rest: Joints) -> Motions:
    _, lean = bend(body_pose, body)
    hips, low, high = leaning(lean * 0.3), leaning(lean * 0.67), leaning(lean)
    forward = unit(found["face"] - found["head"])
    up = found["head"] - found["neck"]
    right = unit(np.cross(up, forward))
    head = np.stack([right, np.cross(forward, right), forward], axis=1)
    base = found["head"] + head @ (rest["head"] - rest["skull"])
    neck = _swing(leaning(lean * 0.85) @ unit(rest["head"] - rest["nape"]), base - found["neck"]) @ leaning(lean * 0.85)
    moves: Motions = {
        "pelvis": (hips, rest["pelvis"], found["pelvis"]),
        "spine_01": (low, rest["pelvis"], found["pelvis"]),
        "spine_02": (low, rest["middle"], found["spine"]),
        "spine_03": (high, rest["middle"], found["spine"]),
        "neck_01": (neck, rest["nape"], found["neck"]),
        "head": (head, rest["skull"], found["head"]),
    }
    for side in "rl":
        rig = RIG_SIDE[side]
        root = rest[f"clavicle_{rig}"]
        lower = high @ about(FORWARD, -LOWERED if side == "r" else LOWERED)
        moves[f"clavicle_{rig}"] = (lower, root, found["chest"] + high @ (root - rest["chest"]))
    return moves


def _leg(foot: Foot, found: Joints, rest: Joints, side: str) -> Motions:
    rig = RIG_SIDE[side]
    hip, knee, ankle = (found[f"{name}_{side}"] for name in ("hip", "knee", "ankle"))
    turn, half = yawed(foot.yaw), yawed(foot.yaw * 0.6)
    thigh = _swing(half @ (rest[f"calf_{rig}"] - rest[f"thigh_{rig}"]), knee - hip) @ half
    calf = _swing(half @ (rest[f"foot_{rig}"] - rest[f"calf_{rig}"]), ankle - knee) @ half
    flat = turn @ leaning(foot.pitch)
    ball = ankle + flat @ (rest[f"ball_{rig}"] - rest[f"foot_{rig}"])
    return {
        f"thigh_{rig}": (thigh, rest[f"thigh_{rig}"], hip),
        f"calf_{rig}": (calf, rest[f"calf_{rig}"], knee),
        f"foot_{rig}": (flat, rest[f"foot_{rig}"], ankle),
        # Toes stay flat while the heel is raised.
        f"ball_{rig}": (turn if foot.pitch > 0 else flat, rest[f"ball_{rig}"], ball),
    }


def _arm(
    body_pose: BodyPose, found: Joints, rest: Joints, side: str, base: Floats, shape: Shape, height: float
) -> Motions:
    rig, hand = RIG_SIDE[side], body_pose.hand(side)
    shoulder, elbow, wrist, middle = (found[f"{name}_{side}"] for name in ("shoulder", "elbow", "wrist", "hand"))
    upper = _swing(base @ (rest[f"lowerarm_{rig}"] - rest[f"upperarm_{rig}"]), elbow - shoulder) @ base
    lower = _swing(upper @ (rest[f"hand_{rig}"] - rest[f"lowerarm_{rig}"]), wrist - elbow) @ upper
    along, palm = _palm_frame(shape, height, side)
    end = _swing(lower @ along, middle - wrist) @ lower
    if hand.palm is not None or body_pose.target(side) is None:
        wanted = np.array(hand.palm) if hand.palm is not None else _natural(side, elbow, wrist)
        axis = unit(middle - wrist)
        now, then = end @ palm, wanted - axis * float(wanted @ axis)
        if np.linalg.norm(then) > 1e-3:
            twist = float(np.degrees(np.arctan2(np.cross(now, then) @ axis, now @ then)))
            end = about(axis, twist) @ end
            # Half of the twist is in the forearm.
            lower = about(unit(wrist - elbow), twist * 0.55) @ lower
    moves: Motions = {
        f"upperarm_{rig}": (upper, rest[f"upperarm_{rig}"], shoulder),
        f"lowerarm_{rig}": (lower, rest[f"lowerarm_{rig}"], elbow),
        f"hand_{rig}": (end, rest[f"hand_{rig}"], wrist),
    }
    for bone, (turn, pivot, moved) in _fingers(shape, height, side, hand.grip).items():
        moves[bone] = (end @ turn, pivot, wrist + end @ (moved - rest[f"hand_{rig}"]))
    return moves


def _natural(side: str, elbow: Vector, wrist: Vector) -> Vector:
    """Return where the palm of an arm that hangs looks: inwards and a little back; down if the forearm is level."""
    level = 1 - abs(float(unit(wrist - elbow)[1]))
    inwards = np.array((-1.0 if side == "r" else 1.0, 0.0, -0.35))
    found: Vector = inwards * (1 - level) + np.array((0.0, -1.0, 0.0)) * level
    return found


@lru_cache(maxsize=128)
def _palm_frame(shape: Shape, height: float, side: str) -> tuple[Vector, Vector]:
    """Directions from the wrist to the knuckles, and in which the palm looks, in the rest pose."""
    rest, rig = _rest(shape, height), RIG_SIDE[side]
    wrist, knuckle, tip = rest[f"hand_{rig}"], rest[f"middle_01_{rig}"], rest[f"middle_03_{rig}_end"]
    along = unit(knuckle - wrist)
    across = unit(rest[f"pinky_01_{rig}"] - rest[f"index_01_{rig}"])
    palm = np.cross(along, across)
    curl = tip - knuckle
    palm = palm if float(palm @ (curl - along * float(curl @ along))) > 0 else -palm
    return along, unit(palm - along * float(palm @ along))


@lru_cache(maxsize=512)
def _fingers(shape: Shape, height: float, side: str, grip: str) -> Motions:
    """Return the motions of the finger bones in the frame of a hand in the rest pose."""
    rest, rig, bends = _rest(shape, height), RIG_SIDE[side], GRIPS[grip]
    along, palm = _palm_frame(shape, height, side)
    axis = unit(np.cross(along, palm))
    found: Motions = {}
    for number, finger in enumerate(FINGERS):
        turn: Floats = about(palm, (1.5 - number) * bends.spread * _handed(rest, rig, along, palm))
        at = rest[f"{finger}_01_{rig}"]
        for k, degrees in enumerate(bends.of_index if finger == "index" else bends.fingers, 1):
            bone = f"{finger}_{k:02d}_{rig}"
            turn = turn @ about(axis, degrees)
            found[bone] = (turn, rest[bone], at)
            at = at + turn @ (rest[f"{bone}_end"] - rest[bone])
    return found | _thumb(rest, rig, bends.thumb, along, palm)


def _handed(rest: Joints, rig: str, along: Vector, palm: Vector) -> float:
    side = np.cross(palm, along)
    return 1.0 if float(side @ (rest[f"index_01_{rig}"] - rest[f"pinky_01_{rig}"])) > 0 else -1.0


def _thumb(rest: Joints, rig: str, bends: tuple[float, float, float], along: Vector, palm: Vector) -> Motions:
    root = rest[f"thumb_01_{rig}"]
    side = root - rest[f"hand_{rig}"]
    inward = 1.0 if float(np.cross(along, side) @ palm) > 0 else -1.0
    turn: Floats = about(along, bends[0] * inward)
    reach = rest[f"thumb_03_{rig}_end"] - root
    axis = unit(np.cross(reach, rest[f"middle_01_{rig}"] - root))
    found: Motions = {}
    at = root
    for k, degrees in enumerate((0.0, *bends[1:]), 1):
        bone = f"thumb_{k:02d}_{rig}"
        turn = turn @ about(axis, degrees)
        found[bone] = (turn, rest[bone], at)
        at = at + turn @ (rest[f"{bone}_end"] - rest[bone])
    return found


def _swing(a: Vector, b: Vector) -> Floats:
    """Return the smallest rotation from one direction to another."""
    a, b = unit(a), unit(b)
    cross, cosine = np.cross(a, b), float(a @ b)
    if cosine < -0.9999:
        side = np.cross(a, (0.0, 0.0, 1.0))
        return about(unit(side + np.array((0.0, 1e-9, 0.0))), 180.0)
    x, y, z = cross
    skew = np.array(((0, -z, y), (z, 0, -x), (-y, x, 0)))
    found: Floats = np.eye(3) + skew + skew @ skew / (1 + cosine)
    return found
