"""The surfaces that draw people: skin, eyes, garments, shoes, hair and brows."""

from __future__ import annotations

import numpy as np
from body_hair import hair_of
from body_meshes import Part, applied, compact, cut, normals_of, smoothed, thinned, triangles_of
from body_source import Array, Fields, Source, along

SLOTS = ("skin", "lips", "white", "iris", "pupil", "brow", "hair", "top", "bottom", "shoes", "sole", "nails")


def parts_of(source: Source, fields: Fields) -> dict[str, Part]:
    """All surfaces by name."""
    return {**_skin(source, fields), **_eyes(source), **_garments(source, fields), **hair_of(source, fields, SLOTS)}


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
        found[name] = compact(Part(_single(len(v)), kept, np.zeros(len(v)), slots))
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
    return {"eyes": compact(Part(_single(len(v)), both, np.zeros(len(v)), np.concatenate([s for _, s in found])))}


def _garments(source: Source, fields: Fields) -> dict[str, Part]:
    """Tops, trousers, skirts and shoes from the tights and the skirt of the base mesh."""
    v = source.mean
    quads = source.quads[source.groups == "helper-tights"]
    whole = triangles_of(quads)
    smooth = smoothed(quads, len(v), 10)
    x = applied(smooth, v)
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
    """Return the distance of trouser legs from the leg: at least 6.5 cm from the bone below the knee."""
    found = np.zeros(len(x))
    for side, sign in (("l", 1), ("r", -1)):
        a, b = source.joint(f"calf_{side}"), source.joint(f"foot_{side}")
        mine = (source.mean[:, 0] * sign > 0) & (fields.leg > 0.7) & (fields.arm_share < 0.35)
        axis = a + np.clip(along(x, a, b), -0.4, 1.1)[:, None] * (b - a)
        gap = 0.064 - np.linalg.norm(x - axis, axis=1)
        found[mine] = (np.maximum(gap, 0) * np.clip((fields.leg - 0.7) / 0.6, 0, 1))[mine]
    return found


def _shoes(source: Source, fields: Fields, tri: Array, smooth: list[dict[int, float]], x: Array) -> Part:
    """The feet of the tights, a little larger, with soles."""
    foot = source.share("foot", "ball")
    edge = np.maximum(0.2 - foot, (1.93 - fields.leg) * 0.4)
    raw = triangles_of(source.quads[source.groups == "helper-tights"])
    part = cut(_single(len(x)), raw, np.full(len(x), 0.006), edge, SLOTS.index("shoes"))
    low = applied(part.rows, source.mean)[:, 1]
    sole = low[part.triangles].mean(axis=1) < source.mean[:, 1].min() + 0.016
    return part._replace(slots=np.where(sole, SLOTS.index("sole"), part.slots))
