"""A scene in forms that other programs open: glTF (one file, `.glb`) and OBJ, by trimesh."""

from collections.abc import Iterator
from functools import cache
from itertools import chain, count
from pathlib import Path
from typing import Any

import numpy as np

from hearth.rendering.arrays import Floats
from hearth.rendering.models.class_appearance import Model, draw
from hearth.rendering.models.mesh import Mesh, rotation
from hearth.rendering.models.texture_patterns import SIDE
from hearth.rendering.models.textures import OFFSETS, SLOTS, atlas, decode
from hearth.rendering.people.figure import Figure
from hearth.rendering.scene.instances import Thing, placed, tilted
from hearth.rendering.scene.scene import Scene
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library
from hearth.storage.chosen_files import write as write_chosen

ENDINGS = {"gltf": ".glb", "obj": ".obj"}
"""The file of each form. A `.glb` contains its textures; an `.obj` has colors alone, in a separate `.mtl`."""

ROUGH, SMOOTH = 0.9, 0.25
"""Roughness of a matt and of a polished surface."""


def write(scene: Scene, path: Path, form: str = "gltf") -> int:
    """Write a scene for other programs; returns the number of nodes of the graph in it.

    Axes are the scene's: metres, y up, +z ahead. In a glTF each thing is a node `class_id` whose extras have `id` and
    `class`; what is drawn in several panels, as walls are, is several nodes of one id.

    Args:
        scene: with all its things.
        path: the file; an OBJ's materials are in a second file of the same folder.
        form: one of `ENDINGS`.

    Raises:
        HearthError: UNSUPPORTED_FILE: the file has the ending of no form, or of another; MISSING_FILE without trimesh.
    """
    if path.suffix != ENDINGS.get(form):
        message, remedy = (
            f"{form} is not written as {path.suffix or 'a file without ending'}",
            f"end in {ENDINGS[form]}",
        )
        raise HearthError.of(Code.UNSUPPORTED_FILE, message, file=str(path), suggestion=remedy)
    library("trimesh")
    found = _Exchanged(scene, textures=form == "gltf").made
    for name, data in (_gltf(found, path) if form == "gltf" else _obj(found, path)).items():
        write_chosen(path if name == path.name else path.with_name(name), data)
    return len({thing.id for thing in scene.everything})


def glb(scene: Scene, textures: bool = True) -> bytes:
    """Return a scene as a glTF file in memory, as `write` describes it; without textures it has plain colours.

    Raises:
        HearthError: MISSING_FILE without trimesh.
    """
    library("trimesh")
    return _bytes(_Exchanged(scene, textures).made)


def node_names(scene: Scene) -> dict[Thing, str]:
    """Return the node of a glTF that each thing of a scene is; of equal things, the first's."""
    found: dict[Thing, str] = {}
    for thing, name in zip(scene.everything, _names(scene), strict=True):
        found.setdefault(thing, name)
    return found


def _names(scene: Scene) -> Iterator[str]:
    used: set[str] = set()
    for thing in scene.everything:
        name = f"{thing.class_name}_{thing.id}"
        panels = (f"{name}.panel{number}" for number in count(2))
        found = next(each for each in chain((name,), panels) if each not in used)
        used.add(found)
        yield found


def _bytes(found: Any) -> bytes:
    data: bytes = found.export(file_type="glb", include_normals=True)
    return data


def _gltf(found: Any, path: Path) -> dict[str, bytes]:
    return {path.name: _bytes(found)}


def _obj(found: Any, path: Path) -> dict[str, bytes]:
    from trimesh.exchange.obj import export_obj

    text, files = export_obj(found, include_normals=True, return_texture=True, mtl_name=f"{path.stem}.mtl")
    return {**files, path.name: text.encode()}


