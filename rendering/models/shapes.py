"""Basic shapes of recipes. All lengths are metres; y is up."""

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise

import numpy as np

from hearth.rendering.arrays import Floats
from hearth.rendering.models.mesh import ATTRIBUTES, Mesh, empty, join, shift, transform
from hearth.rendering.models.paint import Paint, linear
from hearth.rendering.models.textures import SLOTS
from hearth.schemas.graph import Point

CUBE_FACES = ((0, 1), (0, -1), (1, 1), (1, -1), (2, 1), (2, -1))
CREASE = 40.0
"""Degrees between neighbouring segments of a profile above which the edge is sharp."""


def triangles(corners: Floats, paint: Paint, normals: Floats | None = None, uvs: Floats | None = None) -> Mesh:
    """Return a mesh of the (T, 3, 3) corners; flat normals and flat texture coordinates where none are given."""
    corners = np.asarray(corners, np.float32).reshape(-1, 3, 3)
    if normals is None and uvs is None:
        # Triangles without an area are never visible.
        corners = corners[np.abs(_crossed(corners)).max(1) > 1e-14]
    if normals is None:
        normals = np.repeat(face_normals(corners)[:, None, :], 3, axis=1)
    if uvs is None:
        uvs = flat_uvs(corners) * paint.scale
    surface = np.empty((len(corners), ATTRIBUTES), np.float32)
    surface[:, :3], surface[:, 3], surface[:, 4] = linear(paint.color), paint.glow, paint.shine
    slots = np.full(len(corners), SLOTS[paint.texture], np.int16)
    return Mesh(corners, np.asarray(normals, np.float32), np.asarray(uvs, np.float32), surface, slots)


def face_normals(corners: Floats) -> Floats:
    """(T, 3) unit normals of (T, 3, 3) corners, counter-clockwise seen from outside."""
    normal = _crossed(corners)
    length = np.sqrt(np.einsum("ij,ij->i", normal, normal))
    unit: Floats = (normal / np.maximum(length, 1e-12)[:, None]).astype(np.float32)
    return unit


_NEXT, _LAST = [1, 2, 0], [2, 0, 1]


def _crossed(corners: Floats) -> Floats:
    """(T, 3) cross products of two sides."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    crossed: Floats = a[:, _NEXT] * b[:, _LAST] - a[:, _LAST] * b[:, _NEXT]
    return crossed


def flat_uvs(corners: Floats) -> Floats:
    """(T, 3, 2) coordinates in metres, projected along each face's main axis; u runs along the longer side."""
    points = corners.reshape(-1, 3)
    extent = points.max(axis=0) - points.min(axis=0) if len(points) else np.zeros(3)
    main = np.abs(face_normals(corners)).argmax(axis=1)
    axes = np.array([_longer_first(axis, extent) for axis in range(3)])[main]
    rows = np.arange(len(corners))[:, None]
    return np.stack([corners[rows, np.arange(3), axes[:, k, None]] for k in (0, 1)], axis=-1)


def _longer_first(axis: int, extent: Floats) -> tuple[int, int]:
    first, second = (other for other in range(3) if other != axis)
    return (first, second) if extent[first] >= extent[second] else (second, first)


def quads(points: Floats, paint: Paint, uvs: Floats | None = None) -> Mesh:
    """Flat quadrilaterals from (Q, 4, 3) points, counter-clockwise; `uvs` is (Q, 4, 2)."""
    points = np.asarray(points, np.float32).reshape(-1, 4, 3)
    pick = [[0, 1, 2], [0, 2, 3]]
    corners = points[:, pick].reshape(-1, 3, 3)
    flat = None if uvs is None else np.asarray(uvs, np.float32).reshape(-1, 4, 2)[:, pick].reshape(-1, 3, 2)
    return triangles(corners, paint, uvs=flat)


_CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float32) / 2
_SIDES = np.array([[1, 5, 7, 3], [4, 0, 2, 6], [5, 4, 6, 7], [0, 1, 3, 2], [3, 7, 6, 2], [0, 4, 5, 1]])


def box(center: Point, size: Point, paint: Paint) -> Mesh:
    """Return a box of full `size` about `center`."""
    points = _CORNERS * np.array(size, np.float32) + np.array(center, np.float32)
    return quads(points[_SIDES], paint)


def block(x0: float, x1: float, y0: float, y1: float, z0: float, z1: float, paint: Paint) -> Mesh:
    """Return a box between two corners."""
    return box(((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2), (x1 - x0, y1 - y0, z1 - z0), paint)


def panel(center: Point, width: float, height: float, paint: Paint, facing: str = "+z") -> Mesh:
    """Return a rectangle facing `facing` (+z, -z, +x, -x, +y) that shows its texture once, upright."""
    w, h = width / 2, height / 2
    # Right and up as a viewer sees them; the frame is left-handed, so clockwise faces outwards.
    axes = {
        "+z": ((-1, 0, 0), (0, 1, 0)),
        "-z": ((1, 0, 0), (0, 1, 0)),
        "+x": ((0, 0, 1), (0, 1, 0)),
        "-x": ((0, 0, -1), (0, 1, 0)),
        "+y": ((-1, 0, 0), (0, 0, -1)),
    }
    flat = np.array([(-w, h), (w, h), (w, -h), (-w, -h)], np.float32)
    points = flat @ np.array(axes[facing], np.float32) + np.array(center, np.float32)
    return quads(points, paint, np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32))


