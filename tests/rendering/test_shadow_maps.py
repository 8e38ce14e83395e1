"""Shadow maps say what rays say: pictures are the same before and after maps are made."""

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.rendering.cameras.camera import look_at
from hearth.rendering.modalities import render
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.rays import shadow_loops, shadow_maps
from hearth.rendering.rays.convex_triangle_groups import unshaded_groups
from hearth.rendering.scene.instances import Thing, placed
from hearth.rendering.scene.lights import Light, daylight
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.triangles import StaticThings
from hearth.schemas.rng import rng

CAMERA = look_at("test", (2.6, 2.2, 2.8), (0.0, 0.4, 0.0), 96, 72)
AREA = (-4.0, 4.0, -4.0, 4.0)


def box(number, size, at, yaw=0.0):
    return Thing(number, "toy", Model("ceiling", Look(size)), at, yaw)


def scene(seed):
    """A floor, two walls, and boxes and balls of all sizes, of which one moves, under a sun and two lamps."""
    drawn = rng(seed, "test shadow maps", "")
    things = [
        box(1, (7.0, 0.1, 7.0), (0.0, -0.1, 0.0)),
        box(2, (0.1, 2.4, 7.0), (-3.0, 0.0, 0.0)),
        box(3, (7.0, 2.4, 0.1), (0.0, 0.0, -3.0)),
    ]
    for number in range(4, 24):
        at = (drawn.uniform(-2.5, 2.5), drawn.choice((0.0, 0.3, 0.9)), drawn.uniform(-2.5, 2.5))
        size = tuple(drawn.choice((0.02, 0.1, 0.4, 0.9)) for _ in range(3))
        ball = Thing(number, "ball", Model("toy", Look(size, kind="ball")), at)
        things.append(box(number, size, at, drawn.uniform(0, 90)) if number % 2 else ball)
    lamps = [(drawn.uniform(-2, 2), 2.2, drawn.uniform(-2, 2)), (0.3, 1.1, 1.4)]
    lights = tuple(Light(at, (1.0, 0.9, 0.7), room=AREA) for at in lamps)
    return Scene(tuple(things[-1:]), lights, daylight(10.0), StaticThings(tuple(things[:-1])))


def picture(shown):
    return render(shown, CAMERA, ("rgb",))["rgb"]


@pytest.mark.parametrize("seed", range(6))
def test_pictures_do_not_depend_on_when_maps_are_made(monkeypatch, seed):
    """Nor do maps leave many points unsure: then they would be of no use."""
    shown, looked, left = scene(seed), [], []
    plain = picture(shown)
    known = shadow_maps.ShadowMap.certain

    def counted(self, rays, *rest):
        looked.append(len(rays))
        left.append(known(self, rays, *rest))
        return left[-1]

    monkeypatch.setattr(shadow_maps, "WORTH", 1)
    monkeypatch.setattr(shadow_maps.ShadowMap, "certain", counted)
    assert np.array_equal(picture(shown), plain)
    assert len(shown.static.whole.shadow_maps.made) == 3, "of the sun and both lamps"
    assert 0 < sum(left) < 0.3 * sum(looked)


def test_no_map_is_made_for_a_single_picture():
    shown = scene(0)
    picture(shown)
    assert not shown.static.whole.shadow_maps.made


def test_fine_pictures_whose_shadows_are_soft_ask_for_no_map():
    shown = scene(0)
    render(shown, CAMERA, ("rgb",), quality="fine")
    assert not shown.static.whole.shadow_maps.asked


def test_a_lookup_is_certain_only_within_its_bounds():
    """Nearer than all else of its texel: lit. Behind what covers the texel: dark. Its own body does not shade it."""
    near, far, slack = np.float32(0.9), np.float32(0.5), np.float32(1e-5)
    assert shadow_loops.judged(np.float32(0.95), -1, near, far, np.float32(-1), 7, slack) == shadow_loops.LIT
    assert shadow_loops.judged(np.float32(0.7), -1, near, far, np.float32(-1), 7, slack) == shadow_loops.UNSURE
    assert shadow_loops.judged(np.float32(0.7), 7, near, far, np.float32(-1), 7, slack) == shadow_loops.LIT
    assert shadow_loops.judged(np.float32(0.7), 7, near, near, np.float32(0.8), 7, slack) == shadow_loops.DARK


def test_convex_bodies_and_planes_are_groups_and_other_bodies_are_not():
    """A box is one group; a box with a hole through it shades itself, and so has the groups of its planes."""
    one = placed(box(1, (1.0, 1.0, 1.0), (0.0, 0.0, 0.0))).corners
    groups = unshaded_groups(one, np.zeros(len(one), np.int32))
    assert len(set(groups.tolist())) == 1
    assert groups[0] % 2 == 0
    # Without one of its faces, turned inwards, it is not a convex body as seen from in front.
    inside = np.ascontiguousarray(one[:, ::-1])
    groups = unshaded_groups(inside, np.zeros(len(one), np.int32))
    assert (groups % 2 == 1).all()
    assert len(set(groups.tolist())) >= 6


def test_triangles_without_an_area_have_no_group():
    corners = np.zeros((1, 3, 3), np.float32)
    assert unshaded_groups(corners, np.zeros(1, np.int32)).tolist() == [-1]