class _Exchanged:
    """A scene of trimesh; things of equal models share their triangles."""

    def __init__(self, scene: Scene, textures: bool) -> None:
        from trimesh import Scene as Made

        self._textures = textures
        self.made: Any = Made()
        self._models: dict[Model | Figure, list[str]] = {}
        for thing, name in zip(scene.everything, _names(scene), strict=True):
            self._add(thing, name)

    def _add(self, thing: Thing, name: str) -> None:
        extras = {"id": thing.id, "class": thing.class_name}
        graph = self.made.graph
        graph.update(frame_from="world", frame_to=name, matrix=_matrix(thing), metadata=extras)
        for number, key in enumerate(self._keys(thing, name)):
            graph.update(frame_from=name, frame_to=f"{name}.{number}", geometry=key)

    def _keys(self, thing: Thing, name: str) -> list[str]:
        """Return the names of a thing's geometries, one for each material."""
        if thing.structural:
            return self._kept(name, placed(thing))
        if thing.model not in self._models:
            mesh = draw(thing.model) if isinstance(thing.model, Model) else _standing(thing)
            self._models[thing.model] = self._kept(f"{thing.class_name}.{len(self._models)}", mesh)
        return self._models[thing.model]

    def _kept(self, name: str, mesh: Mesh) -> list[str]:
        found = {f"{name}.{number}": piece for number, piece in enumerate(_by_material(mesh, self._textures))}
        self.made.geometry.update(found)
        return list(found)


def _matrix(thing: Thing) -> Floats:
    """(4, 4) from the model's frame to the home's; parts of the building are in the home's already."""
    matrix = np.eye(4, dtype=np.float32)
    if not thing.structural:
        matrix[:3, :3] = rotation("y", thing.yaw) @ tilted(thing.tilt) if any(thing.tilt) else rotation("y", thing.yaw)
        matrix[:3, 3] = thing.position
    return matrix


def _standing(thing: Thing) -> Mesh:
    from hearth.rendering.people.figure import figure_mesh

    assert isinstance(thing.model, Figure)
    return figure_mesh(thing.model)


def _by_material(mesh: Mesh, textures: bool) -> list[Any]:
    """Return a mesh as one of trimesh for each colour, texture, glow and shine."""
    slots = mesh.textures if textures else np.full_like(mesh.textures, SLOTS["plain"])
    rows = np.column_stack((mesh.surface.round(4), slots.astype(np.float32)))
    kinds, of = np.unique(rows, axis=0, return_inverse=True)
    return [_piece(mesh, np.flatnonzero(of.ravel() == number), kind) for number, kind in enumerate(kinds)]


def _piece(mesh: Mesh, chosen: Any, kind: Floats) -> Any:
    from trimesh import Trimesh
    from trimesh.visual.texture import TextureVisuals

    # Pictures count their rows from the top, as `mesh.uvs` do, and trimesh turns them over when it writes.
    uvs = mesh.uvs[chosen].reshape(-1, 2) * (1, -1) + (0, 1)
    rows = np.column_stack((mesh.corners[chosen].reshape(-1, 3), mesh.normals[chosen].reshape(-1, 3), uvs))
    rows, faces = np.unique(rows.astype(np.float32), axis=0, return_inverse=True)  # equal corners are one
    look = TextureVisuals(uv=rows[:, 6:], material=_material(tuple(map(float, kind))))
    return Trimesh(rows[:, :3], faces.reshape(-1, 3), vertex_normals=rows[:, 3:6], visual=look, process=False)


@cache
def _material(kind: tuple[float, ...]) -> Any:
    """Return the material of (red, green, blue, glow, shine, slot of the texture)."""
    from trimesh.visual.material import PBRMaterial

    *color, glow, shine, slot = kind
    picture, brightest = (None, 1.0) if int(slot) == SLOTS["plain"] else _picture(int(slot))
    base = [min(1.0, value * brightest) for value in color]
    return PBRMaterial(
        baseColorFactor=np.array([*base, 1.0]),
        baseColorTexture=picture,
        emissiveFactor=np.clip(np.array(color) * glow, 0, 1),
        metallicFactor=0.0,
        roughnessFactor=ROUGH + (SMOOTH - ROUGH) * min(shine, 1.0),
        doubleSided=True,
    )


@cache
def _picture(slot: int) -> tuple[Any, float]:
    """Return a texture as a picture in sRGB, and the linear value of its brightest part."""
    from PIL import Image

    light = decode()[atlas()[slot, OFFSETS[0] : OFFSETS[1]].reshape(SIDE, SIDE, 3)]
    brightest = float(light.max()) or 1.0
    share = light / brightest
    srgb = np.where(share <= 0.0031308, share * 12.92, 1.055 * share ** (1 / 2.4) - 0.055)
    return Image.fromarray((srgb * 255 + 0.5).astype(np.uint8)), brightest
