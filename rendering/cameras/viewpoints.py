"""The cameras of a home, and the choice of the one that best shows a step (thesis 2.4.1)."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from hearth.rendering.cameras.camera import Camera, follow, point_of, room_cameras
from hearth.rendering.cameras.camera_candidates import around, free, preference
from hearth.rendering.cameras.recognition import in_the_way, shows
from hearth.rendering.cameras.visibility_estimates import Obstacles, Target, person, thing, values
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.rays.camera_shot import shoot
from hearth.rendering.scene.scene import Scene
from hearth.schemas.graph import Box, EnvironmentGraph
from hearth.schemas.vocabulary import ROOM_CATEGORY

JUDGED = (160, 120)
"""Size of the pictures by which cameras are judged, pixels."""

NEARER = np.arange(0.0, 0.8, 0.05)
"""Shares of the way to the person by which the third-person camera may be nearer."""

CLEAR = 0.22
"""Least distance between a camera and furniture, metres."""

LOOKED_AT = 16
"""Number of the best cameras whose pictures are looked at."""


def home_box(graph: EnvironmentGraph) -> Box:
    """Return the box around all rooms."""
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
    boxes = bulky(graph)
    found: dict[int, tuple[Camera, ...]] = {}
    for node in graph.nodes:
        if node.category == ROOM_CATEGORY and node.box:
            cameras = room_cameras(node.box, f"{node.class_name}.{node.id}", width, height)
            found[node.id] = tuple(freed(camera, boxes) for camera in cameras)
    return found


def bulky(graph: EnvironmentGraph) -> list[Box]:
    """Return the boxes in which no camera can stand."""
    bodies = (ROOM_CATEGORY, "Characters")
    return [n.box for n in graph.nodes if n.box and n.category not in bodies and min(n.box.size) > 0.1]


def freed(camera: Camera, boxes: Sequence[Box], clear: float = CLEAR) -> Camera:
    """Return the camera, moved towards its target until no box contains it."""
    eye, target = np.array(camera.eye), np.array(camera.target)
    way = (target - eye) * (1.0, 0.0, 1.0)
    for step in np.arange(0.0, 0.6, 0.05):
        at = eye + way * step
        if not any(all(abs(at[k] - box.center[k]) < box.size[k] / 2 + clear for k in range(3)) for box in boxes):
            return replace(camera, eye=(float(at[0]), float(at[1]), float(at[2])))
    return camera


def behind(
    name: str, actor: Actor, scene: Scene, size: tuple[int, int], room: Box | None, boxes: Sequence[Box]
) -> Camera:
    """Return the third-person camera of a character, nearer where furniture has its place or hides the head.

    Args:
        name: of the camera.
        actor: as the character stands now.
        scene: as it is now; an open door hides, too.
        size: width and height of the pictures.
        room: the box that the camera must not leave; None for any place.
        boxes: in which no camera can stand.
    """
    camera = kept_inside(follow(name, actor.position, actor.yaw, *size), room)
    head = np.array(actor.figure().joints()["head"])
    head = np.array(actor.world((float(head[0]), float(head[1]), float(head[2]))))
    ways = (head - camera.eye) * (1.0, 0.0, 1.0)
    eyes = np.array(camera.eye) + ways * NEARER[:, None]
    rays = np.concatenate((eyes, head - eyes), axis=1).astype(np.float32)
    distances, ids = Obstacles.exact(scene).cast(rays)
    seen = (ids == actor.node.id) | (distances >= 1)
    middles, halves = (np.array([getattr(box, key) for box in boxes]).reshape(-1, 3) for key in ("center", "size"))
    inside = (abs(eyes[:, None] - middles) < halves / 2 + CLEAR).all(axis=2).any(axis=1)
    fit = np.flatnonzero(seen & ~inside)
    chosen = eyes[fit[0]] if len(fit) else eyes[0]
    return replace(camera, eye=point_of(chosen))


def best_view(
    scene: Scene,
    views: Mapping[int, tuple[Camera, ...]],
    actor: Actor,
    named: Sequence[int],
    room: Box | None = None,
) -> Camera:
    """Return the camera that shows best what an actor does.

    Candidates stand around the actor and the objects, and where the room's fixed cameras are, with nothing close in
    front of them. The first of the best that shows the actor and all objects recognisably, by its pixels, is chosen.

    Args:
        scene: of the keyframe.
        views: cameras by room, as `room_views` gives them.
        actor: the acting character.
        named: ids of the step's objects.
        room: the box of the actor's room, which cameras must not leave.
    """
    fixed = views.get(actor.room, ())
    size = (fixed[0].width, fixed[0].height) if fixed else (320, 240)
    who, targets = person(actor), [thing(scene, node) for node in dict.fromkeys(named) if node != actor.node.id]
    objects = [target for target in targets if target is not None]
    obstacles = Obstacles.exact(scene)
    cameras, loss = free([*around(actor, who, objects, room, size, "near", closer=True), *fixed], obstacles)
    if not cameras:
        cameras, loss = [*fixed] or [follow("follow", actor.position, actor.yaw, *size)], np.zeros(1)
    worth = (values(cameras, who, objects, obstacles).total - loss) * preference(cameras, actor)
    best: list[Camera] = [cameras[number] for number in np.argsort(-worth, kind="stable")[:LOOKED_AT].tolist()]
    return next((camera for camera in best if _shows(scene, camera, actor, objects)), best[0])


def _shows(scene: Scene, camera: Camera, actor: Actor, objects: Sequence[Target]) -> bool:
    shot = shoot(scene, replace(camera, width=JUDGED[0], height=JUDGED[1]))
    return not in_the_way(shot) and shows(shot, actor.node.id, tuple(target.node for target in objects))


def kept_inside(camera: Camera, room: Box | None) -> Camera:
    """Return the camera, pulled back into its room."""
    if room is None:
        return camera
    eye = [
        min(max(e, c - s / 2 + 0.15), c + s / 2 - 0.15)
        for e, c, s in zip(camera.eye, room.center, room.size, strict=True)
    ]
    return replace(camera, eye=(eye[0], eye[1], eye[2]))
