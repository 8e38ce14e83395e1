"""The cameras of a home, and the choice of the one that best shows a step (thesis 2.4.1)."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from math import cos, degrees, radians, sin, tan

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.annotations import world_box
from hearth.rendering.cameras.camera import Camera, follow, room_cameras
from hearth.rendering.models.looks import Model
from hearth.rendering.people.acting import Actor
from hearth.rendering.scene.scene import Scene
from hearth.schemas.graph import Box, EnvironmentGraph
from hearth.schemas.vocabulary import ROOM_CATEGORY

THUMBNAIL = (64, 48)
"""Size of the pictures by which cameras are compared, pixels."""

ENOUGH = 90
"""Pixels of a thumbnail from which on more of a thing adds nothing to a camera's score."""

SWITCH_PENALTY = 1.15
"""Factor by which another camera's score must be higher to switch to it."""


def home_box(graph: EnvironmentGraph) -> Box:
    """The box around all rooms."""
    boxes = [node.box for node in graph.nodes if node.category == ROOM_CATEGORY and node.box]
    low = [min(box.center[axis] - box.size[axis] / 2 for box in boxes) for axis in range(3)]
    high = [max(box.center[axis] + box.size[axis] / 2 for box in boxes) for axis in range(3)]
    middle, size = (
        [(a + b) / 2 for a, b in zip(low, high, strict=True)],
        [b - a for a, b in zip(low, high, strict=True)],
    )
    return Box((middle[0], middle[1], middle[2]), (size[0], size[1], size[2]))


def room_views(graph: EnvironmentGraph, width: int, height: int) -> Mapping[int, tuple[Camera, ...]]:
    """Room id -> its cameras, moved out of furniture."""
    boxes = [
        n.box
        for n in graph.nodes
        if n.box and n.category not in (ROOM_CATEGORY, "Characters") and min(n.box.size) > 0.1
    ]
    found: dict[int, tuple[Camera, ...]] = {}
    for node in graph.nodes:
        if node.category == ROOM_CATEGORY and node.box:
            cameras = room_cameras(node.box, f"{node.class_name}.{node.id}", width, height)
            found[node.id] = tuple(_freed(camera, boxes) for camera in cameras)
    return found


def _freed(camera: Camera, boxes: Sequence[Box], clear: float = 0.22) -> Camera:
    """The camera, moved towards its target until no box contains it."""
    eye, target = np.array(camera.eye), np.array(camera.target)
    way = (target - eye) * (1.0, 0.0, 1.0)
    for step in np.arange(0.0, 0.6, 0.05):
        at = eye + way * step
        if not any(all(abs(at[k] - box.center[k]) < box.size[k] / 2 + clear for k in range(3)) for box in boxes):
            return replace(camera, eye=(float(at[0]), float(at[1]), float(at[2])))
    return camera


def best_view(
    scene: Scene,
    views: Mapping[int, tuple[Camera, ...]],
    actor: Actor,
    named: Sequence[int],
    last: Camera | None = None,
    room: Box | None = None,
    wide: bool = False,
) -> Camera:
    """The camera that shows most of the actor and of the step's objects.

    Candidates are the cameras of the actor's room and two over its shoulders; thumbnails of node ids give their
    scores. The last camera is kept unless another exceeds it by `SWITCH_PENALTY`.

    Args:
        scene: of the keyframe.
        views: cameras by room, as `room_views` gives them.
        actor: the acting character.
        named: ids of the step's objects.
        last: the camera of the keyframe before.
        room: the box of the actor's room, which following cameras must not leave.
        wide: leave space around the actor, who is about to move, and use no camera that follows it.
    """
    cameras = views.get(actor.room, ())
    size = (cameras[0].width, cameras[0].height) if cameras else (320, 240)
    behind = [
        follow(f"follow.{side}", actor.position, actor.yaw + turn, *size)
        for side, turn in (("left", 40.0), ("right", -40.0))
    ]
    candidates = [*cameras, *(() if wide and cameras else (kept_inside(camera, room) for camera in behind))]
    turned = [aimed(camera, scene, actor, named, 1.2 if wide else 0.55) for camera in candidates]
    seen = thumbnails(scene, turned)
    values = [
        _score(scene, camera, ids, actor, named) * (SWITCH_PENALTY if last and camera.name == last.name else 1.0)
        for camera, ids in zip(turned, seen, strict=True)
    ]
    best = values.index(max(values))
    missed = () if wide else tuple(node for node in dict.fromkeys(named) if not (seen[best] == node).any())
    near = [camera for node in missed for camera in _close(scene, node, actor, room, size)]
    closer = [
        _score(scene, camera, ids, actor, named) for camera, ids in zip(near, thumbnails(scene, near), strict=True)
    ]
    return near[closer.index(max(closer))] if max(closer, default=0.0) > values[best] else turned[best]


