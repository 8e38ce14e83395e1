"""Annotations of a picture: camera, boxes of things, joints of people (thesis 2.4, 4.4)."""

from functools import lru_cache
from math import cos, radians, sin
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.cameras.camera import Camera, point_of
from hearth.rendering.people.figure import Figure
from hearth.rendering.rays.camera_shot import Shot
from hearth.rendering.rays.pixel_maps import extents
from hearth.rendering.scene.instances import Thing, own_mesh
from hearth.schemas.graph import Point


class Seen(NamedTuple):
    """One visible thing.

    Attributes:
        node, class_name: the thing's.
        pixels: number of pixels that show it.
        box: (left, top, right, bottom) of those pixels; right and bottom are outside.
        center, size, yaw: its box in the world, metres, and degrees about y from +z.
        corners: (8, 2) projections of that box's corners, pixels; NaN behind the camera.
    """

    node: int
    class_name: str
    pixels: int
    box: tuple[int, int, int, int]
    center: Point
    size: Point
    yaw: float
    corners: NDArray[np.floating[Any]]


class Skeleton(NamedTuple):
    """The joints of one character.

    Attributes:
        node: the character's.
        joints: name -> position in the world, metres.
        pixels: name -> (column, row, depth in metres); may lie outside the picture. Column and row are NaN behind the
            camera.
        visible: names of the joints that nothing but the body itself hides.
    """

    node: int
    joints: dict[str, Point]
    pixels: dict[str, Point]
    visible: tuple[str, ...]


def seen(shot: Shot) -> list[Seen]:
    """Return the visible things and characters, by node id. A thing drawn in parts has its first part's box."""
    things, camera = shot.geometry.things, shot.camera
    found = np.tile(np.array((camera.width, camera.height, 0, 0, 0), np.int32), (len(things), 1))
    extents(shot.hits.triangle, shot.geometry.owners, camera.width, found)
    first: dict[int, Thing] = {}
    joined: dict[int, NDArray[np.int32]] = {}
    for number in np.flatnonzero(found[:, 4]).tolist():
        joined[things[number].id] = _joined(joined.get(things[number].id), found[number])
    for thing in things:
        first.setdefault(thing.id, thing)
    boxes = [world_box(first[node]) for node in sorted(joined)]
    places, depths = camera.project(np.array([box.corners for box in boxes]).reshape(-1, 3))
    places[depths <= 0] = np.nan
    return [
        Seen(node, first[node].class_name, extent[4], tuple(extent[:4]), box.center, box.size, first[node].yaw, corners)
        for (node, extent), box, corners in zip(
            sorted((node, extent.tolist()) for node, extent in joined.items()),
            boxes,
            places.reshape(-1, 8, 2),
            strict=True,
        )
    ]


class WorldBox(NamedTuple):
    """The box of a thing in the world: center, size in the thing's own frame, and (8, 3) corners; metres."""

    center: Point
    size: Point
    corners: NDArray[np.float64]


@lru_cache(maxsize=4096)
def world_box(thing: Thing) -> WorldBox:
    """Return the box around a thing's mesh, oriented as the thing is."""
    mesh = own_mesh(thing)
    low, high = (bound.astype(np.float64) for bound in mesh.bounds())
    corners = np.array([_placed(thing, (x, y, z)) for x, y, z in _corners(low, high)])
    return WorldBox(_placed(thing, point_of((low + high) / 2)), point_of(high - low), corners)


def _joined(one: NDArray[np.int32] | None, other: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return the union of the extents of two parts of a thing."""
    if one is None:
        return other
    return np.array((*np.minimum(one[:2], other[:2]), *np.maximum(one[2:4], other[2:4]), one[4] + other[4]), np.int32)


def _corners(low: NDArray[Any], high: NDArray[Any]) -> list[Point]:
    pairs = list(zip(low.tolist(), high.tolist(), strict=True))
    return [(x, y, z) for x in pairs[0] for y in pairs[1] for z in pairs[2]]


def _placed(thing: Thing, point: Point) -> Point:
    """World coordinates of a point in a thing's own frame."""
    c, s = cos(radians(thing.yaw)), sin(radians(thing.yaw))
    (x, y, z), (px, py, pz) = point, thing.position
    return px + x * c + z * s, py + y, pz - x * s + z * c


BEHIND = 0.2
"""Metres by which a joint may lie behind the surface of its own body."""


def skeletons(shot: Shot) -> list[Skeleton]:
    """Return the joints of every character in the scene, sorted by node id."""
    camera = shot.camera
    found = []
    for thing in sorted(shot.geometry.things, key=lambda thing: thing.id):
        if not isinstance(thing.model, Figure):
            continue
        joints = {name: _placed(thing, point_of(at)) for name, at in sorted(thing.model.joints().items())}
        places, depths = camera.project(np.array(list(joints.values())))
        places[depths <= 0] = np.nan
        pixels = {
            name: (float(x), float(y), float(depth)) for name, (x, y), depth in zip(joints, places, depths, strict=True)
        }
        visible = tuple(name for name, place in pixels.items() if _is_visible(shot, thing, place))
        found.append(Skeleton(thing.id, joints, pixels, visible))
    return found


def _is_visible(shot: Shot, thing: Thing, place: Point) -> bool:
    column, row, depth = place
    camera = shot.camera
    if depth <= 0 or not (0 <= column < camera.width and 0 <= row < camera.height):
        return False
    pixel = int(row) * camera.width + int(column)
    owner = int(shot.owner[pixel])
    there = float(shot.distance[pixel])
    return there > depth or (owner >= 0 and shot.geometry.things[owner].id == thing.id and there > depth - BEHIND)


def camera_of(camera: Camera) -> dict[str, Any]:
    """Return a camera as plain values: name, size, (3, 3) intrinsics and (4, 4) camera-to-world pose."""
    return {
        "name": camera.name,
        "width": camera.width,
        "height": camera.height,
        "intrinsics": _rounded(camera.intrinsics),
        "pose": _rounded(camera.pose),
    }


def described(shot: Shot) -> dict[str, Any]:
    """Camera, boxes and joints of a picture as plain values, ready for JSON; metres and pixels, rounded to 1e-4."""
    return {"camera": camera_of(shot.camera), "objects": boxes(shot), "people": poses(shot)}


def boxes(shot: Shot) -> list[dict[str, Any]]:
    """2D and 3D boxes of the visible things, as plain values."""
    return [
        {
            "node": one.node,
            "class_name": one.class_name,
            "pixels": one.pixels,
            "box_2d": list(one.box),
            "box_3d": {"center": _rounded(one.center), "size": _rounded(one.size), "yaw": round(one.yaw, 4)},
        }
        for one in seen(shot)
    ]


def poses(shot: Shot) -> list[dict[str, Any]]:
    """3D and 2D joints of every character, as plain values; 2D joints behind the camera are None."""
    return [
        {
            "node": one.node,
            "joints_3d": {name: _rounded(at) for name, at in one.joints.items()},
            "joints_2d": {name: _rounded(at[:2]) if at[2] > 0 else None for name, at in one.pixels.items()},
            "visible": list(one.visible),
        }
        for one in skeletons(shot)
    ]


def _rounded(values: Any) -> Any:
    if isinstance(values, tuple):
        return [round(float(value), 4) + 0.0 for value in values]
    return np.round(np.asarray(values, np.float64) + 0.0, 4).tolist()
