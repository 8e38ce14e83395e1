"""Ray casting against triangles with open3d (Embree), which no other file imports."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import cache
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.rendering.rays.reused_arrays import keep
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library

SYSTEM_LIBRARIES = "libusb-1.0-0 libgl1 libegl1 libx11-6 libgomp1"
"""Debian packages that open3d is linked against."""


@cache
def engine() -> Any:
    """Return the module open3d.

    Raises:
        HearthError: it, or a system library that it needs, is not installed; the suggestion names the package.
    """
    # The package's viewers import a web server, which takes longer than everything else.
    viewers = "open3d.visualization"
    skipped = viewers not in sys.modules
    if skipped:
        sys.modules[viewers] = ModuleType(viewers)
    try:
        open3d = library("open3d")
    except (ImportError, OSError) as error:
        remedy = f"apt-get install -y --no-install-recommends {SYSTEM_LIBRARIES}"
        message = f"open3d is installed, but a system library it needs is not: {error}"
        raise HearthError.of(Code.NOT_RENDERED, message, suggestion=remedy) from error
    finally:
        if skipped:
            sys.modules.pop(viewers, None)
    keep()
    return open3d


class Hits(NamedTuple):
    """First hits of N rays.

    Attributes:
        distance: (N,) in units of the ray's direction; infinite without a hit.
        triangle: (N,) index of the triangle; -1 without a hit.
        u, v: (N,) barycentric weights of its second and third corner.
    """

    distance: Floats
    triangle: NDArray[np.int32]
    u: Floats
    v: Floats

    @classmethod
    def none(cls, size: int) -> Hits:
        """Hits of `size` rays that hit nothing."""
        far, flat = np.full(size, np.inf, np.float32), np.zeros(size, np.float32)
        return cls(far, np.full(size, -1, np.int32), flat, flat.copy())

    def copy(self) -> Hits:
        """Return a writable copy."""
        return Hits(self.distance.copy(), self.triangle.copy(), self.u.copy(), self.v.copy())


NO_TRIANGLE = 0xFFFFFFFF
"""Embree's triangle index for a ray that hits nothing; -1 as a signed number."""


@dataclass(frozen=True, eq=False)
class Caster:
    """Triangles for ray casting. Rays are (N, 6) float32: origins x, y, z and directions x, y, z.

    Embree spreads a cast over all processors and holds the interpreter's lock; our threads would not be parallel.
    """

    count: int
    scene: Any

    @classmethod
    def of(cls, corners: Floats) -> Caster:
        """Return a caster of triangles with (T, 3, 3) corners."""
        core, geometry = engine().core, engine().t.geometry
        scene = geometry.RaycastingScene(1 if len(corners) < SMALL else 0)
        if len(corners):
            points = np.ascontiguousarray(corners.reshape(-1, 3), np.float32)
            indices = np.arange(len(points), dtype=np.uint32).reshape(-1, 3)
            scene.add_triangles(core.Tensor.from_numpy(points), core.Tensor.from_numpy(indices))
        return cls(len(corners), scene)

    def raw(self, rays: Floats) -> tuple[Floats, NDArray[np.uint32], Floats]:
        """(N,) distances, (N,) triangles and (N, 2) weights of the first hits; infinite distance without a hit."""
        size = len(rays)
        if not self.count or not size:
            nothing = np.full(size, NO_TRIANGLE, np.uint32)
            return np.full(size, np.inf, np.float32), nothing, np.zeros((size, 2), np.float32)
        answer = self.scene.cast_rays(engine().core.Tensor.from_numpy(rays), ALL)
        return answer["t_hit"].numpy(), answer["primitive_ids"].numpy(), answer["primitive_uvs"].numpy()

    def cast(self, rays: Floats) -> Hits:
        """Return the first hit of each of (N, 6) rays."""
        distance, number, uvs = self.raw(rays)
        return Hits(distance, number.view(np.int32), np.ascontiguousarray(uvs[:, 0]), np.ascontiguousarray(uvs[:, 1]))

    def occluded(self, rays: Floats, far: float = 0.999) -> NDArray[np.bool_]:
        """(N,) whether anything lies between origins and origin + far * direction of (N, 6) rays."""
        if not self.count or not len(rays):
            return np.zeros(len(rays), np.bool_)
        tensor = engine().core.Tensor.from_numpy(rays)
        found: NDArray[np.bool_] = self.scene.test_occlusions(tensor, 0.0, far, ALL).numpy()
        return found


ALL = 0
"""open3d's number for one thread per processor."""

SMALL = 20_000
"""Number of triangles up to which one thread builds the tree."""
