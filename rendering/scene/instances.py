"""Things of a scene, each with a model, a position and a node id."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from hearth.rendering.arrays import Floats
from hearth.rendering.models.class_appearance import Model, draw
from hearth.rendering.models.mesh import Mesh, rotation, transform
from hearth.rendering.people.figure import Figure, figure_mesh
from hearth.schemas.graph import Point


@dataclass(frozen=True, slots=True)
class Thing:
    """A drawn instance of a model.

    Attributes:
        id: of its node; the value of its pixels in `instance_ids`.
        class_name: of its node.
        model: its mesh.
        position: of its foot's middle, metres.
        yaw: its direction, degrees from +z towards +x.
        tilt: pitch, roll and turn in degrees about its own x, z and y, before `yaw`: turned first, then tilted.
        above: whether views from above leave it out (ceilings and hanging things).
        structural: whether it is part of the building: texture in world coordinates, inside never seen.
        lamp: whether it is a lamp that is on, which casts no shadow.
    """

    id: int
    class_name: str
    model: Model | Figure
    position: Point = (0.0, 0.0, 0.0)
    yaw: float = 0.0
    above: bool = False
    structural: bool = False
    lamp: bool = False
    tilt: Point = (0.0, 0.0, 0.0)


def tilted(tilt: Point) -> Floats:
    """Return the rotation of a `Thing.tilt`."""
    pitch, roll, turn = tilt
    found: Floats = rotation("z", -roll) @ rotation("x", -pitch) @ rotation("y", turn)
    return found


def own_mesh(thing: Thing) -> Mesh:
    """Return a thing's mesh in its own frame, tilted."""
    mesh = figure_mesh(thing.model) if isinstance(thing.model, Figure) else draw(thing.model)
    return transform(mesh, tilted(thing.tilt)) if any(thing.tilt) else mesh


def placed(thing: Thing) -> Mesh:
    """Return a thing's mesh in world coordinates."""
    return (_figures if isinstance(thing.model, Figure) else _things)(thing)


def forget() -> None:
    """Forget what `placed` keeps, to measure what it takes."""
    _figures.cache_clear()
    _things.cache_clear()


def _in_world(thing: Thing) -> Mesh:
    mesh = own_mesh(thing)
    mesh = transform(mesh, rotation("y", thing.yaw), thing.position)
    return replace(mesh, uvs=_world_uvs(mesh, thing)) if thing.structural else mesh


_things = lru_cache(maxsize=1024)(_in_world)

_figures = lru_cache(maxsize=64)(_in_world)
"""Of people, whose poses are seldom seen again: a film has hundreds, each of two megabytes."""


def _world_uvs(mesh: Mesh, thing: Thing) -> Floats:
    """Texture coordinates in the world, so that adjacent floor and wall panels match."""
    before = draw(thing.model) if isinstance(thing.model, Model) else mesh
    corners = before.corners
    span = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
    tiles = np.linalg.norm(before.uvs[:, 1] - before.uvs[:, 0], axis=1)
    scale = float(np.median(tiles / np.maximum(span, 1e-6)))
    main = np.abs(mesh.normals[:, 0]).argmax(axis=1)
    axes = np.array(((2, 1), (0, 2), (0, 1)))[main]
    rows = np.arange(len(mesh))[:, None]
    return np.stack([mesh.corners[rows, np.arange(3), axes[:, k, None]] for k in (0, 1)], axis=-1) * scale
