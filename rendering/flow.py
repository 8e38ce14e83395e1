"""Optical flow: where each visible point is in the next picture (thesis 2.4)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.modalities import Shot, shoot
from hearth.rendering.scene import Scene
from hearth.rendering.things import Thing, placed

Floats = NDArray[np.floating[Any]]
Ids = NDArray[np.int64]

TOLERANCE = 0.02
"""How far a depth may be from the one expected, as a share of it, for the same point to be seen."""


def flow(shot: Shot, after: Shot) -> Floats:
    """(H, W, 2) how many pixels each point moves right and down until the next picture; NaN where it is not seen there.

    Points move with their triangles, so limbs count as well as what is carried; things whose shape changes (a door
    that opens) move as a whole. The sky turns with the camera only.

    Args:
        shot: a picture.
        after: the next one, of any camera of the same size.
    """
    camera = shot.camera
    points, found = _points(shot), shot.hits.triangle >= 0
    points[found] += _moved(shot, after, points)[found]
    places, depths = after.camera.project(points)
    where = _cells(after, places, depths)
    seen = _same(shot, after, found, where, depths)
    column, row = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
    moved = places - np.column_stack((column.reshape(-1), row.reshape(-1)))
    moved[~seen] = np.nan
    return shot.image(moved.astype(np.float32))


def flow_of(scene: Scene, shot: Shot) -> Floats:
    """Flow from a shot to the same camera's picture of a later scene."""
    return flow(shot, shoot(scene, shot.camera))


HORIZON = 1e5
"""Metres away that the sky is taken to be."""


def _points(shot: Shot) -> Floats:
    """(N, 3) what each ray hit."""
    far = np.where(shot.hits.triangle >= 0, shot.hits.distance, HORIZON)
    points: Floats = (shot.rays[:3] + shot.rays[3:] * far).T.astype(np.float64)
    return points


def _moved(shot: Shot, after: Shot, points: Floats) -> Floats:
    """(N, 3) by how much each point moves until the later moment."""
    moved = np.zeros_like(points)
    later: dict[int, list[Thing]] = {}
    for thing in after.geometry.moving.things:
        later.setdefault(thing.id, []).append(thing)
    still, there = len(shot.geometry.still.things), set(after.geometry.moving.things)
    seen = shot.owner
    for number, thing in enumerate(shot.geometry.moving.things, still):
        if thing in there or thing.id not in later:
            continue
        pixels = np.flatnonzero(seen == number)
        if len(pixels):
            first = shot.geometry.first + int(shot.geometry.moving.starts[number - still])
            moved[pixels] = _displaced(shot, pixels, first, thing, later[thing.id][0], points[pixels])
    return moved


def _displaced(shot: Shot, pixels: Ids, first: int, thing: Thing, other: Thing, points: Floats) -> Floats:
    """(P, 3) by how much the points of one thing move when it becomes another."""
    before, now = placed(thing).corners, placed(other).corners
    if len(before) == len(now):
        triangle = shot.hits.triangle[pixels] - first
        u, v = shot.hits.u[pixels, None], shot.hits.v[pixels, None]
        change = now[triangle] - before[triangle]
        moved: Floats = change[:, 0] * (1 - u - v) + change[:, 1] * u + change[:, 2] * v
        return moved
    turn = np.radians(other.yaw - thing.yaw)
    x, _, z = (points - np.array(thing.position)).T
    c, s = np.cos(turn), np.sin(turn)
    shift = np.array(other.position) - np.array(thing.position)
    turned: Floats = shift + np.column_stack((x * c + z * s - x, np.zeros(len(x)), z * c - x * s - z))
    return turned


def _cells(after: Shot, places: Floats, depths: Floats) -> Ids:
    """(N,) index of the pixel each place falls into; -1 outside the picture."""
    width, height = after.camera.width, after.camera.height
    with np.errstate(invalid="ignore"):
        inside = (depths > 0) & (places[:, 0] >= 0) & (places[:, 0] < width)
        inside &= (places[:, 1] >= 0) & (places[:, 1] < height)
    cells = np.full(len(places), -1, np.int64)
    column, row = places[inside].astype(np.int64).T
    cells[inside] = row * width + column
    return cells


def _same(shot: Shot, after: Shot, found: NDArray[np.bool_], where: Ids, depths: Floats) -> NDArray[np.bool_]:
    """(N,) whether the pixel that a point falls into shows it: the same thing at the same depth."""
    mine, theirs = (
        np.array([*(thing.id for thing in s.geometry.things), -1]).take(s.owner, mode="wrap") for s in (shot, after)
    )
    distance = np.where(after.hits.triangle >= 0, after.hits.distance + after.skipped, HORIZON)
    near = np.abs(distance[where] - depths) <= TOLERANCE * depths + 0.02
    same: NDArray[np.bool_] = (where >= 0) & (mine == theirs[where]) & (near | ~found)
    return same
