"""Cameras from which an action might be seen: around person and object, preferably at the height of eyes."""

from collections.abc import Sequence
from itertools import product
from math import atan, atan2, cos, degrees, radians, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.cameras.camera import Camera, point_of
from hearth.rendering.cameras.visibility_estimates import ENOUGH, FILL, Obstacles, Target, ahead
from hearth.rendering.people.action_poses import Actor
from hearth.schemas.graph import Box

TURNS = tuple(range(-180, 180, 30))
"""Degrees from the direction in which the person looks."""

DISTANCES = (1.1, 1.5, 2.1, 2.9, 4.0)
"""Distances of cameras from the middle of their target, metres."""

HEIGHTS = ((1.5, 1.0), (1.05, 0.93), (2.1, 0.86))
"""Heights of cameras above the floor, metres, with their preference.

The eyes of a standing and of a sitting person, and the ceiling.
"""

NEAREST, BETWEEN, MORE = 0.8, (0.7, 1.8), tuple(range(-180, 180, 18))
"""A distance, heights and directions that are tried besides."""

OVER = (0.78, 1.0, 1.4)
"""Metres from an object of cameras that look over it."""

WIDEST, NARROWEST = 72.0, 14.0
"""Degrees of the vertical field of view."""

CLOSEST, HANDS = 0.6, 0.4
"""Metres of height that a picture shows at least, of a person and of hands that hold something tiny."""

TINY = 0.28
"""Metres of height that the closest pictures show."""

UPPER = 0.35
"""Metres of height above the upper body that its pictures show."""

AT_HAND = 0.2
"""Largest distance from a person's joints to the objects that it holds or touches, metres."""

INSET = 0.12
"""Metres from the walls of a room within which no camera stands."""

FAR_APART = 3.0
"""Metres between person and object beyond which both need not fill the picture."""

FRONT = 0.12
"""Preference of a view from the front over a view from behind, a factor."""


def around(
    actor: Actor,
    who: Target,
    objects: Sequence[Target],
    room: Box | None,
    size: tuple[int, int],
    name: str,
    closer: bool = False,
    dense: bool = False,
) -> list[Camera]:
    """Cameras around a person and objects, inside the room, with a field of view that contains both.

    Args:
        actor, who: the person.
        objects: what it acts on.
        room: the box of its room.
        size: of the picture, pixels.
        name: of the cameras, before their number.
        closer: whether to add closer views, which need not contain all of the person.
        dense: whether to try more places, some nearer, as narrow rooms need.
    """
    framings = [framed(actor, who, objects, size[0] / size[1])]
    framings += _closer(who, objects, size[0] / size[1]) if closer else []
    found: list[Camera] = []
    heights = [up for up, _ in HEIGHTS]
    places = product((NEAREST, *DISTANCES), (*heights, *BETWEEN), MORE) if dense else product(DISTANCES, heights, TURNS)
    for (distance, up, turn), (middle, height) in product(places, framings):
        angle = radians(actor.yaw + turn)
        eye = (middle[0] + sin(angle) * distance, actor.level + up, middle[2] + cos(angle) * distance)
        if room is None or inside(eye, room):
            far = max(float(np.linalg.norm(np.array(eye) - middle)), 0.3)
            fov = float(np.clip(degrees(2 * atan(height / 2 / far)), NARROWEST, WIDEST))
            found.append(Camera(f"{name}.{len(found)}", eye, point_of(middle), *size, fov))
    return [*found, *_over(actor, who, objects, room, size, f"{name}.over")] if dense else found


def _over(
    actor: Actor, who: Target, objects: Sequence[Target], room: Box | None, size: tuple[int, int], name: str
) -> list[Camera]:
    """Cameras that look over the smallest of some objects to the person, who stands farther away."""
    near = _smallest(who, objects, size[0] / size[1])
    if near is None:
        return []
    point, chest = _point(near, who), who.points.mean(axis=0)
    away = degrees(atan2(point[0] - chest[0], point[2] - chest[2]))
    height = 1.15 * max(_needed(near, size[0] / size[1]), TINY)
    found: list[Camera] = []
    for distance, up, turn in product(OVER, (0.1, 0.3, 0.6), (-50, -25, 0, 25, 50)):
        angle = radians(away + turn)
        eye = (point[0] + sin(angle) * distance, float(point[1]) + up, point[2] + cos(angle) * distance)
        if room is None or inside(eye, room):
            far = float(np.linalg.norm(np.array(eye) - point))
            fov = float(np.clip(degrees(2 * atan(height / 2 / far)), NARROWEST, WIDEST))
            # The object is below the middle, so that the person is seen above it.
            target = (float(point[0]), float(point[1]) + 0.25 * height, float(point[2]))
            found.append(Camera(f"{name}.{len(found)}", eye, target, *size, fov))
    return found


