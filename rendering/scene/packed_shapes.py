"""Shapes of things as a few bytes, for pages that draw them with WebGL: corners are shared, light is baked in."""

import base64
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.rendering.models.mesh import Mesh
from hearth.rendering.scene.instances import Thing, own_mesh, placed

UNIT = 0.002
"""Metres of one step of a coordinate; 16 bits reach 65 metres."""

SUN = np.array((-0.35, 0.85, -0.4), np.float32) / np.float32(np.linalg.norm((0.35, 0.85, 0.4)))
"""Towards the sun of the baked light."""


class PackedShapes:
    """Shapes by number, each once.

    A shape is the positions of its corners, the light on each, and a pattern: which corners its triangles have, and
    their colours. A body in another pose is another shape of the same pattern.
    """

    def __init__(self) -> None:
        self._numbers: dict[Any, int] = {}
        self._patterns: dict[bytes, int] = {}
        self._shapes: list[list[int]] = []
        self._rows: list[list[int]] = []
        self._data: list[bytes] = []
        self._size = 0

    def __len__(self) -> int:
        return len(self._shapes)

    def add(self, thing: Thing) -> int:
        """Return the number of a thing's shape, in its own frame; of parts of the building, where they stand."""
        key = thing if thing.structural else (thing.model, thing.tilt)
        if key not in self._numbers:
            self._numbers[key] = self._added(placed(thing) if thing.structural else own_mesh(thing))
        return self._numbers[key]

    def _added(self, mesh: Mesh) -> int:
        first, corner_of = _corners(mesh)
        positions = np.clip(np.round(mesh.corners.reshape(-1, 3)[first] / UNIT), -32768, 32767).astype(np.int16)
        light = _light(mesh.normals.reshape(-1, 3)[first])
        base = _colours(mesh)[first // 3]
        pattern = self._pattern(corner_of, base)
        self._shapes.append([pattern, self._put(positions.T.tobytes()), self._put(light.tobytes())])
        return len(self._shapes) - 1

    def _pattern(self, corner_of: NDArray[np.int64], base: NDArray[np.uint8]) -> int:
        index, colours = corner_of.astype(np.uint16 if len(base) <= 65_536 else np.uint32).tobytes(), base.T.tobytes()
        key = index + colours
        if key not in self._patterns:
            self._patterns[key] = len(self._rows)
            self._rows.append([len(base), len(corner_of), self._put(index), self._put(colours)])
        return self._patterns[key]

    def _put(self, data: bytes) -> int:
        """Keep bytes; where they begin, a multiple of 4."""
        data += b"\0" * (-len(data) % 4)
        self._data.append(data)
        self._size += len(data)
        return self._size - len(data)

    def as_json(self) -> dict[str, Any]:
        """As `assets/replay.js` of the report reads it.

        `patterns`: number of corners and of corners of triangles, and where those and the colours begin in `data`;
        `shapes`: pattern, and where positions and light begin; `data`: bytes, deflated, in base 64.
        """
        data = base64.b64encode(zlib.compress(b"".join(self._data), 9)).decode()
        return {"unit": UNIT, "patterns": self._rows, "shapes": self._shapes, "data": data}


def _corners(mesh: Mesh) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Corners that differ in place, normal or colour, by where they come first; and the number of each of all."""
    surface = np.repeat(mesh.surface, 3, axis=0)
    rows = np.column_stack((mesh.corners.reshape(-1, 3), mesh.normals.reshape(-1, 3), surface))
    _, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return first[order], rank[inverse.ravel()]


def _light(normals: Floats) -> NDArray[np.uint8]:
    """Sky, and sun from one side, on surfaces of these normals; 200 is full light."""
    light = 0.55 + 0.16 * normals[:, 1] + 0.34 * np.maximum(0, normals @ SUN) + 0.05 * normals[:, 0]
    found: NDArray[np.uint8] = np.clip(light * 200, 0, 255).astype(np.uint8)
    return found


def _colours(mesh: Mesh) -> NDArray[np.uint8]:
    """(T, 3) colours in sRGB, with their glow."""
    linear = np.clip(mesh.surface[:, :3] * (1 + mesh.surface[:, 3:4]), 0, 1)
    srgb = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)
    found: NDArray[np.uint8] = np.round(srgb * 255).astype(np.uint8)
    return found
