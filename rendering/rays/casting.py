"""Casting rays at triangles: the only place that needs open3d (Embree)."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import cache
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.rendering.rays.memory import keep
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

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
    keep()
    return open3d


class Hits(NamedTuple):
    """What N rays hit first.

    Attributes:
        distance: (N,) in units of the ray's direction; infinite for none.
        triangle: (N,) which triangle; -1 for none.
        u, v: (N,) barycentric weights of its second and third corner.
    """

    distance: Floats
    triangle: NDArray[np.int32]
    u: Floats
    v: Floats

    @classmethod
    def none(cls, size: int) -> Hits:
        """Of rays that hit nothing."""
        far, flat = np.full(size, np.inf, np.float32), np.zeros(size, np.float32)
        return cls(far, np.full(size, -1, np.int32), flat, flat.copy())

    def copy(self) -> Hits:
        """The same, to be written to."""
        return Hits(self.distance.copy(), self.triangle.copy(), self.u.copy(), self.v.copy())


NO_TRIANGLE = 0xFFFFFFFF
"""What Embree calls the triangle of a ray that hits nothing; -1 when read with a sign."""


@dataclass(frozen=True, eq=False)
class Caster:
    """Triangles that rays can be cast at. Rays are (N, 6) float32: origins x, y, z and directions x, y, z.

    A cast is shared among all processors by Embree itself: it holds the interpreter's lock, so that threads of ours
    would cast one after the other.
    """

    count: int
    scene: Any

    @classmethod
    def of(cls, corners: Floats) -> Caster:
        """Over (T, 3, 3) corners."""
        core, geometry = engine().core, engine().t.geometry
        scene = geometry.RaycastingScene(1 if len(corners) < SMALL else 0)
        if len(corners):
            points = np.ascontiguousarray(corners.reshape(-1, 3), np.float32)
            indices = np.arange(len(points), dtype=np.uint32).reshape(-1, 3)
            scene.add_triangles(core.Tensor.from_numpy(points), core.Tensor.from_numpy(indices))
        return cls(len(corners), scene)

    def raw(self, rays: Floats) -> tuple[Floats, NDArray[np.uint32], Floats]:
        """(N,) distances, (N,) triangles and (N, 2) weights of the first hits; infinitely far where there is none."""
        size = len(rays)
        if not self.count or not size:
            nothing = np.full(size, NO_TRIANGLE, np.uint32)
            return np.full(size, np.inf, np.float32), nothing, np.zeros((size, 2), np.float32)
        answer = self.scene.cast_rays(engine().core.Tensor.from_numpy(rays), ALL)
        return answer["t_hit"].numpy(), answer["primitive_ids"].numpy(), answer["primitive_uvs"].numpy()

    def cast(self, rays: Floats) -> Hits:
        """The first hit of each of (N, 6) rays."""
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
"""As many threads as there are processors, in open3d's words."""

SMALL = 20_000
"""Triangles up to which the tree over them is built by one thread."""
