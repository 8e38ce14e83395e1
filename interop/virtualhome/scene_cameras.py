"""Cameras of a Unity scene: those of rooms, those that clients add, and those that go with each character."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import cos, radians, sin
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.cameras.camera import Camera, top_view
from hearth.rendering.cameras.viewpoints import behind, bulky, freed, home_box, kept_inside, room_views
from hearth.rendering.film.video import first_person
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.scene.scene import Scene
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box, EnvironmentGraph, Point
from hearth.schemas.vocabulary import ROOM_CATEGORY

NEAR, FAR = 0.1, 100.0
"""Clipping planes in the projection matrices that clients get, metres."""

MOST_ADDED = 200
"""Cameras that clients may add."""


class Mount(NamedTuple):
    """A camera's place, its rotation in degrees about x (down), y (right) and z, and its vertical field."""

    position: Point
    rotation: Point
    field: float = 60.0


class Surroundings(NamedTuple):
    """The boxes of rooms, by id, that a camera must not leave, and those of things, in which it must not stand."""

    rooms: Mapping[int, Box | None]
    things: list[Box]

    @classmethod
    def of(cls, graph: EnvironmentGraph) -> Surroundings:
        """Return those of a home."""
        rooms = {node.id: node.box for node in graph.nodes if node.category == ROOM_CATEGORY}
        return cls(rooms, bulky(graph))

    def freed(self, camera: Camera, room: int) -> Camera:
        """Return a camera, moved into a room and out of its things."""
        return freed(kept_inside(camera, self.rooms.get(room)), self.things)


OWN_MOUNTS: Mapping[str, Mount] = MappingProxyType(
    {
        # In front of the head, which would else hide the hands.
        "PERSON_TOP": Mount((0.0, 2.35, 0.3), (84.0, 0.0, 0.0), 80.0),
        "PERSON_FRONT": Mount((0.0, 1.55, 0.15), (15.0, 0.0, 0.0), 82.0),
        "PERSON_LEFT": Mount((-0.1, 1.55, 0.0), (15.0, -90.0, 0.0), 82.0),
        "PERSON_RIGHT": Mount((0.1, 1.55, 0.0), (15.0, 90.0, 0.0), 82.0),
        "PERSON_FROM_BACK": Mount((0.0, 1.9, -1.7), (25.0, 0.0, 0.0), 65.0),
        "PERSON_FROM_LEFT": Mount((-1.7, 1.7, 0.4), (22.0, 90.0, 0.0), 65.0),
    }
)
"""The cameras of each character, in the order of Unity."""


def mounted(name: str, mount: Mount, size: tuple[int, int]) -> Camera:
    """Return a camera at a place, turned as Unity turns: about z first, then x, then y."""
    pitch, yaw, roll = (radians(angle) for angle in mount.rotation)
    forward = np.array((sin(yaw) * cos(pitch), -sin(pitch), cos(yaw) * cos(pitch)))
    right = np.array((cos(yaw), 0.0, -sin(yaw)))
    up = np.cross(forward, right)
    up = up * cos(roll) - right * sin(roll)
    eye = np.array(mount.position)
    return Camera(name, _point(eye), _point(eye + forward), *size, mount.field, None, _point(up))


def fixed_cameras(graph: EnvironmentGraph) -> tuple[Camera, ...]:
    """Return the cameras of a home: eight of each room, then the one above all."""
    found = [camera for cameras in room_views(graph, 640, 480).values() for camera in cameras]
    return (*found, top_view(home_box(graph), "top", 640, 480))


def of_size(camera: Camera, size: tuple[int, int], graph: EnvironmentGraph) -> Camera:
    """Return a camera with pictures of another size; the one above everything keeps the home in the picture."""
    if camera.name == "top":
        return top_view(home_box(graph), "top", *size)
    return replace(camera, width=size[0], height=size[1])


def on_person(
    name: str, mounts: Mapping[str, Mount], actor: Actor, scene: Scene, around: Surroundings, size: tuple[int, int]
) -> Camera:
    """Return a camera of a character, as the character stands, sits or lies now."""
    mount = mounts[name]
    if mount is OWN_MOUNTS.get("PERSON_FRONT"):
        return replace(first_person(actor, size), name=name)
    if mount is OWN_MOUNTS.get("PERSON_FROM_BACK"):
        return behind(name, actor, scene, size, around.rooms.get(actor.room), around.things)
    pitch, yaw, roll = mount.rotation
    turned = Mount(actor.world(mount.position), (pitch, yaw + actor.yaw, roll), mount.field)
    camera = mounted(name, turned, size)
    if mount is OWN_MOUNTS.get("PERSON_TOP"):
        return kept_inside(camera, around.rooms.get(actor.room))
    return around.freed(camera, actor.room) if "_FROM_" in name else camera


def data_of(index: int, camera: Camera) -> dict[str, Any]:
    """Return a camera as Unity describes it: column-major matrices of OpenGL, z backwards."""
    view = np.diag((1.0, 1.0, -1.0, 1.0)) @ np.linalg.inv(camera.pose)
    return {
        "index": index,
        "name": camera.name,
        "aspect": camera.width / camera.height,
        "field_of_view": camera.fov,
        "projection_matrix": _columns(_projection(camera)),
        "world_to_camera_matrix": _columns(view),
    }


def check_indices(indices: Sequence[int], count: int) -> None:
    """Check that there are cameras of some numbers.

    Raises:
        HearthError: UNKNOWN_ID.
    """
    for index in indices:
        if not 0 <= index < count:
            raise HearthError.of(Code.UNKNOWN_ID, f"no camera {index}", suggestion=f"cameras are 0 to {count - 1}")


def _projection(camera: Camera) -> NDArray[np.float64]:
    across = 1 / np.tan(radians(camera.fov) / 2)
    matrix = np.zeros((4, 4))
    matrix[0, 0], matrix[1, 1] = across * camera.height / camera.width, across
    matrix[2, 2], matrix[2, 3] = -(FAR + NEAR) / (FAR - NEAR), -2 * FAR * NEAR / (FAR - NEAR)
    matrix[3, 2] = -1.0
    return matrix


def _columns(matrix: NDArray[np.float64]) -> list[float]:
    return [round(float(value), 6) + 0.0 for value in matrix.T.ravel()]


def _point(vector: NDArray[np.float64]) -> Point:
    return float(vector[0]), float(vector[1]), float(vector[2])