def _smallest(who: Target, objects: Sequence[Target], aspect: float) -> Target | None:
    """Of some objects near a person, the one that needs the closest view."""
    near = [t for t in objects if np.linalg.norm(_point(t, who) - who.points.mean(axis=0)) < FAR_APART]
    return min(near, key=lambda one: _needed(one, aspect)) if near else None


def _closer(who: Target, objects: Sequence[Target], aspect: float) -> list[tuple[NDArray[np.float64], float]]:
    """Closer views of the smallest of some objects near a person, or of the upper body: middles, and metres that
    pictures are high there.
    """
    target = _smallest(who, objects, aspect)
    if target is None:
        head, middle = who.points[who.points[:, 1].argmax()], who.points.mean(axis=0)
        return [((head + middle) / 2, 2.0 * float(np.linalg.norm(head - middle)) + UPPER)]
    point, small = _point(target, who), _needed(target, aspect)
    head, hand = who.points[who.points[:, 1].argmax()], who.points[_nearest(who, point)]
    upper = max(float(np.linalg.norm(point - head)) + 0.35, small)
    return [((point + head) / 2, upper), (0.7 * point + 0.3 * hand, max(small, TINY))]


def _nearest(who: Target, point: NDArray[np.float64]) -> int:
    """Return the joint of a person that is nearest to a point."""
    return int(np.linalg.norm(who.points - point, axis=1).argmin())


def framed(actor: Actor, who: Target, objects: Sequence[Target], aspect: float) -> tuple[NDArray[np.float64], float]:
    """Return the middle of a camera's target, and the height that its picture should cover there, metres."""
    near = [target for target in objects if np.linalg.norm(_point(target, who) - who.points.mean(axis=0)) < FAR_APART]
    spans = [(who.low, who.high), *((_point(t, who) - _half(t), _point(t, who) + _half(t)) for t in near)]
    low, high = np.min([a for a, _ in spans], axis=0), np.max([b for _, b in spans], axis=0)
    middle = (low + high) / 2
    across = float(np.hypot(high[0] - low[0], high[2] - low[2]))
    height = max(float(high[1] - low[1]), across / aspect) + 0.35
    small = min((_needed(target, aspect) for target in near), default=np.inf)
    if small < height and near:
        # A small thing needs a closer view: of it, and of the upper body.
        target = min(near, key=lambda one: _needed(one, aspect))
        head = who.points[who.points[:, 1].argmax()]
        reach = float(np.abs(_point(target, who) - head).max())
        middle, height = 0.55 * _point(target, who) + 0.45 * head, max(small, CLOSEST, 0.8 * reach + 0.4)
        in_hand = np.linalg.norm(who.points - _point(target, who), axis=1).min() < AT_HAND
        if in_hand and small < height:
            # For a tiny held object, such as a coin, the hands suffice.
            share = 0.45 * small / height
            middle, height = (1 - share) * _point(target, who) + share * head, max(small, HANDS)
    return middle, height


def _needed(target: Target, aspect: float) -> float:
    """Metres of a picture's height from which on a thing would cover too little of it."""
    x, y, z = np.maximum(target.high - target.low, 0.005)
    area = FILL * max((y * z + x * z + x * y) / 2.2, 1e-4)
    return sqrt(area / (ENOUGH * 1.3 * target.least * aspect))


def _point(target: Target, who: Target) -> NDArray[np.float64]:
    """Return the point of a thing's box nearest to a person."""
    half = _half(target)
    found: NDArray[np.float64] = np.clip(who.points.mean(axis=0), target.low + half, target.high - half)
    return found


def _half(target: Target) -> NDArray[np.float64]:
    """Half of the part of a thing that a camera should show: all of it if it is small."""
    found: NDArray[np.float64] = np.minimum((target.high - target.low) / 2, 0.35)
    return found


def inside(eye: Sequence[float], room: Box) -> bool:
    """Return whether a point is in a room, away from its walls."""
    return all(abs(e - c) <= s / 2 - INSET for e, c, s in zip(eye, room.center, room.size, strict=True))


def preference(cameras: Sequence[Camera], actor: Actor) -> NDArray[np.float64]:
    """(cameras,) factors that prefer eye height, and views from the front."""
    found = []
    for camera in cameras:
        up = camera.eye[1] - actor.level
        height = min(HEIGHTS, key=lambda known: abs(known[0] - up))[1]
        x, z = camera.eye[0] - actor.spot[0], camera.eye[2] - actor.spot[1]
        front = (x * sin(radians(actor.yaw)) + z * cos(radians(actor.yaw))) / max(float(np.hypot(x, z)), 0.1)
        found.append(height * (1 + FRONT * min(front, 0.7)))
    return np.array(found)


def free(cameras: Sequence[Camera], obstacles: Obstacles) -> tuple[list[Camera], NDArray[np.float64]]:
    """Return the cameras with nothing close in front of them, and the worth that each loses by near objects (see
    `Ahead`).
    """
    found = ahead(cameras, obstacles)
    return [cameras[number] for number in np.flatnonzero(found.free).tolist()], found.loss[found.free]
