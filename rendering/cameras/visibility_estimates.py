"""Estimates of the visible share of persons and objects, from a few rays to their points, without a picture.

A picture's pixels decide in the end (`recognition`); this finds the cameras worth a picture, some thousand a second.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import radians, tan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.rendering.cameras.camera import Camera
from hearth.rendering.cameras.recognition import CLOSE, OBJECT, PERSON
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.figure import Figure
from hearth.rendering.scene.instances import placed
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.triangles import Part

POINTS = 24
"""Points on an object."""

SILHOUETTE, FILL = 0.45, 0.5
"""Square metres that a person covers, and the share that a thing covers of its box, as a camera sees them."""

ENOUGH = 1.5
"""Times the least share of a picture that a camera should show, as shares are estimated."""

BROAD, SHOULDERS = 0.17, 0.85
"""Metres of a body's radius, and the share of its height up to which it hides things."""

HEAD, HEAD_FROM_TO = 0.2, (-0.1, 0.14)
"""Worth that a visible head adds to a camera, and the range of the head below and above the highest joint, metres."""

AT_WORK, SKIN = 0.15, 0.06
"""Worth that working hands add to a camera, and their range in front of the middle of a palm, metres."""

GRID = (12, 9)
"""Rays by which a camera finds what is close in front of it."""

FREE = 0.06
"""Share of these that may hit something close."""

REACH, BEFORE = 1.6, 0.75
"""Objects crowd a picture if they are nearer to the lens than this: metres, and share of the distance to the target."""

CROWDED = 5.0
"""Worth that a picture loses if objects at the lens fill it; the loss is smaller for farther objects."""

Coordinates = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Target:
    """A person or an object to show.

    Attributes:
        node: its id.
        points: (n, 3) points on it.
        low, high: corners of the box around them.
        area: square metres that a camera sees of a person; 0 takes an object's box.
        least: the share of the picture that it has to cover.
        hands: (k, 3) palms of a person that are at work.
    """

    node: int
    points: Coordinates
    low: Coordinates
    high: Coordinates
    area: float
    least: float
    hands: Coordinates = field(default_factory=lambda: np.zeros((0, 3)))


def person(actor: Actor) -> Target:
    """Return an actor as a target."""
    joints = {name: actor.world((float(x), float(y), float(z))) for name, (x, y, z) in actor.figure().joints().items()}
    points = np.array(list(joints.values()))
    low, high = points.min(axis=0) - 0.1, points.max(axis=0) + 0.1
    hands = [joints[f"palm_{side}"] for side in "rl" if actor.body_pose.target(side) is not None]
    return Target(actor.node.id, points, low, high, SILHOUETTE, PERSON, np.array(hands).reshape(-1, 3))


def thing(scene: Scene, node: int) -> Target | None:
    """Return a node as a target; None if it is not drawn."""
    corners = [placed(one).corners for one in scene.everything if one.id == node and len(placed(one))]
    if not corners:
        return None
    triangles = np.concatenate(corners).astype(np.float64)
    sides = triangles[:, 1:] - triangles[:, :1]
    sums = np.cumsum(np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) + 1e-12)
    chosen = np.searchsorted(sums, (np.arange(POINTS) + 0.5) / POINTS * sums[-1])
    flat = triangles.reshape(-1, 3)
    return Target(node, triangles[chosen].mean(axis=1), flat.min(axis=0), flat.max(axis=0), 0.0, OBJECT)


