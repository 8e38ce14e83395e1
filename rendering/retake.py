"""Pictures of a camera that stays: only what moved things, their shadows and lights can have changed is drawn again.

Equal to drawing everything again: a pixel is kept when the ray that found it, and every ray that lit it, misses all
that went or came. (Where two surfaces share one place, either may win.)
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering import shading
from hearth.rendering.camera import Camera
from hearth.rendering.geometry import Geometry, Ids, Part
from hearth.rendering.lights import Light, from_above
from hearth.rendering.modalities import NO_NOISE, Shot, draft, shoot
from hearth.rendering.modalities import pictures_of as others
from hearth.rendering.rays import Caster, Hits, put
from hearth.rendering.scene import Scene
from hearth.rendering.things import Thing, placed

Floats = NDArray[np.floating[Any]]
Mask = NDArray[np.bool_]
Where = tuple[Floats, Floats]

MARGIN = 0.01
"""Metres by which boxes of what changed are widened."""


@dataclass(frozen=True, eq=False)
class Take:
    """A draft picture with what the next one needs of it.

    Attributes:
        shot: what each pixel's ray hit.
        rgb: (H*W, 3) its colours.
        drawn: how many pixels were drawn anew.
        known: what `where` gives, if it is known already.
    """

    shot: Shot
    rgb: NDArray[np.uint8]
    drawn: int
    known: Where | None = None

    @cached_property
    def where(self) -> Where:
        """(3, H*W) visible points, and the normals of their triangles; zeros where nothing was hit."""
        if self.known is not None:
            return self.known
        points, flat = np.zeros((2, 3, self.shot.rays.shape[1]), np.float32)
        _locate(self.shot, np.flatnonzero(self.shot.hits.triangle >= 0), points, flat)
        return points, flat


def take(scene: Scene, camera: Camera, last: Take | None = None) -> Take:
    """A draft picture of a scene; at less cost where `last` is one of the same camera and of nearly the same scene."""
    if last is None or last.shot.camera != camera or last.shot.scene.day != scene.day:
        return _whole(scene, camera)
    geometry = scene.geometry if camera.cut is None else scene.opened
    if geometry.still is not last.shot.geometry.still:
        return _whole(scene, camera)
    return _again(scene, geometry, last)


def _whole(scene: Scene, camera: Camera) -> Take:
    shot = shoot(scene, camera)
    return Take(shot, draft(shot), shot.rays.shape[1])


def _locate(shot: Shot, found: Ids, points: Floats, flat: Floats) -> None:
    """Fill in where rays that hit something ended."""
    view = shading.View(shot.rays, shot.hits, NO_NOISE, 0.0, False)
    points[:, found], flat[:, found] = shading.visible_points(shot.geometry, view.part(found))


def _again(scene: Scene, geometry: Geometry, last: Take) -> Take:
    past = last.shot
    old, new = past.geometry.moving, geometry.moving
    kept = set(old.things) & set(new.things)
    gone = _crowd(tuple(thing for thing in old.things if thing not in kept))
    came = _crowd(tuple(thing for thing in new.things if thing not in kept))
    hits = _renumbered(past.hits, old, new, past.geometry.first)
    seen = _seen_anew(past, hits, came)
    shot = replace(past, scene=scene, geometry=geometry, hits=_recast(geometry, past.rays, hits, seen))
    where = _relocated(last.where, shot, seen)
    changed = np.zeros(len(hits.triangle), np.bool_)
    changed[seen] = True
    _mark_lit(changed, shot, past, where, gone, came)
    drawn = np.flatnonzero(changed)
    rgb = last.rgb
    if len(drawn):
        rgb = rgb.copy()
        rgb[drawn] = draft(shot, drawn)
    return Take(shot, rgb, len(drawn), where)


def _relocated(where: Where, shot: Shot, seen: Ids) -> Where:
    found = seen[shot.hits.triangle[seen] >= 0]
    if not len(found):
        return where
    points, flat = (values.copy() for values in where)
    _locate(shot, found, points, flat)
    return points, flat


GONE = -2
"""Triangle of a hit on something that is no longer there."""


def _renumbered(hits: Hits, old: Part, new: Part, first: int) -> Hits:
    """Hits with the triangles of what moves numbered as in the new part."""
    starts = {thing: int(start) for thing, start in zip(new.things, new.starts, strict=True)}
    numbers = np.full(len(old.mesh), GONE, np.int64)
    ends = [*old.starts[1:], len(old.mesh)]
    for thing, start, end in zip(old.things, old.starts, ends, strict=True):
        if thing in starts:
            numbers[start:end] = np.arange(end - start) + starts[thing] + first
    moved = np.flatnonzero(hits.triangle >= first)
    if not len(moved):
        return hits
    triangle = hits.triangle.copy()
    triangle[moved] = numbers[triangle[moved] - first]
    return hits._replace(triangle=triangle)


@dataclass(frozen=True, eq=False)
class Crowd:
    """Things that went or came.

    Attributes:
        caster: their triangles.
        balls: (K, 4) middles and radii of balls that hold all of them, few and small.
        corners: (K, 8, 3) of boxes that do.
    """

    caster: Caster
    balls: Floats
    corners: Floats

    @classmethod
    def of(cls, things: tuple[Thing, ...]) -> Crowd:
        """Of the things."""
        meshes = [placed(thing) for thing in things]
        boxes = _merged([mesh.bounds() for mesh in meshes if len(mesh)])
        middles = [np.append((low + high) / 2, np.linalg.norm(high - low) / 2 + MARGIN) for low, high in boxes]
        corners = [[[box[i][0], box[j][1], box[k][2]] for i, j, k in _EIGHT] for box in boxes]
        return cls(
            Caster.of(np.concatenate([mesh.corners for mesh in meshes]) if meshes else np.zeros((0, 3, 3), np.float32)),
            np.array(middles, np.float32).reshape(-1, 4),
            np.array(corners, np.float64).reshape(-1, 8, 3),
        )


@lru_cache(maxsize=8)
def _crowd(things: tuple[Thing, ...]) -> Crowd:
    """What came in one picture is mostly what goes in the next."""
    return Crowd.of(things)


_EIGHT = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]

NEXT_TO = 0.25
"""Metres between boxes that are taken for one."""


def _merged(boxes: list[tuple[Floats, Floats]]) -> list[tuple[Floats, Floats]]:
    """Boxes around groups of boxes that are next to each other."""
    groups: list[tuple[Floats, Floats]] = []
    for low, high in boxes:
        apart = []
        for other in groups:
            if (low - NEXT_TO < other[1]).all() and (high + NEXT_TO > other[0]).all():
                low, high = np.minimum(low, other[0]), np.maximum(high, other[1])  # noqa: PLW2901 - it grows
            else:
                apart.append(other)
        groups = [*apart, (low, high)]
    return groups


def _seen_anew(past: Shot, hits: Hits, came: Crowd) -> Ids:
    """The pixels that show something else now: what was there is gone, or something came before it."""
    changed = hits.triangle == GONE
    for corners in came.corners:
        near = _pixels(past.camera, corners)
        found = came.caster.cast(past.rays.take(near, axis=1))
        changed[near[found.distance <= hits.distance[near]]] = True
    return np.flatnonzero(changed)


def _pixels(camera: Camera, corners: Floats) -> Ids:
    """The pixels that a box can cover."""
    places, depths = camera.project(corners)
    if depths.min() < MARGIN:
        return np.arange(camera.width * camera.height)
    low = np.clip(np.floor(places.min(axis=0)) - 1, 0, (camera.width, camera.height)).astype(int)
    high = np.clip(np.ceil(places.max(axis=0)) + 1, 0, (camera.width, camera.height)).astype(int)
    rows, columns = np.arange(low[1], high[1]), np.arange(low[0], high[0])
    return (rows[:, None] * camera.width + columns).reshape(-1)


def _recast(geometry: Geometry, rays: Floats, hits: Hits, seen: Ids) -> Hits:
    if not len(seen):
        return hits
    whole = hits.copy()
    put(whole, seen, geometry.cast(rays.take(seen, axis=1)))
    return whole


def _mark_lit(changed: Mask, shot: Shot, past: Shot, where: Where, gone: Crowd, came: Crowd) -> None:
    """Mark the pixels whose light is another: near lights that changed, and where shadows went or came."""
    points, flat = where
    hit = shot.hits.triangle >= 0
    for light in set(shot.scene.lights) ^ set(past.scene.lights):
        reached = shading.within(light, points)
        changed[reached[hit[reached]]] = True
    balls = np.concatenate((gone.balls, came.balls))
    if not len(balls):
        return
    day = shot.scene.day if shot.camera.cut is None else from_above(shot.scene.day)
    if day.sun is not None:
        sun = np.array(day.sun, np.float32)
        rest = np.flatnonzero(_in_sun_of(points, sun, balls) & hit & ~changed)
        rest = rest[shading.dot(sun, flat.take(rest, axis=1)) > 0]
        ways = np.repeat(sun[:, None] * np.float32(shading.FAR), len(rest), axis=1)
        _mark_shadows(changed, rest, (points.take(rest, axis=1), ways, 0.999), gone, came)
    for light in shot.scene.lights:
        if light.facing is None:
            _mark_lamp(changed, light, hit, where, (gone, came))


def _mark_shadows(changed: Mask, rest: Ids, rays: tuple[Floats, Floats, float], gone: Crowd, came: Crowd) -> None:
    """Mark what was in a shadow and is not, or the other way round: only gone and new things can make a difference."""
    changed[rest[gone.caster.occluded(*rays) != came.caster.occluded(*rays)]] = True


def _mark_lamp(changed: Mask, light: Light, hit: Mask, where: Where, crowds: tuple[Crowd, Crowd]) -> None:
    points, flat = where
    middle = np.array(light.position, np.float32)
    balls = np.concatenate([crowd.balls for crowd in crowds])
    if not _near(light, balls):
        return
    rest = shading.within(light, points)
    rest = rest[hit[rest] & ~changed[rest]]
    ways = middle[:, None] - points.take(rest, axis=1)
    near = np.flatnonzero(_in_shade_of(ways, middle, balls))
    rest, ways = rest[near], ways.take(near, axis=1)
    near = np.flatnonzero(shading.dot(ways, flat.take(rest, axis=1)) > 0)
    rest, ways = rest[near], ways.take(near, axis=1)
    _mark_shadows(changed, rest, (points.take(rest, axis=1), ways, 0.97), *crowds)


def _near(light: Light, balls: Floats) -> bool:
    """Whether a ball is where the light shines; beyond, it can shade nothing that the light reaches."""
    x0, x1, z0, z1 = shading.area(light)
    x, z, r = balls[:, 0], balls[:, 2], balls[:, 3]
    return bool(((x + r > x0) & (x - r < x1) & (z + r > z0) & (z - r < z1)).any())


def _in_sun_of(points: Floats, sun: Floats, balls: Floats) -> Mask:
    """(N,) whether a ball lies on the way from points towards the sun."""
    found = np.zeros(points.shape[1], np.bool_)
    for x, y, z, radius in balls:
        away = np.array(((x,), (y,), (z,)), np.float32) - points
        along = shading.dot(sun, away)
        found |= (shading.dot(away, away) - along * along < radius * radius) & (along > -radius)
    return found


def _in_shade_of(ways: Floats, middle: Floats, balls: Floats) -> Mask:
    """(N,) whether a ball lies on the ways, (3, N), that lead to the middle of a lamp."""
    found = np.zeros(ways.shape[1], np.bool_)
    square = shading.dot(ways, ways)
    for ball in balls:
        back = middle - ball[:3]
        far = float(back @ back) - float(ball[3]) ** 2
        along = shading.dot(back, ways)
        # Inside the cone that the ball and the lamp make; all around where the lamp is inside the ball.
        found |= (along > 0) & (along * along >= far * square) if far > 0 else True
    return found


def pictures_of(shown: Take, modalities: Iterable[str]) -> dict[str, NDArray[Any]]:
    """The pictures of a take by modality, as `modalities.render` gives them."""
    names = list(modalities)
    found = others(shown.shot, [name for name in names if name != "rgb"])
    return {name: shown.shot.image(shown.rgb) if name == "rgb" else found[name] for name in names}
