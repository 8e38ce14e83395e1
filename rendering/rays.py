"""Casting rays at triangles: the only place that needs open3d (Embree)."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import cache
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.schemas.errors import HearthError
from hearth.schemas.failures import Code

Floats = NDArray[np.floating[Any]]

SYSTEM_LIBRARIES = "libusb-1.0-0 libgl1 libegl1 libx11-6 libgomp1"
"""Debian packages that open3d is linked against."""


@cache
def engine() -> Any:
    """The module open3d.

    Raises:
        HearthError: it is not installed, or a system library it needs is missing; says what to install.
    """
    # The package's viewers import a web server, which takes longer than all the rest.
    viewers = "open3d.visualization"
    skipped = viewers not in sys.modules
    if skipped:
        sys.modules[viewers] = ModuleType(viewers)
    try:
        import open3d
    except ModuleNotFoundError as error:
        remedy = "pip install open3d-cpu (Linux on x86-64, glibc 2.35 or newer)"
        raise HearthError.of(Code.NOT_RENDERED, "drawing pictures needs open3d", suggestion=remedy) from error
    except (ImportError, OSError) as error:
        remedy = f"apt-get install -y --no-install-recommends {SYSTEM_LIBRARIES}"
        message = f"open3d is installed, but a system library it needs is not: {error}"
        raise HearthError.of(Code.NOT_RENDERED, message, suggestion=remedy) from error
    finally:
        if skipped:
            sys.modules.pop(viewers, None)
    return open3d


class Hits(NamedTuple):
    """What N rays hit first.

    Attributes:
        distance: (N,) in units of the ray's direction; infinite for none.
        triangle: (N,) which triangle; -1 for none.
        u, v: (N,) barycentric weights of its second and third corner.
    """

    distance: Floats
    triangle: NDArray[np.int64]
    u: Floats
    v: Floats

    def part(self, found: NDArray[np.int64]) -> Hits:
        """Only those rays."""
        distance, triangle, u, v = self
        return Hits(distance.take(found), triangle.take(found), u.take(found), v.take(found))

    def copy(self) -> Hits:
        """The same, to be written to."""
        return Hits(self.distance.copy(), self.triangle.copy(), self.u.copy(), self.v.copy())


def put(hits: Hits, where: NDArray[np.int64], found: Hits) -> None:
    """Write what some rays found into the hits of all."""
    for name in Hits._fields:
        getattr(hits, name)[where] = getattr(found, name)


@dataclass(frozen=True, eq=False)
class Caster:
    """Triangles that rays can be cast at. Rays are (6, N): rows of origins x, y, z and directions x, y, z."""

    count: int
    scene: Any

    @classmethod
    def of(cls, corners: Floats) -> Caster:
        """Over (T, 3, 3) corners."""
        core, geometry = engine().core, engine().t.geometry
        scene = geometry.RaycastingScene()
        if len(corners):
            points = np.ascontiguousarray(corners.reshape(-1, 3), np.float32)
            indices = np.arange(len(points), dtype=np.uint32).reshape(-1, 3)
            scene.add_triangles(core.Tensor(points), core.Tensor(indices))
        return cls(len(corners), scene)

    def cast(self, rays: Floats) -> Hits:
        """The first hit of each of (6, N) rays."""
        size = rays.shape[1]
        if not self.count or not size:
            none, flat = np.full(size, np.inf, np.float32), np.zeros(size, np.float32)
            return Hits(none, np.full(size, -1, np.int64), flat, flat)
        answer = self.scene.cast_rays(_tensor(rays))
        number = answer["primitive_ids"].numpy().astype(np.int32).astype(np.int64)
        u, v = np.ascontiguousarray(answer["primitive_uvs"].numpy().T)
        return Hits(answer["t_hit"].numpy(), number, u, v)

    def occluded(self, origins: Floats, directions: Floats, far: float = 0.999) -> NDArray[np.bool_]:
        """(N,) whether anything lies between (3, N) origins and origin + far * direction."""
        size = origins.shape[1]
        if not self.count or not size:
            return np.zeros(size, np.bool_)
        rays = np.empty((size, 6), np.float32)
        rays[:, :3], rays[:, 3:] = origins.T, directions.T
        found: NDArray[np.bool_] = self.scene.test_occlusions(engine().core.Tensor(rays), 0.0, far).numpy()
        return found


def _tensor(rays: Floats) -> Any:
    return engine().core.Tensor(np.ascontiguousarray(rays.T))
