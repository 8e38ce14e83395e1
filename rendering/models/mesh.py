"""Triangle meshes with paint, which recipes make and scenes consist of."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats

Shorts = NDArray[np.int16]

ATTRIBUTES = 5
"""Columns of `Mesh.surface`: linear red, green, blue, glow, shine."""


@dataclass(frozen=True, eq=False, slots=True)
class Mesh:
    """T triangles, each with its own corners; normals decide whether edges look sharp.

    Models stand on y = 0 around the origin, face +z, and are in metres.

    Attributes:
        corners: (T, 3, 3) positions.
        normals: (T, 3, 3) unit vectors, one per corner.
        uvs: (T, 3, 2) texture coordinates, in tiles of the texture.
        surface: (T, 5) linear colour, glow (emitted light) and shine (0 matt, 1 polished).
        textures: (T,) slots of `textures.SLOTS`.
    """

    corners: Floats
    normals: Floats
    uvs: Floats
    surface: Floats
    textures: Shorts

    def __len__(self) -> int:
        return len(self.corners)

    def bounds(self) -> tuple[Floats, Floats]:
        """Lowest and highest corner of the bounding box; zeros for an empty mesh."""
        if not len(self):
            return np.zeros(3, np.float32), np.zeros(3, np.float32)
        # Numbers that lie side by side are compared several times as fast.
        points = np.ascontiguousarray(self.corners.reshape(-1, 3).T)
        return points.min(axis=1), points.max(axis=1)


def empty() -> Mesh:
    """No triangles."""
    return Mesh(
        np.zeros((0, 3, 3), np.float32),
        np.zeros((0, 3, 3), np.float32),
        np.zeros((0, 3, 2), np.float32),
        np.zeros((0, ATTRIBUTES), np.float32),
        np.zeros(0, np.int16),
    )


def join(meshes: Iterable[Mesh]) -> Mesh:
    """One mesh with the triangles of all meshes, in order."""
    parts = [mesh for mesh in meshes if len(mesh)]
    if not parts:
        return empty()
    if len(parts) == 1:
        return parts[0]
    return Mesh(
        np.concatenate([mesh.corners for mesh in parts]),
        np.concatenate([mesh.normals for mesh in parts]),
        np.concatenate([mesh.uvs for mesh in parts]),
        np.concatenate([mesh.surface for mesh in parts]),
        np.concatenate([mesh.textures for mesh in parts]),
    )


def shift(mesh: Mesh, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Mesh:
    """Return the mesh translated by (x, y, z) metres."""
    return replace(mesh, corners=mesh.corners + np.array((x, y, z), np.float32))


def transform(mesh: Mesh, matrix: Floats, offset: Iterable[float] = (0.0, 0.0, 0.0)) -> Mesh:
    """Return the mesh rotated by `matrix` (3, 3), then translated by `offset`."""
    turn_ = np.asarray(matrix, np.float32).T
    # One product of all points takes a quarter of the time of one for each triangle.
    corners, normals = ((a.reshape(-1, 3) @ turn_).reshape(a.shape) for a in (mesh.corners, mesh.normals))
    return replace(mesh, corners=corners + np.array(tuple(offset), np.float32), normals=normals)


def stretch(mesh: Mesh, x: float = 1.0, y: float = 1.0, z: float = 1.0) -> Mesh:
    """Return the mesh scaled along the axes about the origin; normals stay perpendicular to their surfaces."""
    scale = np.array((x, y, z), np.float32)
    normals = mesh.normals / scale
    normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-9)
    return replace(mesh, corners=mesh.corners * scale, normals=normals)


def rotation(axis: str, degrees: float) -> Floats:
    """Return the rotation by `degrees` about `axis` (x, y or z), right-handed: y by 90 maps +z to +x."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    rows = {
        "x": ((1, 0, 0), (0, c, -s), (0, s, c)),
        "y": ((c, 0, s), (0, 1, 0), (-s, 0, c)),
        "z": ((c, -s, 0), (s, c, 0), (0, 0, 1)),
    }
    return np.array(rows[axis], np.float32)


def turn(mesh: Mesh, axis: str, degrees: float, about: Iterable[float] = (0.0, 0.0, 0.0)) -> Mesh:
    """Return the mesh rotated by `degrees` about the line through `about` along `axis`."""
    pivot = np.array(tuple(about), np.float32)
    matrix = rotation(axis, degrees)
    return transform(mesh, matrix, pivot - matrix @ pivot)
