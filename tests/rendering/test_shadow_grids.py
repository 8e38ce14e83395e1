"""Light grids: what they say is what rays say, whatever the light and the triangles."""

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.figure import Figure
from hearth.rendering.people.random_people import person
from hearth.rendering.rays.light_rays import FAR
from hearth.rendering.rays.ray_casting import Caster
from hearth.rendering.rays.shadow_grids import LightGrids
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.triangles import Part

LAMPS = [(0.0, 2.4, 0.0), (2.0, 1.0, -0.5), (-0.9, 0.3, 1.2), (0.1, 2.0, 0.1)]
SUNS = [(0.3, 0.8, 0.5), (0.9, 0.05, -0.1), (0.0, 1.0, 0.0)]


def body():
    """A person who stands at the origin."""
    return Part.of((Thing(1, "character", Figure(person(3), BodyPose()), (0.0, 0.0, 0.0), 30.0),))


def around(seed, count=4000):
    """Points around the origin, some of them within the body."""
    numbers = np.random.default_rng(seed)
    spread = np.where(np.arange(count)[:, None] % 2, 0.4, 3.0)
    return (numbers.uniform(-1, 1, (count, 3)) * spread * (1, 0.6, 1) + (0, 0.9, 0)).astype(np.float32)


def by_rays(corners, points, light, is_sun, far):
    """The points whose rays to a light meet a triangle."""
    ways = np.broadcast_to(light * FAR, points.shape) if is_sun else light - points
    rays = np.ascontiguousarray(np.concatenate((points, ways), axis=1), np.float32)
    return set(np.flatnonzero(Caster.of(corners).occluded(rays, far)).tolist())


@pytest.mark.parametrize(("light", "is_sun"), [*((one, False) for one in LAMPS), *((one, True) for one in SUNS)])
def test_a_grid_says_what_rays_say(light, is_sun):
    corners, points, place = body().mesh.corners, around(5), np.array(light, np.float32)
    grid = LightGrids(corners, np.zeros(len(corners), np.int32), np.zeros(1, np.bool_)).of(place, is_sun=is_sun)
    assert grid is not None
    skipped = np.zeros(len(points), np.bool_)
    skipped[::7] = True
    lit = np.flatnonzero(np.arange(len(points)) % 3).astype(np.int32)
    found = set(grid.shaded(lit, skipped, points, 0.97).tolist())
    expected = by_rays(corners, points, place, is_sun, 0.97) & set(lit.tolist()) - set(range(0, len(points), 7))
    assert len(expected) > 20
    # A ray along an edge may be counted either way.
    assert len(found ^ expected) <= 1


def test_a_lamp_within_what_moves_has_no_grid():
    corners = body().mesh.corners
    middle = corners.reshape(-1, 3).mean(axis=0)
    assert LightGrids(corners, *nothing(corners)).of(middle, is_sun=False) is None


def test_large_triangles_have_no_grid():
    walls = np.repeat(np.array([[[0, 0, 0], [9, 0, 0], [0, 9, 0]]], np.float32), 2000, axis=0)
    assert LightGrids(walls, *nothing(walls)).of(np.array((3, 3, 9), np.float32), is_sun=False) is None


def test_lamps_that_are_on_shade_nothing_from_lamps():
    corners = body().mesh.corners
    grids = LightGrids(corners, np.zeros(len(corners), np.int32), np.ones(1, np.bool_))
    assert grids.of(np.array(LAMPS[0], np.float32), is_sun=False) is None
    assert grids.of(np.array(SUNS[0], np.float32), is_sun=True) is not None


def test_grids_made_on_threads_are_those_made_one_by_one():
    corners = body().mesh.corners
    together, alone = (LightGrids(corners, *nothing(corners)) for _ in range(2))
    lights = [(np.array(one, np.float32), False) for one in LAMPS] + [(np.array(one, np.float32), True) for one in SUNS]
    together.make([*lights, *lights])
    assert len(together.made) == len(lights)
    for light, is_sun in lights:
        one, other = together.of(light, is_sun=is_sun), alone.of(light, is_sun=is_sun)
        assert one is not None
        assert other is not None
        assert (one.starts == other.starts).all()
        assert (one.triangles == other.triangles).all()


def nothing(corners):
    """One thing, not a lamp, to which all triangles belong."""
    return np.zeros(len(corners), np.int32), np.zeros(1, np.bool_)
