"""The classes that one sees most have three forms, which differ in shape, by the seed."""

from collections import Counter

import numpy as np

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model, choice_of, draw, model_of
from hearth.rendering.models.model_recipes import RECIPES
from hearth.rendering.scene.scene_preparation import prepared_scene

BUILDING = {"Rooms", "Characters", "BodyParts", "Floors", "Floor", "Walls", "Wall", "Ceiling", "Doors", "Windows"}
SHELL = ("floor", "wall", "ceiling", "window", "doorjamb", "door")
MOST, ASKED = 60, 3
FEWER = {"packet", "bottle"}
"""Recipes among them whose forms are their kinds."""


def seen():
    """The classes of things in our homes, the most frequent first."""
    count = Counter()
    for name in library.names():
        graph = library.load_graph(name, default())
        count.update(node.class_name for node in graph.nodes if node.box and node.category not in BUILDING)
    return [name for name, _ in sorted(count.items(), key=lambda found: (-found[1], found[0]))]


def forms(name, choice):
    recipe = RECIPES[choice.recipe]
    kind = choice.kind or (recipe.kinds[0] if recipe.kinds else "")
    meshes = [draw(Model(choice.recipe, Look(recipe.size, k, 3, kind=kind))) for k in range(recipe.variants)]
    return len({np.round(mesh.corners, 4).tobytes() for mesh in meshes})


def test_what_one_sees_most_has_three_forms():
    fewer = []
    for name in seen()[:MOST]:
        choice = choice_of(name, default())
        if (
            choice.recipe not in ("floor", "wall", "ceiling", "window", "doorjamb", "door")
            and forms(name, choice) < ASKED
        ):
            fewer.append((name, choice.recipe))
    assert {recipe for _, recipe in fewer} <= FEWER, fewer


def test_the_seed_decides_the_form():
    drawn = {model_of("mug", (0.12, 0.1, 0.085), frozenset(), seed, default()).look.variant for seed in range(40)}
    assert drawn == {0, 1, 2}


def test_ids_and_boxes_do_not_depend_on_the_seed():
    graph = library.load_graph("maple", default())
    one, other = (prepared_scene(graph, default(), seed=seed).scene().things for seed in (0, 1))
    assert [(t.id, t.class_name, t.position, t.yaw) for t in one] == [
        (t.id, t.class_name, t.position, t.yaw) for t in other
    ]
    assert [t.model.look.size for t in one] == [t.model.look.size for t in other]
    assert [t.model.look.variant for t in one] != [t.model.look.variant for t in other]
