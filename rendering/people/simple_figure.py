"""The simple figure: a body of balls and rods around the joints, for persons without a shape."""

import numpy as np

from hearth.rendering.models.mesh import Mesh, join, transform
from hearth.rendering.models.paint import Paint
from hearth.rendering.models.shapes import ball, cushion, rod, upright_to
from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.person_appearance import Body
from hearth.rendering.people.rotations import Vector
from hearth.rendering.people.skeleton import Joints
from hearth.schemas.graph import Point


def simple_mesh(body: Body, body_pose: BodyPose, found: Joints) -> Mesh:
    """Return the mesh of a body around the joints of its pose, in the figure's frame."""
    return join((_trunk(body, found), *(_limbs(body, found, side) for side in "rl"), _head(body, found, body_pose)))


def _trunk(body: Body, found: Joints) -> Mesh:
    h, k = body.height, body.build
    top, low = Paint(body.top, body.weave, 6.0), Paint(body.bottom, "fabric", 5.0)
    hips = _along(found["pelvis"], found["spine"], (0.195 * h * k, 0.14 * h, 0.125 * h * k), low, 0.0)
    belly = _between(found["pelvis"], found["spine"], (0.185 * h * k, 0.2 * h, 0.12 * h * k), top, 0.75)
    chest = _between(found["spine"], found["chest"], (0.215 * h * k, 0.205 * h, 0.132 * h * k), top, 0.6)
    yoke = rod(_point(found["shoulder_r"]), _point(found["shoulder_l"]), 0.042 * h * k, top, sides=10)
    caps = [ball(_point(found[f"shoulder_{s}"]), 0.043 * h * k, top, 4) for s in "rl"]
    neck = rod(
        _point(found["chest"]),
        _point(found["neck"] + (found["head"] - found["neck"]) * 0.4),
        0.034 * h,
        Paint(body.skin),
        sides=10,
    )
    parts = [hips, belly, chest, yoke, *caps, neck]
    if body.skirt:
        parts += [
            rod(
                _point(found[f"hip_{s}"] + (0, 0.03 * h, 0)),
                _point((found[f"knee_{s}"] * 3 + found[f"ankle_{s}"]) / 4),
                0.06 * h * k,
                low,
                0.085 * h * k,
                12,
            )
            for s in "rl"
        ]
    return join(parts)


def _limbs(body: Body, found: Joints, side: str) -> Mesh:
    h, k = body.height, body.build
    skin = Paint(body.skin)
    leg = skin if body.skirt else Paint(body.bottom, "fabric", 5.0)
    hip, knee, ankle, toe = (found[f"{name}_{side}"] for name in ("hip", "knee", "ankle", "toe"))
    parts = [
        _bone(hip, knee, 0.056 * h * k, 0.041 * h * k, leg),
        ball(_point(knee), 0.041 * h * k, leg, 4),
        ball(_point(hip), 0.056 * h * k, leg, 4),
        _bone(knee, ankle, 0.04 * h * k, 0.027 * h * k, leg),
        _shoe(ankle, toe, h, Paint(body.shoes, shine=0.2)),
    ]
    shoulder, elbow, wrist, hand = (found[f"{name}_{side}"] for name in ("shoulder", "elbow", "wrist", "hand"))
    sleeve = Paint(body.top, body.weave, 6.0)
    parts += _sleeved(shoulder, elbow, wrist, body.sleeves, (0.036 * h * k, 0.027 * h * k, 0.02 * h * k), sleeve, skin)
    palm = _between(wrist, hand + (hand - wrist) * 0.5, (0.042 * h, 0.1 * h, 0.022 * h), skin, 0.9)
    sign = 1 if side == "r" else -1
    thumb = rod(
        _point(wrist + (hand - wrist) * 0.4),
        _point(hand + np.array((-sign * 0.03, 0.0, 0.012)) * h / 1.7),
        0.009 * h,
        skin,
        0.007 * h,
        6,
    )
    return join([*parts, palm, thumb])


def _sleeved(a: Vector, b: Vector, c: Vector, cover: float, radii: Point, cloth: Paint, skin: Paint) -> list[Mesh]:
    """Return an arm through shoulder, elbow and wrist, with a sleeve from its upper end."""
    half = min(cover * 2, 1.0)
    cut = a + (b - a) * half
    parts = [_bone(a, cut, radii[0] * 1.08, radii[1] * 1.15, cloth)]
    if half < 1:
        parts.append(_bone(cut, b, radii[0] * 0.85, radii[1], skin))
    low = cloth if cover > 0.5 else skin
    parts.append(ball(_point(b), radii[1] * (1.12 if cover >= 0.5 else 1.0), cloth if half >= 1 else skin, 4))
    end = b + (c - b) * (cover * 2 - 1 if cover > 0.5 else 1.0)
    parts.append(
        _bone(b, end, radii[1] * (1.1 if cover > 0.5 else 1.0), radii[2] * (1.15 if cover > 0.5 else 1.0), low)
    )
    if 0.5 < cover < 1:
        parts.append(_bone(end, c, radii[1] * 0.85, radii[2], skin))
    return parts


