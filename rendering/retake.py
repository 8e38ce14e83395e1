"""Pictures of a camera that stays: only what moved things, their shadows and lights can have changed is drawn again.

Equal to drawing everything again: a pixel is kept when the ray that found it, and every ray that lit it, misses all
that went or came. (Where two surfaces share one place, either may win.)
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
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
    gone = tuple(thing for thing in old.things if thing not in kept)
    came = tuple(thing for thing in new.things if thing not in kept)
    hits = _renumbered(past.hits, old, new, past.geometry.first)
    seen = _seen_anew(past, hits, came)
    shot = replace(past, scene=scene, geometry=geometry, hits=_recast(geometry, past.rays, hits, seen))
    points, flat = (values.copy() for values in last.where)
    _locate(shot, seen[shot.hits.triangle[seen] >= 0], points, flat)
    changed = np.zeros(points.shape[1], np.bool_)
    changed[seen] = True
    _mark_lit(changed, shot, past, (points, flat), gone + came)
    drawn = np.flatnonzero(changed)
    rgb = last.rgb.copy()
    if len(drawn):
        rgb[drawn] = draft(shot, drawn)
    return Take(shot, rgb, len(drawn), (points, flat))


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
    triangle = hits.triangle.copy()
    moved = np.flatnonzero(triangle >= first)
    triangle[moved] = numbers[triangle[moved] - first]
    return hits._replace(triangle=triangle)


def _seen_anew(past: Shot, hits: Hits, came: tuple[Thing, ...]) -> Ids:
    """The pixels that show something else now: what was there is gone, or something came before it."""
    changed = hits.triangle == GONE
    for thing in came:
        origin, way = past.rays[:3], past.rays[3:]
        near = np.flatnonzero(_crosses(_bounds(thing), origin, way, np.float32(1e4)) & ~changed)
        if len(near):
            found = Caster.of(placed(thing).corners).cast(past.rays.take(near, axis=1))
            changed[near[found.distance <= hits.distance[near]]] = True
    return np.flatnonzero(changed)


def _recast(geometry: Geometry, rays: Floats, hits: Hits, seen: Ids) -> Hits:
    if not len(seen):
        return hits
    whole = hits.copy()
    put(whole, seen, geometry.cast(rays.take(seen, axis=1)))
    return whole


def _mark_lit(changed: Mask, shot: Shot, past: Shot, where: Where, things: tuple[Thing, ...]) -> None:
    """Mark the pixels whose light is another: near lights that changed, and where shadows went or came."""
    hit = shot.hits.triangle >= 0
    points, flat = where
    for light in set(shot.scene.lights) ^ set(past.scene.lights):
        reached = shading.within(light, points)
        changed[reached[hit[reached]]] = True
    if not things:
        return
    caster = Caster.of(np.concatenate([placed(thing).corners for thing in things]))
    boxes = [_bounds(thing) for thing in things]
    _mark_sun(changed, shot, (points, flat), hit, caster, boxes)
    for light in shot.scene.lights:
        if light.facing is None:
            _mark_lamp(changed, light, (points, flat), hit, caster, boxes)


Box = tuple[Floats, Floats]


def _mark_sun(changed: Mask, shot: Shot, where: Where, hit: Mask, caster: Caster, boxes: list[Box]) -> None:
    day = shot.scene.day if shot.camera.cut is None else from_above(shot.scene.day)
    if day.sun is None:
        return
    points, flat = where
    sun = np.array(day.sun, np.float32)[:, None] * np.float32(shading.FAR)
    rest = np.flatnonzero(hit & ~changed & (shading.dot(sun[:, 0], flat) > 0))
    origins = points.take(rest, axis=1)
    near = np.zeros(len(rest), np.bool_)
    for box in boxes:
        near |= _crosses(box, origins, sun, np.float32(1))
    rest, origins = rest[near], origins[:, near]
    changed[rest[caster.occluded(origins, np.broadcast_to(sun, origins.shape))]] = True


def _mark_lamp(changed: Mask, light: Light, where: Where, hit: Mask, caster: Caster, boxes: list[Box]) -> None:
    points, flat = where
    rest = shading.within(light, points)
    rest = rest[hit[rest] & ~changed[rest]]
    origins = points.take(rest, axis=1)
    ways = np.array(light.position, np.float32)[:, None] - origins
    facing = np.flatnonzero(shading.dot(ways, flat.take(rest, axis=1)) > 0)
    rest, origins, ways = rest[facing], origins.take(facing, axis=1), ways.take(facing, axis=1)
    near = np.zeros(len(rest), np.bool_)
    for box in boxes:
        near |= _crosses(box, origins, ways, np.float32(1))
    rest, origins, ways = rest[near], origins[:, near], ways[:, near]
    changed[rest[caster.occluded(origins, ways, 0.97)]] = True


def _bounds(thing: Thing) -> Box:
    low, high = placed(thing).bounds()
    return low - np.float32(MARGIN), high + np.float32(MARGIN)


def _crosses(box: Box, origins: Floats, ways: Floats, far: np.float32) -> Mask:
    """(N,) whether a box lies on the way from (3, N) or (3, 1) origins to origin + far * way."""
    enter: Floats = np.zeros(1, np.float32)
    leave: Floats = np.full(1, far, np.float32)
    with np.errstate(divide="ignore", invalid="ignore"):
        for axis in range(3):
            inverse = 1 / ways[axis]
            one, other = (box[0][axis] - origins[axis]) * inverse, (box[1][axis] - origins[axis]) * inverse
            enter, leave = np.maximum(enter, np.fmin(one, other)), np.minimum(leave, np.fmax(one, other))
    crossed: Mask = enter <= leave
    return crossed


def pictures_of(shown: Take, modalities: Iterable[str]) -> dict[str, NDArray[Any]]:
    """The pictures of a take by modality, as `modalities.render` gives them."""
    names = list(modalities)
    found = others(shown.shot, [name for name in names if name != "rgb"])
    return {name: shown.shot.image(shown.rgb) if name == "rgb" else found[name] for name in names}