def medallion(center: Point, radius: float, paint: Paint, sides: int = 28) -> Mesh:
    """Return a disc towards +z that shows the texture's inscribed circle once, upright."""
    angle = np.linspace(0, 2 * np.pi, sides + 1)
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(sides + 1)], axis=1)
    points = np.stack([np.zeros((sides, 3)), ring[:-1], ring[1:]], axis=1)
    # Seen from +z in a left-handed frame, +x is on the left.
    uvs = np.stack([0.5 - points[..., 0] / 2, 0.5 - points[..., 1] / 2], axis=-1)
    return triangles(points * radius + np.array(center), paint, uvs=uvs)


def cushion(center: Point, size: Point, paint: Paint, roundness: float = 0.5, steps: int = 5) -> Mesh:
    """Return a box with soft edges; `roundness` 0 is a box, 1 an ellipsoid."""
    return shift(_cushion((float(size[0]), float(size[1]), float(size[2])), paint, roundness, steps), *center)


@lru_cache(maxsize=1024)
def _cushion(size: Point, paint: Paint, roundness: float, steps: int) -> Mesh:
    ticks = np.linspace(-1, 1, steps + 1)
    u, v = np.meshgrid(ticks, ticks, indexing="ij")
    faces = []
    for axis, sign in CUBE_FACES:
        grid = np.empty((steps + 1, steps + 1, 3))
        grid[..., axis] = sign
        grid[..., (axis + 1) % 3], grid[..., (axis + 2) % 3] = u, v * sign
        faces.append(_grid_quads(grid))
    cube = np.concatenate(faces)
    unit = cube / np.linalg.norm(cube, axis=-1, keepdims=True)
    half = np.array(size) / 2
    radius = roundness * half.min()
    core = half - radius
    inner = np.clip(cube * half, -core, core)
    blend = unit if roundness >= 1 else _normalised(cube * half - inner + 1e-6 * unit)
    points = unit * half if roundness >= 1 else inner + radius * blend
    normals = _normalised(unit / half) if roundness >= 1 else blend
    corners = points.reshape(-1, 4, 3)[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 3)
    smooth = normals.reshape(-1, 4, 3)[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 3)
    return triangles(corners, paint, smooth)


def _grid_quads(grid: Floats) -> Floats:
    return np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=-2).reshape(-1, 4, 3)


def _normalised(vectors: Floats) -> Floats:
    unit: Floats = vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)
    return unit


def ball(center: Point, radii: Point | float, paint: Paint, steps: int = 5) -> Mesh:
    """Return an ellipsoid."""
    size = (radii, radii, radii) if isinstance(radii, int | float) else radii
    return cushion(center, (size[0] * 2, size[1] * 2, size[2] * 2), paint, roundness=1.0, steps=steps)


def lathe(profile: Sequence[tuple[float, float]], paint: Paint, sides: int = 18) -> Mesh:
    """Return the surface of revolution of a profile of (radius, height) about y.

    Its outside is left of the upward profile.
    """
    return join(_ring(profile, i, paint, sides) for i in range(len(profile) - 1) if profile[i] != profile[i + 1])


def _ring(profile: Sequence[tuple[float, float]], i: int, paint: Paint, sides: int) -> Mesh:
    (r0, y0), (r1, y1) = profile[i], profile[i + 1]
    angle = np.linspace(0, 2 * np.pi, sides + 1)
    around = np.stack([np.sin(angle), np.cos(angle)])
    n0, n1 = _profile_normal(profile, i, 0), _profile_normal(profile, i, 1)

    def ring(radius: float, height: float) -> Floats:
        return np.stack([radius * around[0], np.full(sides + 1, height), radius * around[1]], axis=1)

    def quad(low: Floats, high: Floats) -> Floats:
        return np.stack([low[:-1], low[1:], high[1:], high[:-1]], axis=1)

    points = quad(ring(r0, y0), ring(r1, y1))
    normals = quad(ring(n0[0], n0[1]), ring(n1[0], n1[1]))
    length = max(r0, r1) * angle
    low: Floats = np.stack([length, np.full_like(length, y0)], 1)
    high: Floats = np.stack([length, np.full_like(length, y1)], 1)
    if abs(y1 - y0) < abs(r1 - r0):
        low, high = ring(r0, 0)[:, ::2], ring(r1, 0)[:, ::2]
    halves = [h for h, wide in (([0, 1, 2], r0), ([0, 2, 3], r1)) if wide > 1e-6]
    pick = [[h[0], h[1], h[2]] for h in halves]
    return triangles(
        points[:, pick].reshape(-1, 3, 3),
        paint,
        normals[:, pick].reshape(-1, 3, 3),
        quad(low, high)[:, pick].reshape(-1, 3, 2) * paint.scale,
    )