def _shoe(ankle: Vector, toe: Vector, h: float, paint: Paint) -> Mesh:
    """Return a shoe around ankle and toe."""
    heel = ankle - np.array((0, 0.02 * h, 0))
    front = ball(_point(toe - (toe - ankle) * 0.12), (0.03 * h, 0.022 * h, 0.036 * h), paint, 4)
    back = ball(_point(heel), (0.028 * h, 0.027 * h, 0.032 * h), paint, 4)
    return join(
        (
            rod(_point(heel - (0, 0.004 * h, 0)), _point(toe - (toe - ankle) * 0.15), 0.024 * h, paint, 0.021 * h, 10),
            front,
            back,
        )
    )


def _head(body: Body, found: Joints, body_pose: BodyPose) -> Mesh:
    """Head with face and hair, turned towards the gaze."""
    h, skin, hair = body.height, Paint(body.skin), Paint(body.hair, "brushed", 6.0)
    r = 0.052 * h
    parts = [
        cushion((0, 0, 0), (r * 1.75, r * 2.35, r * 2.0), skin, 1.0, 6),
        ball((0, -r * 0.08, r * 1.02), (r * 0.15, r * 0.2, r * 0.2), skin, 3),
        cushion((0, r * 0.42, -r * 0.16), (r * 1.95, r * 1.75, r * 2.02), hair, 1.0, 6),
        ball((0, -r * 0.52, r * 0.86), (r * 0.26, r * 0.06, r * 0.06), Paint("#a85a50"), 3),
    ]
    for s in (-1, 1):
        parts.append(ball((s * r * 0.88, -r * 0.05, 0), (r * 0.12, r * 0.24, r * 0.18), skin, 3))
        eye = (s * r * 0.34, r * 0.12, r * 0.85)
        if body_pose.asleep:
            parts.append(ball(eye, (r * 0.16, r * 0.03, r * 0.06), Paint("#4a3028"), 2))
        else:
            parts += [
                ball(eye, (r * 0.17, r * 0.12, r * 0.08), Paint("#f6f4f0"), 3),
                ball((eye[0], eye[1], eye[2] + r * 0.05), r * 0.09, Paint("#2a2220"), 3),
            ]
        parts.append(ball((s * r * 0.34, r * 0.36, r * 0.86), (r * 0.2, r * 0.04, r * 0.06), hair, 2))
    if body.style == "long":
        parts.append(cushion((0, -r * 0.5, -r * 0.55), (r * 1.95, r * 2.6, r * 1.1), hair, 0.9, 5))
    elif body.style == "bun":
        parts.append(ball((0, r * 0.9, -r * 0.95), r * 0.5, hair, 4))
    forward = found["face"] - found["head"]
    forward = forward / np.linalg.norm(forward)
    spine = found["head"] - found["neck"]
    right = np.cross(spine, forward)
    if np.linalg.norm(right) < 1e-6:
        right = np.array((1.0, 0.0, 0.0))
    right /= np.linalg.norm(right)
    frame = np.stack([right, np.cross(forward, right), forward], axis=1).astype(np.float32)
    return transform(join(parts), frame, found["head"])


def _bone(a: Vector, b: Vector, ra: float, rb: float, paint: Paint) -> Mesh:
    return rod(_point(a), _point(b), ra, paint, rb, 10)


def _along(at: Vector, towards: Vector, size: Point, paint: Paint, up: float) -> Mesh:
    """Return a soft block at `at`, upright along the direction to `towards`."""
    way = towards - at
    return transform(cushion((0, up, 0), size, paint, 0.7, 4), _upright(way), at)


def _between(a: Vector, b: Vector, size: Point, paint: Paint, roundness: float) -> Mesh:
    """Return a soft block at the middle of two joints, upright along the line between them."""
    return transform(cushion((0, 0, 0), size, paint, roundness, 4), _upright(b - a), (a + b) / 2)


def _upright(way: Vector) -> np.ndarray:
    """Return a rotation that maps +y to `way` and keeps +x sideways."""
    y = way / max(float(np.linalg.norm(way)), 1e-9)
    x = np.array((1.0, 0.0, 0.0)) - y * y[0]
    if np.linalg.norm(x) < 1e-3:
        return upright_to(y)
    x /= np.linalg.norm(x)
    return np.stack([x, y, np.cross(x, y)], axis=1).astype(np.float32)


def _point(vector: Vector) -> Point:
    return float(vector[0]), float(vector[1]), float(vector[2])