AROUND = (0.0, 45.0, -45.0, 90.0, -90.0, 135.0, -135.0)
"""Degrees about an object, from its user's direction of view, at which close cameras are tried."""


def _close(scene: Scene, node: int, actor: Actor, room: Box | None, size: tuple[int, int]) -> Iterator[Camera]:
    """Cameras close to an object that no other camera shows: over its user's head and from all sides."""
    thing = scene.find(node)
    if thing is None:
        return
    box = world_box(thing)
    x, y, z = box.center
    away = max(box.size[0], box.size[2]) / 2 + 0.9
    for rise in (0.75, 0.2):
        for turn in AROUND:
            angle = radians(actor.yaw + 180 + turn)
            eye = (x + sin(angle) * away, min(y + rise * away, actor.level + 2.3), z + cos(angle) * away)
            yield kept_inside(Camera("close", eye, box.center, *size, fov=55.0), room)


def kept_inside(camera: Camera, room: Box | None) -> Camera:
    """The camera, pulled back into its room."""
    if room is None:
        return camera
    eye = [
        min(max(e, c - s / 2 + 0.15), c + s / 2 - 0.15)
        for e, c, s in zip(camera.eye, room.center, room.size, strict=True)
    ]
    return replace(camera, eye=(eye[0], eye[1], eye[2]))


def aimed(camera: Camera, scene: Scene, actor: Actor, named: Sequence[int], around: float = 0.55) -> Camera:
    """The camera turned towards the actor and the objects, with a field of view that contains both."""
    points = [actor.world((0.0, 0.9, 0.0)), actor.world((0.0, 0.3, 0.0)), actor.world((0.0, 1.6, 0.0))]
    for node_id in named:
        thing = scene.find(node_id)
        if thing is not None and np.hypot(thing.position[0] - actor.spot[0], thing.position[2] - actor.spot[1]) < 3.0:
            points.append(thing.position)
    cloud = np.array(points)
    middle = (cloud.min(axis=0) + cloud.max(axis=0)) / 2
    distance = float(np.linalg.norm(middle - np.array(camera.eye)))
    radius = float(np.linalg.norm(cloud - middle, axis=1).max()) + around
    fov = degrees(2 * np.arctan(radius / max(distance, 0.4)))
    # The middle between the action and the room's own view keeps the room recognisable.
    fov = float(np.clip(fov * 1.1, 38.0, 75.0))
    return replace(camera, target=(float(middle[0]), float(middle[1]), float(middle[2])), fov=fov)


def thumbnails(scene: Scene, cameras: Sequence[Camera]) -> list[NDArray[np.int64]]:
    """A small picture of node ids for each camera; 0 for the background."""
    if not cameras:
        return []
    width, height = THUMBNAIL
    small = [replace(camera, width=width, height=height) for camera in cameras]
    # All thumbnails are cast at once: a cast of few rays costs as much as one of many.
    hits = scene.geometry.cast(np.concatenate([camera.rays() for camera in small]))
    numbers = np.array([*(thing.id for thing in scene.geometry.things), 0])
    return list(numbers.take(scene.geometry.owner(hits.triangle), mode="wrap").reshape(len(small), -1))


def scores(scene: Scene, cameras: Sequence[Camera], actor: Actor, named: Sequence[int]) -> list[float]:
    """A score for each camera: up to 1 for the visible share of the actor, and 1.3 for each object of the step."""
    seen = thumbnails(scene, cameras)
    return [_score(scene, camera, ids, actor, named) for camera, ids in zip(cameras, seen, strict=True)]


def _score(scene: Scene, camera: Camera, ids: NDArray[np.int64], actor: Actor, named: Sequence[int]) -> float:
    focal = THUMBNAIL[1] / 2 / tan(radians(camera.fov) / 2)
    eye = np.array(camera.eye)
    total = min(int((ids == actor.node.id).sum()) / ENOUGH, 1.0)
    to_eye = eye - np.array(actor.position)
    front = np.array((np.sin(radians(actor.yaw)), 0.0, np.cos(radians(actor.yaw))))
    total *= 1 + 0.15 * float(to_eye @ front) / max(float(np.hypot(to_eye[0], to_eye[2])), 0.3)
    for node_id in dict.fromkeys(named):
        thing = scene.find(node_id)
        if thing is None or node_id == actor.node.id:
            continue
        size = thing.model.look.size if isinstance(thing.model, Model) else (0.5, 1.5, 0.5)
        far = max(float(np.linalg.norm(np.array(thing.position) - eye)), 0.3)
        whole = 0.3 * (focal / far) ** 2 * sorted(size)[1] * sorted(size)[2]
        total += 1.3 * min(int((ids == node_id).sum()) / max(min(whole, ENOUGH), 3.0), 1.0)
    return total
