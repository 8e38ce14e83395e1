"""Hair: caps on the head in locks, curtains that fall beside the face and down the back, and brows."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from body_meshes import Part, applied, cut, halved, smoothed, thinned, triangles_of
from body_source import Array, Fields, Source

Row = dict[int, float]

COLUMNS = 61
"""Of a curtain, from the front around the back to the front."""

JAW = 0.155
"""Metres from the height of the ears down to the end of hair that reaches the jaw."""

RADIUS = 0.042
"""Of a knot of hair, metres."""


class Head(NamedTuple):
    """Places of vertices on the head of the mean body.

    Attributes:
        eye: (3,) the left eye's middle.
        tall: metres from the eyes to the top of the head.
        up, back: (V,) above the eyes, and in front of them, in parts of `tall`.
        ears: (V,) whether a vertex is of an ear.
        axis: (3,) a point in the middle of the head, at the height of the eyes.
    """

    eye: Array
    tall: float
    up: Array
    back: Array
    ears: Array
    axis: Array

    @classmethod
    def of(cls, source: Source, fields: Fields) -> Head:
        v, quads = source.mean, source.quads
        eye = v[np.unique(quads[source.groups == "helper-l-eye"])].mean(axis=0)
        body = source.groups == "body"
        tall = v[np.unique(quads[body])][:, 1].max() - eye[1]
        ears = np.zeros(len(v), bool)
        ears[quads[(source.mask("ears") > 0.5) & body].ravel()] = True
        skull = (fields.head > 0.9) & (v[:, 1] > eye[1])
        axis = np.array((0.0, eye[1], v[skull][:, 2].mean()))
        return cls(eye, tall, (v[:, 1] - eye[1]) / tall, (v[:, 2] - eye[2]) / tall, ears, axis)


def hair_of(source: Source, fields: Fields, slots: tuple[str, ...]) -> dict[str, Part]:
    """Caps of hair on the head, hair that falls, and brows."""
    head, hair = Head.of(source, fields), slots.index("hair")
    found = _caps(source, fields, head, hair)
    blades = source.joint("spine_03")
    found["bob"] = _curtain(source, head, hair, 1.0)
    found["long"] = _joined(_curtain(source, head, hair, 1.15), _falling(source, head, hair, blades[1], 0.095))
    found["bun"] = _bun(source, head, hair)
    found["brows"] = _brows(source, slots.index("brow"))
    return found


def _locks(points: Array, head: Head) -> Array:
    """A relief of locks that part at the crown, about 0, within -1 to 1."""
    crown = head.axis + np.array((0.0, 0.9, -0.28)) * head.tall
    way = points - crown
    angle = np.arctan2(way[:, 0], way[:, 2])
    far = np.linalg.norm(way[:, [0, 2]], axis=1) + np.maximum(crown[1] - points[:, 1], 0)
    twist = 5 * far
    found: Array = (
        0.55 * np.sin(13 * angle + twist + 1.5 * np.sin(3 * angle)) + 0.3 * np.sin(29 * angle - 2 * twist + 1.0)
        + 0.15 * np.sin(47 * angle + 2.0)
    ) * np.clip(far / 0.05, 0, 1)  # fmt: skip
    return found


def _caps(source: Source, fields: Fields, head: Head, slot: int) -> dict[str, Part]:
    v, quads = source.mean, source.quads
    chosen = (source.groups == "body") & (fields.head[quads].mean(axis=1) > 0.9) & ~head.ears[quads].any(axis=1)
    rows, tri = halved(
        smoothed(quads[chosen], len(v), 2), thinned(v, triangles_of(quads[chosen]), 1100, np.ones(len(v)))
    )
    at = applied(rows, v)
    up, back = (at[:, 1] - head.eye[1]) / head.tall, (at[:, 2] - head.eye[2]) / head.tall
    line = np.interp(back, [-1.75, -1.35, -1.12, -1.0, -0.82, -0.72, -0.5, -0.25, 0.2],
                     [-0.75, -0.75, -0.55, -0.1, 0.0, 0.08, 0.36, 0.52, 0.56])  # fmt: skip
    locks = _locks(at, head)
    field = (line - up) * head.tall + 0.0045 * locks
    found = {}
    for name, depth, relief in (("buzz", 0.004, 0.0), ("short", 0.015, 0.004), ("full", 0.022, 0.005)):
        rising = np.clip(-field / (0.02 + 1.6 * depth), 0, 1) ** 0.7
        found[name] = cut(rows, tri, 0.0012 + (depth + relief * locks) * rising, field, slot)
    bald = np.maximum(field, (up - 0.42) * head.tall + 0.006 * locks)
    found["bald"] = cut(rows, tri, 0.0012 + 0.006 * np.clip(-bald / 0.03, 0, 1), bald, slot)
    return found


def _ring(source: Source, head: Head, angles: Array, height: float) -> list[Row]:
    """The head's outline at a height above the eyes, in parts of `tall`, where rays from its axis leave it.

    Ears are left out: what they hide is between what is beside them.
    """
    v, quads = source.mean, source.quads
    y = head.eye[1] + height * head.tall
    body = (source.groups == "body") & ~head.ears[quads].any(axis=1)
    near = np.abs(v[quads][:, :, 1].mean(axis=1) - y) < 0.03
    tri = triangles_of(quads[body & near])
    hits: dict[int, Row] = {}
    for number, angle in enumerate(angles.tolist()):
        hit = _hit(v, tri, np.array((0.0, y, head.axis[2])), np.array((np.sin(angle), 0.0, np.cos(angle))))
        if hit:
            hits[number] = hit
    return [_between(hits, number) for number in range(len(angles))]


def _between(hits: dict[int, Row], number: int) -> Row:
    """A column's row; of one without, the mean of the nearest on both sides."""
    if number in hits:
        return hits[number]
    low = max((k for k in hits if k < number), default=min(hits))
    high = min((k for k in hits if k > number), default=max(hits))
    share = 0.5 if low == high else (number - low) / (high - low)
    return _mixed((hits[low], 1 - share), (hits[high], share))


