"""Dressed people in the rest pose: surfaces of body, hair and clothes with colours, and their skinning to a pose."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.rendering.models.mesh import ATTRIBUTES, Mesh
from hearth.rendering.models.paint import Paint, linear
from hearth.rendering.models.textures import SLOTS
from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.body_shape import BodyData, Shape, body_data, shaped
from hearth.rendering.people.bones import matrices
from hearth.rendering.people.person_appearance import Body

SIZE = 1.7
"""Height in metres for which offsets of clothes are stored."""

UNDER = {
    "tshirt": ("upperarms", "forearms"),
    "longsleeve": (),
    "tank": ("upperarms", "forearms"),
    "trousers": (),
    "shorts": ("thighs", "shins"),
    "skirt": ("thighs", "shins"),
    "longskirt": ("shins",),
}
"""The bare limbs below each garment."""

HAIR = {
    "bald": ("bald",),
    "buzz": ("buzz",),
    "short": ("short",),
    "full": ("full",),
    "bob": ("full", "bob"),
    "long": ("full", "long"),
    "bun": ("full", "bun"),
}
"""The surfaces of each style of hair."""


@dataclass(frozen=True, eq=False, slots=True)
class Dressed:
    """A dressed person in the rest pose.

    Attributes:
        points, normals: (P, 3) in the rest pose.
        bone_of, weights: (P, 4) bones of each point, and their weights.
        triangles: (T, 3) points.
        uvs, surface, textures: as in `Mesh`.
    """

    points: Floats
    normals: Floats
    bone_of: NDArray[np.int64]
    weights: Floats
    triangles: NDArray[np.int64]
    uvs: Floats
    surface: Floats
    textures: NDArray[np.int16]


def parts_worn(body: Body) -> tuple[str, ...]:
    """Return the names of the surfaces that draw a body."""
    hair = HAIR.get(body.style, HAIR["short"])
    bare = dict.fromkeys((*UNDER[body.garment], *UNDER[body.legwear]))
    return ("head", "hands", *bare, "eyes", "brows", body.garment, body.legwear, "shoes", *hair)


@lru_cache(maxsize=32)
def dressed(body: Body, asleep: bool = False) -> Dressed:
    """Return a body's surfaces in the rest pose; with its eyes closed if it is asleep."""
    assert body.shape is not None
    data = body_data()
    shape = body.shape._replace(face=(*body.shape.face, ("closed", 1.0))) if asleep else body.shape
    person = shaped(shape, body.height)
    spans = [data.parts[name] for name in parts_worn(body)]
    points = np.concatenate([np.arange(span[0], span[1]) for span in spans])
    starts = np.cumsum([0, *(span[1] - span[0] for span in spans)])
    triangles = np.concatenate(
        [data.triangles[a:b] - first + at for (first, _, a, b), at in zip(spans, starts, strict=False)]
    )
    slots = np.concatenate([data.slots[a:b] for _, _, a, b in spans])
    at = person.points[points]
    normals = normals_of(at, triangles)
    at = at + normals * (data.offsets[points] * body.height / SIZE)[:, None]
    at[:, 1] += SOLE * body.height / SIZE
    spots = {name: slice(a, b) for name, a, b in zip(parts_worn(body), starts[:-1], starts[1:], strict=True)}
    under = np.zeros(len(at), bool)
    under[spots[body.legwear]] = tucked_in(at[spots[body.garment]], at[spots[body.legwear]])
    shown = ~under[triangles].all(axis=1)
    triangles, slots = triangles[shown], slots[shown]
    surface, textures, density = _painted(body, data, slots)
    return Dressed(
        np.ascontiguousarray(at, np.float32), np.ascontiguousarray(normals_of(at, triangles), np.float32),
        np.ascontiguousarray(data.bone_of[points]), np.ascontiguousarray(data.weights[points]),
        triangles, _uvs(at, triangles, density), surface, textures,
    )  # fmt: skip


HEM, WEDGES = 0.035, 24
"""Metres above the hem of a shirt from which what is under it is not drawn; directions in which the hem is found."""