def _profile_normal(profile: Sequence[tuple[float, float]], i: int, end: int) -> Floats:
    """Return normal (outwards, up) at one end of segment i, smoothed with its neighbour unless the edge is sharp."""

    def normal(k: int) -> Floats:
        (r0, y0), (r1, y1) = profile[k], profile[k + 1]
        return _normalised(np.array([y1 - y0, r0 - r1], np.float64))

    own, neighbour = normal(i), i + (1 if end else -1)
    if not 0 <= neighbour < len(profile) - 1 or profile[neighbour] == profile[neighbour + 1]:
        return own
    other = normal(neighbour)
    return own if own @ other < np.cos(np.radians(CREASE)) else _normalised(own + other)


def cylinder(
    center: Point, radius: float, height: float, paint: Paint, top: float | None = None, sides: int = 18
) -> Mesh:
    """Return a closed cylinder or cone on `center`; `top` is its upper radius."""
    return shift(_cylinder(float(radius), float(height), paint, radius if top is None else float(top), sides), *center)


@lru_cache(maxsize=1024)
def _cylinder(radius: float, height: float, paint: Paint, upper: float, sides: int) -> Mesh:
    profile = [(0.0, 0.0), (radius, 0.0), (radius, 0.0), (upper, height), (upper, height), (0.0, height)]
    return lathe(profile, paint, sides)


def rod(
    start: Point, end: Point, radius: float, paint: Paint, end_radius: float | None = None, sides: int = 10
) -> Mesh:
    """Return a closed cylinder from `start` to `end`."""
    a, b = np.array(start, np.float64), np.array(end, np.float64)
    # Bones keep their lengths up to rounding errors; rounded lengths hit the cache.
    length = round(float(np.linalg.norm(b - a)), 7)
    if length < 1e-6:
        return empty()
    mesh = cylinder((0, 0, 0), radius, length, paint, end_radius, sides)
    return transform(mesh, upright_to((b - a) / length), a)


def upright_to(direction: Floats) -> Floats:
    """Return a rotation that maps +y to the unit vector `direction`."""
    y = np.asarray(direction, np.float64)
    helper = np.array((0.0, 0.0, 1.0)) if abs(y[2]) < 0.9 else np.array((1.0, 0.0, 0.0))
    x = np.cross(y, helper)
    x /= np.linalg.norm(x)
    return np.stack([x, y, np.cross(x, y)], axis=1).astype(np.float32)


def tube(path: Sequence[Point], radius: float, paint: Paint, sides: int = 8) -> Mesh:
    """Rods along a path, with balls at its bends."""
    bends = [ball(point, radius, paint, steps=2) for point in path[1:-1]]
    return join([*(rod(a, b, radius, paint, sides=sides) for a, b in pairwise(path)), *bends])


def arc(center: Point, radius: float, start: float, end: float, plane: str = "xy", steps: int = 8) -> list[Point]:
    """Points on a circle from `start` to `end` degrees in a plane (xy, zy or xz)."""
    axes = {"x": 0, "y": 1, "z": 2}
    points = []
    for angle in np.radians(np.linspace(start, end, steps + 1)):
        point = list(center)
        point[axes[plane[0]]] += radius * float(np.cos(angle))
        point[axes[plane[1]]] += radius * float(np.sin(angle))
        points.append((point[0], point[1], point[2]))
    return points


def prism(outline: Sequence[tuple[float, float]], depth: float, paint: Paint) -> Mesh:
    """Return a plate: the simple polygon `outline` in x and y (counter-clockwise), from z = -depth/2 to depth/2."""
    flat = np.array(outline, np.float64)
    cut = np.array(_ears([tuple(p) for p in flat]), int)
    front = np.insert(flat, 2, depth / 2, axis=1)
    back = np.insert(flat, 2, -depth / 2, axis=1)
    edges = np.stack([back, np.roll(back, -1, 0), np.roll(front, -1, 0), front], axis=1)
    return join((triangles(front[cut], paint), triangles(back[cut][:, ::-1], paint), quads(edges, paint)))


def _ears(points: list[tuple[float, float]]) -> list[tuple[int, int, int]]:
    """Triangles (indices) of a simple counter-clockwise polygon, by ear clipping."""
    left, found = list(range(len(points))), []
    while len(left) > 3:
        for k in range(len(left)):
            a, b, c = left[k - 1], left[k], left[(k + 1) % len(left)]
            if _area(points[a], points[b], points[c]) > 1e-12 and not any(
                _within(points[p], points[a], points[b], points[c]) for p in left if p not in (a, b, c)
            ):
                break
        found.append((a, b, c))
        left.remove(b)
    return [*found, (left[0], left[1], left[2])]


def _area(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _within(p: tuple[float, float], a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> bool:
    return _area(a, b, p) >= 0 and _area(b, c, p) >= 0 and _area(c, a, p) >= 0
