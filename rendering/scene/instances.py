"""Things: what a scene is made of, each with a model, a place and the id that its pixels carry."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from hearth.rendering.arrays import Floats
from hearth.rendering.models.looks import Model, draw
from hearth.rendering.models.mesh import Mesh, rotation, transform
from hearth.rendering.people.figure import Figure, figure_mesh
from hearth.schemas.graph import Point


@dataclass(frozen=True, slots=True)
class Thing:
    """Something in a scene: its pixels carry its id.

    Attributes:
        id: of its node.
        class_name: of its node.
        model: what it looks like.
        position: of its foot's middle, metres.
        yaw: the way it faces, degrees from +z towards +x.
        above: what a view from above leaves out whole (ceilings and what hangs there).
        laid: whether it is part of the building: its texture follows the world, and its inside is never seen.
        lamp: whether it is a lamp that is on, and so casts no shadow.
    """

    id: int
    class_name: str
    model: Model | Figure
    position: Point = (0.0, 0.0, 0.0)
    yaw: float = 0.0
    above: bool = False
    laid: bool = False
    lamp: bool = False


@lru_cache(maxsize=4096)
def placed(thing: Thing) -> Mesh:
    """A thing's mesh in world coordinates."""
    mesh = figure_mesh(thing.model) if isinstance(thing.model, Figure) else draw(thing.model)
    mesh = transform(mesh, rotation("y", thing.yaw), thing.position)
    return replace(mesh, uvs=_world_uvs(mesh, thing)) if thing.laid else mesh


def _world_uvs(mesh: Mesh, thing: Thing) -> Floats:
    """Texture coordinates by place, so that floor tiles and wall panels continue each other."""
    before = draw(thing.model) if isinstance(thing.model, Model) else mesh
    corners = before.corners
    span = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
    tiles = np.linalg.norm(before.uvs[:, 1] - before.uvs[:, 0], axis=1)
    scale = float(np.median(tiles / np.maximum(span, 1e-6)))
    main = np.abs(mesh.normals[:, 0]).argmax(axis=1)
    axes = np.array(((2, 1), (0, 2), (0, 1)))[main]
    rows = np.arange(len(mesh))[:, None]
    return np.stack([mesh.corners[rows, np.arange(3), axes[:, k, None]] for k in (0, 1)], axis=-1) * scale
