"""Effects of states: light, pictures that change, trembling, steam; the same at the same time."""

from dataclasses import replace

import numpy as np
import pytest

from hearth.kb.loading.load import default
from hearth.rendering.cameras.camera import look_at
from hearth.rendering.modalities import render
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model, draw
from hearth.rendering.models.model_recipes import RECIPES
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.scene_preparation import prepared_scene
from hearth.rendering.scene.visible_state_effects import EFFECTS, STEAM, at_time, changes, shining
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node
from hearth.schemas.vocabulary import STATES

ON = frozenset({"ON"})


def thing(recipe, states=ON):
    return Thing(7, recipe, Model(recipe, Look(RECIPES[recipe].size, states=states)), yaw=30.0)


def test_effects_name_models_and_states_that_exist():
    for recipe, states in EFFECTS.items():
        assert recipe in RECIPES and set(states) <= set(STATES), recipe
        for state, effect in states.items():
            assert effect.light is None or list(shining(recipe, frozenset({state}), RECIPES[recipe].lamp)), recipe


@pytest.mark.parametrize("recipe", [r for r, states in EFFECTS.items() if any(e.moments > 1 for e in states.values())])
def test_what_changes_with_time_looks_different_and_comes_again(recipe):
    effect = EFFECTS[recipe]["ON"]
    shown = [next(at_time(thing(recipe), k * effect.every)) for k in range(effect.moments + 1)]
    looks = [(draw(one.model).corners.tobytes(), draw(one.model).textures.tobytes()) for one in shown]
    assert looks[0] == looks[-1] and len(set(looks)) > 1
    assert shown[1].model == next(at_time(thing(recipe), 1.01 * effect.every)).model


def test_nothing_changes_while_it_is_off():
    for recipe in EFFECTS:
        still = thing(recipe, frozenset({"OFF", "CLOSED"}))
        assert not changes(still)
        assert tuple(at_time(still, 3.3)) == (still,)


def test_a_coffee_maker_trembles_and_steams_where_it_stands():
    times = np.arange(0, 2, 1 / 15)
    shown = [tuple(at_time(thing("coffee_maker"), float(time))) for time in times]
    assert all([one.model.recipe for one in each] == ["coffee_maker", STEAM] for each in shown)
    spots = np.array([each[0].position for each in shown])
    assert 0.002 < np.abs(spots).max() <= EFFECTS["coffee_maker"]["ON"].shake
    assert {one.id for each in shown for one in each} == {7}


def test_labels_of_a_machine_that_steams_are_its_own_and_its_flow_is_small():
    pytest.importorskip("open3d")
    now, later = (Scene(tuple(at_time(thing("coffee_maker"), time))) for time in (1.0, 1.3))
    camera = look_at("test", (0, 0.3, 1), (0, 0.2, 0), 80, 60)
    found = render(now, camera, ["boxes", "flow", "instance_ids"], after=later)
    (box,) = found["boxes"]
    assert box["box_3d"]["size"] == pytest.approx(RECIPES["coffee_maker"].size, abs=0.03)
    low = found["flow"][np.argwhere(found["instance_ids"]).max(axis=0)[0] - 4]
    assert np.nanmax(np.abs(low)) < 1


def test_toast_rises_from_a_toaster_and_its_lever_with_it():
    look = thing("toaster").model.look
    low, high = (draw(Model("toaster", replace(look, moment=moment))).bounds()[1][1] for moment in (8, 9))
    assert high > low + 0.2 * look.size[1]


def lights(class_name, states, yaw=90.0):
    room = Node(1, "kitchen", "Rooms", (), (), None, Box((0, 1.3, 0), (5, 2.6, 4)))
    node = Node(2, class_name, "Props", (), states, None, Box((0.0, 1.0, 0.0), (0.2, 0.6, 1.0)), yaw)
    return prepared_scene(EnvironmentGraph((room, node), (Edge(2, "INSIDE", 1),)), default()).scene().lights


def test_a_screen_lights_what_is_in_front_of_it():
    assert lights("television", ("OFF",)) == ()
    (light,) = lights("television", ("ON",))
    # It looks along +x: the light is before the screen, and bluish.
    assert 0.1 < light.position[0] < 0.4 and abs(light.position[2]) < 1e-9
    assert light.color[2] > light.color[0]


def test_a_fridge_is_lit_while_it_is_open():
    assert lights("fridge", ("CLOSED",)) == ()
    assert len(lights("fridge", ("OPEN",))) == 1
