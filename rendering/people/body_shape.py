"""Shapes of bodies: points and bones of a person by sex, age, weight, proportions and face.

`bodies.npz` is derived from MakeHuman's base mesh, targets, rig and weights (CC0) by `benchmarks/derive_bodies.py`.
"""

from __future__ import annotations

from functools import cache, lru_cache
from importlib.resources import files
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.rendering.people.proportions import Proportions
from hearth.rendering.people.rotations import about
from hearth.schemas.graph import Point

FILE = "bodies.npz"
STEP = 1e-4
"""Metres of one unit of the stored targets."""

GROWN, AGED = 25.0, 85.0
"""Ages in years of the targets `young` and `old`."""
SMALL = 10.0
"""Age of the target `child`."""

Whole = NDArray[np.integer[Any]]


LOWERED = 9.0
"""Degrees by which shoulders are lower than in the rest pose."""
FORWARD = np.array((0.0, 0.0, 1.0))


class Shape(NamedTuple):
    """Parameters of a person's shape.

    Attributes:
        sex: 0 female to 1 male.
        age: years, from `SMALL`.
        muscle, weight: 0 to 1; 0.5 is average.
        stature: -1 short to 1 tall; changes the proportions, as `height` of the body is given.
        ideal: 0 to 1, slender proportions.
        ancestry: weights of African, Asian and Caucasian features; their sum is 1.
        face: (name of a target, weight) of features of the face.
    """

    sex: float = 0.0
    age: float = 30.0
    muscle: float = 0.5
    weight: float = 0.5
    stature: float = 0.0
    ideal: float = 0.3
    ancestry: Point = (0.0, 0.0, 1.0)
    face: tuple[tuple[str, float], ...] = ()


class BodyData(NamedTuple):
    """The content of `bodies.npz`: P points of surfaces, then both ends of B bones, then the ground.

    Attributes:
        base: (P + 2 B + 1, 3) positions, metres.
        moves: (T, P + 2 B + 1, 3) displacements by target, in units of `STEP`.
        targets: name -> row of `moves`.
        bones, parents: (B,) names, and indices of their parents or -1; parents come first.
        bone_of, weights: (P, 4) bones of each point, and their weights.
        triangles: (F, 3) points.
        slots: (F,) index into `slot_names`, what decides the colour.
        offsets: (P,) metres by which points lie outside the surface, for a height of 1.7 m.
        parts: name -> (first point, last, first triangle, last) of each surface; ends excluded.
    """

    base: Floats
    moves: Whole
    targets: dict[str, int]
    bones: tuple[str, ...]
    parents: tuple[int, ...]
    bone_of: Whole
    weights: Floats
    triangles: Whole
    slots: Whole
    slot_names: tuple[str, ...]
    offsets: Floats
    parts: dict[str, tuple[int, int, int, int]]


def is_present() -> bool:
    """Return whether the file of bodies is installed."""
    return (files("hearth.rendering.people") / FILE).is_file()


@cache
def body_data() -> BodyData:
    """Return the file of bodies, read once."""
    with (files("hearth.rendering.people") / FILE).open("rb") as file, np.load(file) as stored:
        names = [str(name) for name in stored["target_names"]]
        # Stored are differences to the point before, low bytes apart from high ones.
        halves = stored["targets"].T.copy().view("<i2")
        moves = np.cumsum(halves.reshape(len(names), -1, 3), axis=1, dtype=np.int16)
        points, triangles = stored["part_points"].tolist(), stored["part_triangles"].tolist()
        parts = {
            str(name): (points[k], points[k + 1], triangles[k], triangles[k + 1])
            for k, name in enumerate(stored["parts"])
        }
        weights = stored["weights"].astype(np.float32)
        return BodyData(
            stored["base"], moves, {name: row for row, name in enumerate(names)},
            tuple(map(str, stored["bones"])), tuple(stored["parents"].tolist()),
            stored["weight_bones"].astype(np.int64), weights / weights.sum(axis=1, keepdims=True),
            stored["triangles"].astype(np.int64), stored["slots"].astype(np.int64),
            tuple(map(str, stored["slot_names"])), stored["offsets"], parts,
        )  # fmt: skip


