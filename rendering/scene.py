"""Scenes: an environment graph with boxes, made of triangles that rays can hit."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.figure import Figure, figure_mesh
from hearth.rendering.lights import Daylight, Light, daylight
from hearth.rendering.meshes.mesh import Floats, Mesh, join, rotation, transform
from hearth.rendering.meshes.shapes import face_normals
from hearth.rendering.models import Model, draw
from hearth.rendering.rays import Caster

Point = tuple[float, float, float]


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


@dataclass(frozen=True, eq=False)
class Geometry:
    """All triangles of a scene.

    Attributes:
        things: those that are in it.
        mesh: of everything, in world coordinates.
        owner: (T,) index of each triangle's thing.
        solid: (T,) whether one must not see it from behind (walls, floors).
        caster: for rays.
    """

    things: tuple[Thing, ...]
    mesh: Mesh
    owner: NDArray[np.int32]
    solid: NDArray[np.bool_]
    caster: Caster

    @classmethod
    def of(cls, things: tuple[Thing, ...]) -> Geometry:
        """Of the things, in their order."""
        meshes = [placed(thing) for thing in things]
        mesh = join(meshes)
        owner = np.repeat(np.arange(len(meshes), dtype=np.int32), [len(m) for m in meshes])
        solid = np.array([thing.laid for thing in things], np.bool_)
        return cls(things, mesh, owner, solid[owner], Caster.of(mesh.corners))

    @cached_property
    def flat(self) -> Floats:
        """(T, 3) normals of the triangles themselves."""
        return face_normals(self.mesh.corners)

    @cached_property
    def density(self) -> Floats:
        """(T,) tiles of its texture a metre of each triangle."""
        corners, uvs = self.mesh.corners, self.mesh.uvs
        span = np.linalg.norm(corners[:, 1:] - corners[:, :1], axis=2).max(axis=1)
        tiles = np.linalg.norm(uvs[:, 1:] - uvs[:, :1], axis=2).max(axis=1)
        return (tiles / np.maximum(span, 1e-6)).astype(np.float32)

    @cached_property
    def shadows(self) -> Caster:
        """What keeps the light of lamps away: everything but the lamps themselves."""
        lamps = np.array([thing.lamp for thing in self.things], np.bool_)
        return Caster.of(self.mesh.corners[~lamps[self.owner]]) if lamps.any() else self.caster


@dataclass(frozen=True, eq=False)
class Scene:
    """What a picture is taken of. Immutable; geometry is built when it is first needed.

    Attributes:
        things: everything with a shape.
        lights: lamps that are on, and windows by day.
        day: sun and sky.
    """

    things: tuple[Thing, ...]
    lights: tuple[Light, ...] = ()
    day: Daylight = field(default_factory=daylight)

    @cached_property
    def geometry(self) -> Geometry:
        """Everything."""
        return Geometry.of(self.things)

    @cached_property
    def opened(self) -> Geometry:
        """Everything but ceilings and what hangs there: for views from above."""
        return Geometry.of(tuple(thing for thing in self.things if not thing.above))

    def find(self, node_id: int) -> Thing | None:
        """The thing of that id."""
        return next((thing for thing in self.things if thing.id == node_id), None)