class Obstacles(NamedTuple):
    """Occluders: parts of a scene, each with the node ids of its triangles, and persons."""

    parts: tuple[tuple[Part, NDArray[np.int64]], ...]
    people: tuple[Actor, ...] = ()

    @classmethod
    def of(cls, scene: Scene, without: frozenset[int], people: Sequence[Actor]) -> Obstacles:
        """Those of a scene, without figures and some held things."""
        kept = (one for one in scene.things if not isinstance(one.model, Figure) and one.id not in without)
        parts = (scene.static.whole, Part.of(tuple(kept)))
        return cls(
            tuple((part, np.array([one.id for one in part.things], np.int64)[part.owner]) for part in parts),
            tuple(people),
        )

    @classmethod
    def exact(cls, scene: Scene) -> Obstacles:
        """Return the occluders of a scene with its figures and held objects, triangle by triangle."""
        geometry = scene.geometry
        parts = [part for part in (geometry.static, geometry.moving) if len(part.mesh)]
        return cls(tuple((part, np.array([one.id for one in part.things], np.int64)[part.owner]) for part in parts))

    def cast(self, rays: Floats) -> tuple[Floats, NDArray[np.int64]]:
        """(N,) distances of the first hits of rays, in units of their directions, and the ids of the hit nodes."""
        far, ids = np.full(len(rays), np.inf, np.float32), np.zeros(len(rays), np.int64)
        for part, known in self.parts:
            hits = part.caster.cast(rays)
            nearer = hits.distance < far
            far[nearer] = hits.distance[nearer]
            ids[nearer] = known[hits.triangle[nearer]]
        return far, ids

    def behind_people(self, rays: Floats, but: int) -> NDArray[np.bool_]:
        """(N,) whether a person, other than one, stands between a ray's origin and its end."""
        found = np.zeros(len(rays), np.bool_)
        for actor in self.people:
            if actor.node.id == but:
                continue
            way, start = rays[:, (3, 5)], rays[:, (0, 2)] - np.array(actor.spot, np.float32)
            length = np.maximum((way * way).sum(axis=1), 1e-9)
            share = np.clip(-(start * way).sum(axis=1) / length, 0, 1)
            near = np.hypot(*(start + way * share[:, None]).T) < BROAD
            height = rays[:, 1] + rays[:, 4] * share - actor.level
            top = SHOULDERS * actor.body.height if actor.body_pose.posture == "standing" else 1.0
            # What is in front of the body ends before it.
            found |= near & (height > 0) & (height < top) & (share < 0.97)
        return found


class Sight(NamedTuple):
    """Views of a target by some cameras.

    Attributes:
        share: (cameras,) of the picture.
        unhidden: (cameras,) share of the visible target in the picture.
    """

    share: Coordinates
    unhidden: Coordinates


def sight(cameras: Sequence[Camera], target: Target, obstacles: Obstacles) -> Sight:
    """Estimate what cameras show of a target."""
    inside, free, depth = _in_sight(cameras, target.points, obstacles, target.node)
    seen = inside & free
    count = np.maximum(inside.sum(axis=1), 1)
    half = np.array([tan(radians(camera.fov) / 2) for camera in cameras])
    picture = 4 * half * half * cameras[0].width / cameras[0].height * np.maximum(np.median(depth, axis=1), 0.3) ** 2
    area = _areas(np.array([camera.eye for camera in cameras]), target) if target.area == 0 else target.area
    return Sight(area * seen.mean(axis=1) / picture, seen.sum(axis=1) / count)


def _in_sight(
    cameras: Sequence[Camera], points: Coordinates, obstacles: Obstacles, node: int, skin: float = 0.0
) -> tuple[NDArray[np.bool_], NDArray[np.bool_], Coordinates]:
    """(cameras, points) each: whether points on a node are in the picture, whether nothing else hides them, and how
    many metres deep they are. What is `skin` metres before a point does not hide it; without a skin the whole node
    does not.
    """
    eyes = np.array([camera.eye for camera in cameras])
    ways = points[None] - eyes[:, None]
    local = np.einsum("cnk,ckj->cnj", ways, np.array([camera.pose[:3, :3] for camera in cameras]))
    half = np.array([tan(radians(camera.fov) / 2) for camera in cameras])[:, None]
    wide = half * cameras[0].width / cameras[0].height
    depth = np.maximum(local[..., 2], 1e-6)
    inside = (local[..., 2] > 0.1) & (np.abs(local[..., 1]) < half * depth) & (np.abs(local[..., 0]) < wide * depth)
    rays = np.concatenate((np.broadcast_to(eyes[:, None], ways.shape), ways), axis=2).reshape(-1, 6).astype(np.float32)
    far, ids = obstacles.cast(rays)
    reached = far > 1 - np.maximum(skin / np.maximum(np.linalg.norm(rays[:, 3:], axis=1), 1e-6), 0.015)
    whole = (ids == node) if not skin else np.False_
    free = (reached | whole) & ~obstacles.behind_people(rays, node)
    return inside, free.reshape(inside.shape), depth


def _areas(eyes: Coordinates, target: Target) -> Coordinates:
    """(cameras,) square metres that cameras see of a thing."""
    way = (target.low + target.high) / 2 - eyes
    way /= np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-9)
    x, y, z = np.maximum(target.high - target.low, 0.005)
    return FILL * np.asarray(np.abs(way) @ np.array((y * z, x * z, x * y)))


class Ahead(NamedTuple):
    """Everything that stands in front of some cameras: furniture, doors, or the step's own objects, seen from behind.

    Attributes:
        free: (cameras,) whether nothing is close in front of them.
        loss: (cameras,) of their worth, by the share of the picture that near things fill, and by how near these are.
    """

    free: NDArray[np.bool_]
    loss: Coordinates