def _hit(v: Array, tri: Array, start: Array, way: Array) -> Row | None:
    """The farthest point where a ray leaves triangles, as a mean of their vertices."""
    a, b, c = (v[tri[:, k]] for k in range(3))
    one, two, far = b - a, c - a, start - a
    cross = np.cross(way, two)
    det = np.einsum("ij,ij->i", one, cross)
    safe = np.where(np.abs(det) < 1e-12, 1.0, det)
    s = np.einsum("ij,ij->i", far, cross) / safe
    turned = np.cross(far, one)
    t = turned @ way / safe
    distance = np.einsum("ij,ij->i", two, turned) / safe
    inside = (np.abs(det) > 1e-12) & (s >= -1e-9) & (t >= -1e-9) & (s + t <= 1 + 1e-9) & (distance > 0)
    if not inside.any():
        return None
    k = int(np.flatnonzero(inside)[np.argmax(distance[inside])])
    return {int(tri[k, 0]): 1 - s[k] - t[k], int(tri[k, 1]): s[k], int(tri[k, 2]): t[k]}


def _mixed(*parts: tuple[Row, float]) -> Row:
    found: Row = {}
    for row, share in parts:
        for vertex, weight in row.items():
            found[vertex] = found.get(vertex, 0.0) + weight * share
    return found


def _mean(vertices: Array) -> Row:
    return {int(vertex): 1 / len(vertices) for vertex in vertices}


def _curtain(source: Source, head: Head, slot: int, length: float) -> Part:
    """Hair from above the temples over the ears down to the nape, open at the face.

    Args:
        length: 1 to the jaw.
    """
    angles = np.linspace(0.0, 2 * np.pi, COLUMNS)  # both ends are in front, where it is open
    face = np.minimum(angles, 2 * np.pi - angles)
    rings = [(height, _ring(source, head, angles, height)) for height in (0.75, 0.5, 0.25)]
    down = _down(source)
    tips = length * (1 + 0.035 * np.sin(17 * angles) + 0.025 * np.sin(41 * angles + 1))
    levels = [*(0.0,) * len(rings), 0.2, 0.4, 0.6, 0.8, 1.0]
    rows, offsets = [], []
    for level, share in enumerate(levels):
        ring = rings[min(level, len(rings) - 1)][1]
        for column, row in enumerate(ring):
            fall = share * tips[column]
            rows.append(_mixed((row, 1.0), *((part, weight * fall) for part, weight in down)))
            lock = 0.55 * np.sin(13 * angles[column] + fall) + 0.45 * np.sin(29 * angles[column] - fall)
            wide = np.interp(level, [0, 1, 2, 4, 6, 7], [0.016, 0.02, 0.024, 0.03, 0.03, 0.02])
            offsets.append(wide + 0.0035 * lock)
    edge = np.array(
        [_front(face[column], level, len(levels)) for level in range(len(levels)) for column in range(COLUMNS)]
    )
    return cut(rows, _grid(len(levels), COLUMNS), np.array(offsets), edge, slot)


def _front(face: float, level: int, levels: int) -> float:
    """Return the angle, in radians, of a column before the curtain's edge: at the temples, lower down behind."""
    begins = np.interp(level, [0, 2, 4, levels - 1], [1.2, 1.5, 1.85, 1.95])
    return float(begins - face)


def _down(source: Source) -> list[tuple[Row, float]]:
    """The way from the height of the ears to the jaw, as a difference of means of vertices."""
    top = _mean(source.members[source.rig["head"]["tail"]["cube_name"]])
    low = _mean(source.members[source.rig["head"]["head"]["cube_name"]])
    length = source.joint("head", "tail")[1] - source.joint("head")[1]
    return [(low, JAW / length), (top, -JAW / length)]


def _grid(levels: int, columns: int) -> Array:
    """Triangles between rows of columns that go around."""
    here = np.arange(levels - 1)[:, None] * columns + np.arange(columns - 1)[None, :]
    quads = np.stack([here, here + columns, here + columns + 1, here + 1], axis=-1).reshape(-1, 4)
    return triangles_of(quads)


