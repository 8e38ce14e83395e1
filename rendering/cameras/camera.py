"""Pinhole cameras (thesis 2.4.1, 4.4).

The world is left-handed, as in Unity: x east, y up, z north. The camera's frame is left-handed too: x right, y up,
z forward. Poses are proper rotations; the intrinsics flip y into image rows.
"""

from dataclasses import dataclass
from functools import cached_property
from math import atan, degrees, radians, tan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.schemas.graph import Box, Point


@dataclass(frozen=True)
class Camera:
    """A pinhole camera without distortion.

    Attributes:
        name: `top`, `kitchen.corner.2`, ...
        eye, target: its position, and the point in the middle of the picture, metres.
        width, height: size of the image, pixels.
        fov: vertical field of view, degrees.
        cut: height above which walls, ceilings and hanging things are removed, metres; None removes nothing.
        up: the direction shown upwards.
    """

    name: str
    eye: Point
    target: Point
    width: int = 320
    height: int = 240
    fov: float = 60.0
    cut: float | None = None
    up: Point = (0.0, 1.0, 0.0)

    @cached_property
    def intrinsics(self) -> NDArray[np.float64]:
        """(3, 3) matrix from camera coordinates to pixels; pixel (0, 0) has its centre at (0.5, 0.5)."""
        focal = self.height / 2 / tan(radians(self.fov) / 2)
        return np.array([[focal, 0, self.width / 2], [0, -focal, self.height / 2], [0, 0, 1]])

    @cached_property
    def pose(self) -> NDArray[np.float64]:
        """(4, 4) matrix from camera to world coordinates."""
        eye = np.array(self.eye, np.float64)
        forward = np.array(self.target) - eye
        forward /= np.linalg.norm(forward)
        right = np.cross(np.array(self.up), forward)
        right /= np.linalg.norm(right)
        matrix = np.eye(4)
        matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = right, np.cross(forward, right), forward, eye
        return matrix

    def rays(self, offset: tuple[float, float] = (0.5, 0.5)) -> Floats:
        """(height * width, 6) origins and directions, one ray per pixel; directions have camera-space z = 1."""
        from hearth.rendering.rays.kernels import ray_grid

        pose = self.pose
        frame = np.array([*self.eye, *pose[:3, 0], *pose[:3, 1], *pose[:3, 2], self.intrinsics[0, 0]], np.float32)
        rays = np.empty((self.height * self.width, 6), np.float32)
        ray_grid(frame, self.width, self.height, np.array(offset, np.float32), rays)
        return rays

    def project(self, points: NDArray[np.floating[Any]]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(N, 2) pixels and (N,) depths of (N, 3) world points."""
        local = (np.asarray(points) - self.pose[:3, 3]) @ self.pose[:3, :3]
        image = local @ self.intrinsics.T
        return image[:, :2] / image[:, 2:], local[:, 2]

    def extent(self, box: Floats) -> tuple[int, int, int, int]:
        """(left, top, right, bottom) of the pixels that a box (low and high corners) can cover; ends excluded."""
        x, y, z = ((box[axis], box[axis + 3]) for axis in range(3))
        places, depths = self.project(np.array([(a, b, c) for a in x for b in y for c in z], np.float64))
        if depths.max() <= 0:
            return 0, 0, 0, 0
        if depths.min() < NEAREST:
            return 0, 0, self.width, self.height
        limit = (self.width, self.height)
        low = np.clip(np.floor(places.min(axis=0)) - 1, 0, limit).astype(int)
        high = np.clip(np.ceil(places.max(axis=0)) + 1, 0, limit).astype(int)
        return int(low[0]), int(low[1]), int(high[0]), int(high[1])


NEAREST = 0.01
"""Near plane, metres."""


TOP_FOV = 14.0
"""Degrees; narrow, so that walls hide little in a view from above."""

FARTHEST = 62.0
"""Greatest depth in metres: depth is published as 16-bit millimetres."""

CUT = 2.2
"""Metres at which a view from above cuts walls."""


def top_view(box: Box, name: str = "top", width: int = 320, height: int = 240, margin: float = 0.3) -> Camera:
    """Bird's eye over a box (of a home or a room), all of it in the picture.

    North is up; where the box is longer that way, north is to the right.
    """
    (x, y, z), (w, h, d) = box.center, box.size
    across, down = w + 2 * margin, d + 2 * margin
    turned = (w > d) != (width > height) and abs(w - d) > 0.1
    if turned:
        across, down = down, across
    half = max(down, across * height / width) / 2
    floor = y - h / 2
    # Things at the cut are nearest to the camera and look largest, so the plane of the cut has to fit.
    distance = min(half / tan(radians(TOP_FOV) / 2) + CUT, FARTHEST)
    fov = 2 * degrees(atan(half / (distance - CUT)))
    up = (-1.0, 0.0, 0.0) if turned else (0.0, 0.0, 1.0)
    return Camera(name, (x, floor + distance, z), (x, floor, z), width, height, fov, floor + CUT, up)


def look_at(name: str, eye: Point, target: Point, width: int = 320, height: int = 240, fov: float = 60.0) -> Camera:
    """Return a camera at `eye` that looks at `target`."""
    return Camera(name, eye, target, width, height, fov)


def point_of(vector: NDArray[Any]) -> Point:
    """Return a vector as a tuple of floats."""
    return float(vector[0]), float(vector[1]), float(vector[2])


ROOM_FOV = 68.0
ROOM_HEIGHT = 2.05
ROOM_INSET = 0.25


def room_cameras(room: Box, name: str, width: int = 320, height: int = 240) -> tuple[Camera, ...]:
    """Eight fixed cameras under a room's ceiling: in its corners, then at the middles of its walls."""
    (x, y, z), (w, h, d) = room.center, room.size
    floor = y - h / 2
    up = floor + min(ROOM_HEIGHT, h - 0.15)
    cameras = []
    for number, (i, j) in enumerate(((-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0)), 1):
        eye = (x + i * (w / 2 - ROOM_INSET), up, z + j * (d / 2 - ROOM_INSET))
        target = (x - i * w * 0.12, floor + 0.75, z - j * d * 0.12)
        cameras.append(Camera(f"{name}.{number}", eye, target, width, height, ROOM_FOV))
    return tuple(cameras)


def follow(name: str, position: Point, yaw: float, width: int = 320, height: int = 240) -> Camera:
    """Third-person camera: behind and above a character at `position` (on the floor) that faces `yaw` degrees."""
    forward = np.array((np.sin(radians(yaw)), 0.0, np.cos(radians(yaw))))
    eye = np.array(position) - forward * 1.7 + (0.0, 1.9, 0.0)
    target = np.array(position) + forward * 0.5 + (0.0, 0.9, 0.0)
    return Camera(name, point_of(eye), point_of(target), width, height, 65.0)