def ahead(cameras: Sequence[Camera], obstacles: Obstacles) -> Ahead:
    """Obstacles in front of cameras, found by a few rays."""
    if not cameras:
        return Ahead(np.zeros(0, np.bool_), np.zeros(0))
    cast = _grids(cameras)
    far, _ = obstacles.cast(cast)
    cast[:, 3:] *= CLOSE + 0.1
    close = (far < CLOSE + 0.1) | obstacles.behind_people(cast, -1)
    whole = np.linalg.norm([np.subtract(camera.target, camera.eye) for camera in cameras], axis=1)
    reach = np.minimum(BEFORE * whole, REACH)[:, None]
    near = np.clip(1 - far.reshape(len(cameras), -1) / reach, 0, 1)
    return Ahead(close.reshape(len(cameras), -1).mean(axis=1) < FREE, CROWDED * near.mean(axis=1))


def _grids(cameras: Sequence[Camera]) -> Floats:
    """(cameras * rays, 6) rays all over the pictures of cameras; directions have camera-space z = 1."""
    across, down = np.meshgrid(*((np.arange(n) + 0.5) / n * 2 - 1 for n in GRID))
    rays = []
    for camera in cameras:
        half = tan(radians(camera.fov) / 2)
        flat = np.stack((across * half * camera.width / camera.height, down * half, np.ones_like(across)), axis=-1)
        ways = flat.reshape(-1, 3) @ camera.pose[:3, :3].T
        rays.append(np.concatenate((np.broadcast_to(np.array(camera.eye), ways.shape), ways), axis=1))
    return np.concatenate(rays).astype(np.float32)


def too_near(cameras: Sequence[Camera], who: Target) -> NDArray[np.bool_]:
    """(cameras,) whether a person is so near that it fills the picture."""
    eyes = np.array([camera.eye for camera in cameras])
    near = np.linalg.norm(eyes[:, None] - who.points[None], axis=2).min(axis=1)
    return np.asarray(near < CLOSE + 0.15)


class Worth(NamedTuple):
    """Worths of some cameras.

    Attributes:
        total: (cameras,) 1 for a camera that shows a person and objects well enough, more for a better view.
        enough: (cameras,) whether they seem to be recognisable.
    """

    total: Coordinates
    enough: NDArray[np.bool_]


def values(cameras: Sequence[Camera], who: Target, objects: Sequence[Target], obstacles: Obstacles) -> Worth:
    """Worths of cameras that show a person and objects."""
    found = [sight(cameras, target, obstacles) for target in (who, *objects)]
    parts = []
    enough = np.ones(len(cameras), np.bool_)
    for target, one in zip((who, *objects), found, strict=True):
        size = np.minimum(one.share / (ENOUGH * target.least), 1.0)
        parts.append(size * np.minimum(one.unhidden / 0.7, 1.0))
        enough &= (one.share >= ENOUGH * target.least) & (one.unhidden > 0.6)
    total = 0.4 * np.mean(parts, axis=0) + 0.6 * enough
    # A person that fills some of the picture is seen better than one far away, and better with the head.
    total += 0.15 * np.minimum(found[0].share / 0.08, 1.0) * (found[0].unhidden > 0.6)
    total += AT_WORK * _with_hands(cameras, who, obstacles)
    return Worth(total + HEAD * _with_head(cameras, who), enough)


def _with_hands(cameras: Sequence[Camera], who: Target, obstacles: Obstacles) -> Coordinates:
    """(cameras,) the share of a person's hands at work that is seen; 0 where none is at work."""
    if not len(who.hands):
        return np.zeros(len(cameras))
    inside, free, _ = _in_sight(cameras, who.hands, obstacles, who.node, SKIN)
    return np.asarray((inside & free).mean(axis=1))


def _with_head(cameras: Sequence[Camera], who: Target) -> NDArray[np.bool_]:
    """(cameras,) whether a person's whole head is in the picture."""
    top = who.points[who.points[:, 1].argmax()]
    around = np.array([(top[0], top[1] + up, top[2]) for up in HEAD_FROM_TO])
    found = []
    for camera in cameras:
        (x, y), depth = camera.project(around)[0].T, camera.project(around)[1]
        found.append((depth > 0.1) & (x > 0) & (x < camera.width) & (y > 0) & (y < camera.height))
    return np.asarray(np.array(found, np.bool_).reshape(-1, len(around)).all(axis=1))
