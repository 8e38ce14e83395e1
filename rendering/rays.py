"""Casting rays at triangles: the only place that needs open3d (Embree)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.schemas.errors import HearthError
from hearth.schemas.failures import Code

Floats = NDArray[np.float32]

SYSTEM_LIBRARIES = "libusb-1.0-0 libgl1 libegl1 libx11-6 libgomp1"
"""Debian packages that open3d is linked against."""


@cache
def engine() -> Any:
    """The module open3d.

    Raises:
        HearthError: it is not installed, or a system library it needs is missing; says what to install.
    """
    try:
        import open3d
    except ModuleNotFoundError as error:
        remedy = "pip install open3d-cpu (Linux on x86-64, glibc 2.35 or newer)"
        raise HearthError.of(Code.NOT_RENDERED, "drawing pictures needs open3d", suggestion=remedy) from error
    except (ImportError, OSError) as error:
        remedy = f"apt-get install -y --no-install-recommends {SYSTEM_LIBRARIES}"
        message = f"open3d is installed, but a system library it needs is not: {error}"
        raise HearthError.of(Code.NOT_RENDERED, message, suggestion=remedy) from error
    return open3d


class Hits(NamedTuple):
    """What N rays hit first.

    Attributes:
        distance: (N,) in units of the ray's direction; infinite for none.
        triangle: (N,) which triangle; -1 for none.
        uv: (N, 2) barycentric weights of its second and third corner.
    """

    distance: Floats
    triangle: NDArray[np.int64]
    uv: Floats


@dataclass(frozen=True, eq=False)
class Caster:
    """Triangles that rays can be cast at."""

    corners: Floats
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
        return cls(corners, scene)

    def cast(self, rays: Floats) -> Hits:
        """The first hit of each of (N, 6) rays."""
        if not len(self.corners):
            none = np.full(len(rays), np.inf, np.float32)
            return Hits(none, np.full(len(rays), -1, np.int64), np.zeros((len(rays), 2), np.float32))
        answer = self.scene.cast_rays(engine().core.Tensor(np.ascontiguousarray(rays, np.float32)))
        triangle = answer["primitive_ids"].numpy()
        missed = triangle == np.uint32(0xFFFFFFFF)
        number = triangle.astype(np.int64)
        number[missed] = -1
        return Hits(answer["t_hit"].numpy(), number, answer["primitive_uvs"].numpy())

    def occluded(self, origins: Floats, directions: Floats, far: float = 0.999) -> NDArray[np.bool_]:
        """(N,) whether anything lies between an origin and origin + far * direction."""
        if not len(self.corners) or not len(origins):
            return np.zeros(len(origins), np.bool_)
        rays = np.concatenate([origins, directions], axis=1, dtype=np.float32)
        found: NDArray[np.bool_] = self.scene.test_occlusions(engine().core.Tensor(rays), 0.0, far).numpy()
        return found
