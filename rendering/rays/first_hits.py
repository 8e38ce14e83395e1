"""First hits of a camera's rays by rasterising, several times as fast as casting them.

Triangles and depths are those of `ray_casting`, but where two triangles are equally near either may win.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats, Ints
from hearth.rendering.cameras.camera import NEAREST, Camera
from hearth.rendering.rays import rasterizer
from hearth.rendering.rays.ray_casting import Hits
from hearth.rendering.rays.reused_arrays import scratch
from hearth.rendering.rays.threads import count, each

if TYPE_CHECKING:
    from hearth.rendering.scene.triangles import Numbers, Part

BANDS = 4
"""Bands of rows for each processor: their work differs."""

AT_CUT = 1e-4
"""Metres above the cut of a view from above up to which surfaces are drawn: many lie exactly at it."""

NO_TILES: Floats = np.zeros((0, 0), np.float32)


def drawable(camera: Camera) -> bool:
    """Return whether a camera's rays begin at one depth: those of views from above do if they look straight down."""
    return camera.cut is None or (camera.eye[0], camera.eye[2]) == (camera.target[0], camera.target[2])


class Canvas:
    """The nearest triangle of each pixel, of the things drawn so far by a camera.

    Attributes:
        camera: the camera.
        depth: (H, W) inverse depth.
        triangle: (H, W) index in the part that was drawn, -1 for none.
    """

    def __init__(self, camera: Camera, use: str) -> None:
        self.camera, self.use = camera, use
        size = (camera.height, camera.width)
        self.depth, self.triangle = scratch(f"{use} depth", *size), scratch(f"{use} triangle", *size, dtype=np.int32)
        self.depth[:], self.triangle[:] = 0, -1
        pose = camera.pose
        numbers = (*camera.eye, *pose[:3, 0], *pose[:3, 1], *pose[:3, 2], camera.intrinsics[0, 0])
        self.frame = np.array(numbers, np.float64)
        self.near = NEAREST if camera.cut is None else camera.eye[1] - camera.cut - AT_CUT

    def viewed(self, part: Part, things: Numbers, tiles: Floats = NO_TILES) -> Numbers:
        """Those of some things that may cover pixels; hidden ones are left out if `tiles` are given."""
        found = np.empty(len(things), np.int64)
        where = (self.frame, self.camera.width, self.camera.height, self.near)
        return found[: rasterizer.in_view(part.extents, things, *where, tiles, found)]

    def tiles(self) -> Floats:
        """Return the least inverse depth of each tile."""
        rows, columns = (-(-side // rasterizer.TILE) for side in self.depth.shape)
        found = scratch(f"{self.use} tiles", rows, columns)
        rasterizer.farthest(self.depth, 0, len(self.depth), found)
        return found

    def draw(self, part: Part, things: Numbers) -> None:
        """Draw some things of a part."""
        if not len(things):
            return
        sums = np.cumsum((part.ends - part.starts)[things])
        share = -(-int(sums[-1]) // count()) if sums[-1] > SEVERAL else int(sums[-1])
        shares = np.split(things, np.searchsorted(sums, np.arange(share, sums[-1], share)))
        size = (self.camera.width, self.camera.height)
        memory = [self._memory(part, some, number) for number, some in enumerate(shares)]

        def projected(number: int) -> int:
            where = (part.mesh.corners, part.starts, part.ends, shares[number], self.frame, *size, self.near)
            return rasterizer.project(*where, *memory[number])

        filled = each(projected, range(len(shares)))

        def work(band: tuple[int, int]) -> None:
            for known, number in zip(memory, filled, strict=True):
                rasterizer.fill(*known, number, *band, self.depth, self.triangle)

        each(work, bands(self.camera.height))

    def _memory(self, part: Part, things: Numbers, number: int) -> tuple[NDArray[Any], NDArray[Any]]:
        size = 2 * int((part.ends - part.starts)[things].sum())
        records = scratch(f"{self.use} records {number}", size, rasterizer.RECORD, dtype=np.float64)
        return records, scratch(f"{self.use} places {number}", size, rasterizer.PLACE, dtype=np.int32)


SEVERAL = 2000
"""Triangles from which on several threads project them."""


def bands(height: int) -> list[tuple[int, int]]:
    """Return the rows of a picture, in bands for threads."""
    size = -(-height // (BANDS * count()))
    return [(top, min(top + size, height)) for top in range(0, height, size)]


def static_hits(part: Part, camera: Camera, rays: Floats, hits: Hits) -> None:
    """Fill in the hits of all of a camera's rays on a part's things."""
    canvas = Canvas(camera, "static")
    canvas.draw(part, canvas.viewed(part, part.building))
    canvas.draw(part, canvas.viewed(part, part.furnishing, canvas.tiles()))
    flat, width, corners = canvas.triangle.reshape(-1), camera.width, part.mesh.corners

    def work(band: tuple[int, int]) -> None:
        rasterizer.resolve(flat, band[0] * width, band[1] * width, corners, rays, *hits)

    each(work, bands(camera.height))


def moving_hits(part: Part, camera: Camera, rays: Floats, first: int, hits: Hits) -> Ints:
    """Replace hits on static things by nearer hits on a part's things; returns the changed pixels.

    Args:
        part: moving things.
        camera, rays: the camera, and the rays of all its pixels.
        first: index of the part's first triangle.
        hits: of all pixels; changed.
    """
    canvas = Canvas(camera, "moving")
    # In the order of `static_hits`, which decides ties.
    canvas.draw(part, canvas.viewed(part, np.concatenate((part.building, part.furnishing))))
    extents = np.array([camera.extent(box) for box in part.boxes], np.int64).reshape(-1, 4)
    (left, top), (right, bottom) = extents[:, :2].min(axis=0), extents[:, 2:].max(axis=0)
    won = np.empty(len(rays), np.int32)
    where = (int(top), int(bottom), int(left), int(right), camera.width)
    changed = rasterizer.nearer_hits(canvas.triangle.reshape(-1), *where, part.mesh.corners, first, rays, *hits, won)
    return won[:changed].copy()