def _falling(source: Source, head: Head, slot: int, low: float, wide: float) -> Part:
    """Hair behind the ears down to a height: a sheet over nape and back, as straight as hair hangs."""
    v = source.mean
    quads = source.quads[(source.groups == "body") & ~head.ears[source.quads].any(axis=1)]
    here = quads[(v[quads][:, :, 1].min(axis=1) > low - 0.05) & (v[quads][:, :, 2].mean(axis=1) < v[:, 2].max() - 0.11)]
    rows = smoothed(here, len(v), 6)
    tri = thinned(v, triangles_of(here), 900, np.ones(len(v)))
    behind = v[(head.back < -1.3) & (head.up > -0.2)][:, 2].min()
    bottom = v[(np.abs(v[:, 1] - low) < 0.03) & (np.abs(v[:, 0]) < 0.05)][:, 2].min()
    goal = np.interp(v[:, 1], [low, head.eye[1]], [min(bottom, behind + 0.02), behind]) - 0.02
    most = np.interp(head.up, [-0.9, -0.2, 0.1], [0.06, 0.03, 0.012])
    hollow = np.clip(v[:, 2] - goal, 0.012, most)
    outer = np.clip(1.25 - np.abs(v[:, 0]) / wide, 0.3, 1.0)
    narrow = wide * np.interp(v[:, 1], [low, low + 0.12], [0.72, 1.0])
    ragged = low + 0.012 * np.sin(130 * v[:, 0]) + 0.01 * np.sin(310 * v[:, 0] + 1)
    edge = np.maximum.reduce(
        [(head.back + 0.8) * 0.1, ragged - v[:, 1], np.abs(v[:, 0]) - narrow, (head.up - 0.15) * 0.1]
    )
    relief = 0.003 * np.sin(150 * v[:, 0] + 6 * v[:, 1])
    return cut(rows, tri, 0.008 + hollow * outer + relief, edge, slot)


def _joined(one: Part, other: Part) -> Part:
    """Both surfaces as one."""
    return Part(
        [*one.rows, *other.rows], np.concatenate([one.triangles, other.triangles + len(one.rows)]),
        np.concatenate([one.offsets, other.offsets]), np.concatenate([one.slots, other.slots]),
    )  # fmt: skip


def _bun(source: Source, head: Head, slot: int) -> Part:
    """A knot behind the crown: a ball of which each point is the scalp's there, moved by differences of the head's."""
    turns, levels = 17, 9
    (front, right, behind, left) = _ring(source, head, np.array((0.0, np.pi / 2, np.pi, -np.pi / 2)), 0.5)
    frame = []
    for one, other in ((left, right), (front, behind)):
        gap = applied([one, other], source.mean)
        frame.append((one, other, float(np.linalg.norm(gap[1] - gap[0]))))
    rows = []
    for over in np.linspace(0.0, np.pi, levels):
        for around in np.linspace(0.0, 2 * np.pi, turns):
            lock = 1 + 0.05 * np.sin(5 * around + 6 * over)
            across = RADIUS * lock * np.sin(over) * np.sin(around)
            out = RADIUS * (0.42 + lock * np.sin(over) * np.cos(around))
            up = RADIUS * lock * np.cos(over) + 0.02
            parts = [(other, way / gap) for (_, other, gap), way in zip(frame, (across, out), strict=True)]
            parts += [(one, -way / gap) for (one, _, gap), way in zip(frame, (across, out), strict=True)]
            rows.append(_mixed((behind, 1.0), *parts, *((row, -weight * up / JAW) for row, weight in _down(source))))
    field = np.full(len(rows), -1.0)
    return cut(rows, _grid(levels, turns), np.zeros(len(rows)), field, slot)


def _brows(source: Source, slot: int) -> Part:
    """An arc above each eye."""
    v, quads = source.mean, source.quads
    face = quads[(source.groups == "body") & (source.mask("face") > 0.2)]
    field = np.full(len(v), 1.0)
    for side, sign in (("l", 1), ("r", -1)):
        points = v[np.unique(quads[source.groups == f"helper-{side}-eye"])]
        middle, radius = (points.min(axis=0) + points.max(axis=0)) / 2, np.ptp(points[:, 1]) / 2
        x, y = sign * (v[:, 0] - middle[0]) / radius, (v[:, 1] - middle[1]) / radius
        height = np.interp(x, [-1.2, -0.8, 0.6, 1.8], [0.15, 0.24, 0.19, 0.05])
        arc = np.maximum(np.abs(y - 1.42 + 0.1 * (x - 0.5) ** 2) - height, np.maximum(-1.2 - x, x - 1.8))
        field = np.minimum(field, np.maximum(arc * radius, middle[2] - 0.01 - v[:, 2]))
    single: list[Row] = [{number: 1.0} for number in range(len(v))]
    return cut(single, triangles_of(face), np.full(len(v), 0.0018), field, slot)