def tucked_in(shirt: Floats, legs: Floats) -> NDArray[np.bool_]:
    """(P,) which points of trousers or a skirt are under a shirt, which they would pierce as the body bends.

    Args:
        shirt, legs: (N, 3) and (P, 3) points in the rest pose, with arms held off.
    """
    middle = legs[:, 2].mean()
    wide = np.abs(legs[:, 0]).max() + HEM
    trunk = shirt[np.abs(shirt[:, 0]) < wide]
    wedge, other = (
        ((np.arctan2(at[:, 0], at[:, 2] - middle) / (2 * np.pi) + 0.5) * WEDGES).astype(int) % WEDGES
        for at in (trunk, legs)
    )  # fmt: skip
    hem = np.full(WEDGES, np.inf)
    np.minimum.at(hem, wedge, trunk[:, 1])
    found: NDArray[np.bool_] = legs[:, 1] > hem[other] + HEM
    return found


SOLE = 0.0
"""Metres by which soles lift a person of `SIZE`."""


def normals_of(points: Floats, triangles: NDArray[np.int64]) -> Floats:
    """(P, 3) unit normals of points: the mean of their triangles', by area."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    faces = np.cross(b - a, c - a)
    found = np.zeros_like(points)
    for axis in range(3):
        for corner in range(3):
            found[:, axis] += np.bincount(triangles[:, corner], faces[:, axis], len(points))
    result: Floats = found / np.maximum(np.linalg.norm(found, axis=1, keepdims=True), 1e-12)
    return result


def _painted(body: Body, data: BodyData, slots: NDArray[np.int64]) -> tuple[Floats, NDArray[np.int16], Floats]:
    """(T, 5) surface, (T,) slots of textures, and (T,) their tiles per metre."""
    paints = {
        "skin": Paint(body.skin, shine=0.04),
        "lips": Paint(_mixed(body.skin, "#a5504c", 0.45)),
        "white": Paint("#ece7e0", shine=0.3),
        "iris": Paint(body.iris, shine=0.3),
        "pupil": Paint("#15110f", shine=0.3),
        "brow": Paint(_mixed(body.hair, "#201812", 0.35)),
        "hair": Paint(body.hair, "hair", 6.0),
        "top": Paint(body.top, body.weave, 6.0),
        "bottom": Paint(body.bottom, "fabric", 5.0),
        "shoes": Paint(body.shoes, shine=0.15),
        "sole": Paint("#d8d4cc"),
        "nails": Paint(body.skin),
    }
    rows = [paints[name] for name in data.slot_names]
    surface = np.empty((len(rows), ATTRIBUTES), np.float32)
    for number, paint in enumerate(rows):
        surface[number, :3], surface[number, 3:] = linear(paint.color), (paint.glow, paint.shine)
    textures = np.array([SLOTS[paint.texture] for paint in rows], np.int16)
    return surface[slots], textures[slots], np.array([paint.scale for paint in rows], np.float32)[slots]


def _mixed(one: str, other: str, share: float) -> str:
    pairs = ((int(one[k : k + 2], 16), int(other[k : k + 2], 16)) for k in (1, 3, 5))
    return "#" + "".join(f"{round(a * (1 - share) + b * share):02x}" for a, b in pairs)


def _uvs(points: Floats, triangles: NDArray[np.int64], density: Floats) -> Floats:
    """(T, 3, 2) texture coordinates: around the body, and up."""
    around = np.arctan2(points[:, 0], points[:, 2] + 0.02) * 0.16
    flat = np.stack([around, points[:, 1]], axis=1)[triangles]
    # No triangle reaches around the back.
    low = flat[:, :, 0] < -0.25
    flat[:, :, 0] += np.where(low & (np.ptp(flat[:, :, 0], axis=1) > 0.5)[:, None], 2 * np.pi * 0.16, 0.0)
    return np.ascontiguousarray(flat * density[:, None, None], np.float32)


def dressed_mesh(body: Body, body_pose: BodyPose) -> Mesh:
    """Return the mesh of a body in a pose, in the figure's frame."""
    from hearth.rendering.people.skinning import skinned

    assert isinstance(body.shape, Shape)
    rest = dressed(body, body_pose.asleep)
    bones = matrices(body_pose, body.shape, body.height)
    corners = np.empty((len(rest.triangles), 3, 3), np.float32)
    normals = np.empty_like(corners)
    skinned(rest.points, rest.normals, rest.bone_of, rest.weights, bones, rest.triangles, corners, normals)
    return Mesh(corners, normals, rest.uvs, rest.surface, rest.textures)