def target_weights(shape: Shape) -> dict[str, float]:
    """Return the weight of each target that shapes a person, as MakeHuman combines them."""
    found: dict[str, float] = {}
    for sex, of_sex in (("female", 1 - shape.sex), ("male", shape.sex)):
        for age, of_age in zip(("child", "young", "old"), _ages(shape.age), strict=True):
            both = of_sex * of_age
            for people, share in zip(("african", "asian", "caucasian"), shape.ancestry, strict=True):
                found[f"{people}-{sex}-{age}"] = both * share
            for muscle, of_muscle in zip(("min", "average", "max"), _levels(shape.muscle), strict=True):
                for weight, of_weight in zip(("min", "average", "max"), _levels(shape.weight), strict=True):
                    found[f"{sex}-{age}-{muscle}-{weight}"] = both * of_muscle * of_weight
            end = "max" if shape.stature > 0 else "min"
            found[f"{sex}-{age}-{end}height"] = both * abs(shape.stature)
            found[f"{sex}-{age}-ideal"] = both * shape.ideal
    return {name: weight for name, weight in (found | dict(shape.face)).items() if weight}


def _ages(years: float) -> Point:
    """Weights of child, young and old."""
    if years < GROWN:
        share = max(years - SMALL, 0.0) / (GROWN - SMALL)
        return 1 - share, share, 0.0
    share = min((years - GROWN) / (AGED - GROWN), 1.0)
    return 0.0, 1 - share, share


def _levels(value: float) -> Point:
    """Weights of minimum, average and maximum."""
    return max(0.0, 1 - 2 * value), 1 - abs(2 * value - 1), max(0.0, 2 * value - 1)


class Shaped(NamedTuple):
    """A person's points and bones in the rest pose, in metres; feet on y = 0.

    Attributes:
        points: (P, 3).
        heads, tails: (B, 3) ends of the bones.
    """

    points: Floats
    heads: Floats
    tails: Floats


@lru_cache(maxsize=64)
def shaped(shape: Shape, height: float) -> Shaped:
    """Return a shape's points and bones, scaled to a height in metres."""
    data = body_data()
    weights = target_weights(shape)
    rows = [data.targets[name] for name in weights]
    values = np.array(list(weights.values()), np.float64) * STEP
    at = data.base.astype(np.float64) + np.tensordot(values, data.moves[rows].astype(np.float64), axes=1)
    first, last, *_ = data.parts["head"]
    at *= height / float(at[first:last, 1].max() - at[-1, 1])
    count = len(data.offsets)
    bones = count + 2 * np.arange(len(data.bones))
    hips = at[bones[[data.bones.index(f"thigh_{side}") for side in "lr"]]].mean(axis=0)
    at -= (0.0, at[-1, 1], hips[2])
    return Shaped(at[:count], at[bones], at[bones + 1])


@lru_cache(maxsize=64)
def proportions(shape: Shape, height: float) -> Proportions:
    """Return the proportions of a shaped person, which are those of its bones."""
    data, person = body_data(), shaped(shape, height)
    head = {bone: person.heads[number] for number, bone in enumerate(data.bones)}
    tail = {bone: person.tails[number] for number, bone in enumerate(data.bones)}

    def length(one: str, other: str) -> float:
        return float(np.linalg.norm(head[other] - head[one]))

    def vector(value: Floats) -> Point:
        return 0.0, float(value[1]), float(value[2])

    pelvis = np.array((0.0, head["thigh_l"][1], 0.0))
    chest = np.array((0.0, head["upperarm_l"][1], head["spine_03"][2] * 0.5))
    middle = (head["head"] + tail["head"]) / 2
    # Arms are half raised in the rest pose; shoulders of arms that hang are lower.
    root = head["clavicle_l"]
    shoulder = root + about(FORWARD, -LOWERED) @ (head["upperarm_l"] - root) - chest
    knuckles = head["middle_01_l"] - head["hand_l"]
    return Proportions(
        height, float(pelvis[1]), vector(head["spine_02"] - pelvis), vector(chest - head["spine_02"]),
        vector(head["neck_01"] - chest), vector(middle - head["neck_01"]),
        (float(shoulder[0]), float(shoulder[1]), float(shoulder[2])), float(head["thigh_l"][0]),
        length("thigh_l", "calf_l"), length("calf_l", "foot_l"), length("upperarm_l", "lowerarm_l"),
        length("lowerarm_l", "hand_l"), float(head["foot_l"][1]),
        float(head["ball_l"][2] - head["foot_l"][2]), float(tail["ball_l"][2] - head["foot_l"][2]),
        0.8 * float(np.linalg.norm(knuckles)), 0.009 * height,
    )  # fmt: skip
