"""Recipes fill their boxes, every class has one, and states show."""

import numpy as np
import pytest

from hearth.kb.loading.load import default
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import FALLBACK, Model, choice_of, draw, looks, model_of
from hearth.rendering.models.model_recipes import RECIPES

BEYOND = 0.08
"""Metres that handles, taps, sills and door frames may reach beyond their box."""


@pytest.mark.parametrize("name", sorted(RECIPES))
def test_a_recipe_stands_in_its_box(name):
    recipe = RECIPES[name]
    w, h, d = recipe.size
    for variant in range(recipe.variants):
        for kind in recipe.kinds or ("",):
            mesh = draw(Model(name, Look(recipe.size, variant, 3, kind=kind)))
            low, high = mesh.bounds()
            assert len(mesh) > 1
            assert np.isfinite(mesh.corners).all()
            assert np.allclose(np.linalg.norm(mesh.normals, axis=-1), 1, atol=2e-2)
            beyond = 0.2 if name == "bathtub" else BEYOND
            assert (low >= np.array((-w / 2, 0, -d / 2)) - beyond).all(), (name, low)
            assert (high <= np.array((w / 2, h, d / 2)) + beyond).all(), (name, high)
            # It fills most of the box in its two largest directions.
            share = (high - low) / np.array(recipe.size)
            assert sorted(share)[1] > 0.6, (name, share)


@pytest.mark.parametrize("name", sorted(n for n, recipe in RECIPES.items() if recipe.states))
def test_states_show(name):
    recipe = RECIPES[name]
    kind = recipe.kinds[0] if recipe.kinds else ""
    plain = draw(Model(name, Look(recipe.size, seed=3, kind=kind)))
    for state in recipe.states:
        other = draw(Model(name, Look(recipe.size, seed=3, kind=kind, states=frozenset((state,)))))
        different = len(plain) != len(other) or not (
            np.array_equal(plain.corners, other.corners)
            and np.array_equal(plain.surface, other.surface)
            and np.array_equal(plain.textures, other.textures)
        )
        assert different, (name, state)


def test_dirt_shows():
    clean = draw(Model("plate", Look(RECIPES["plate"].size)))
    dirty = draw(Model("plate", Look(RECIPES["plate"].size, states=frozenset(("DIRTY",)))))
    assert not np.array_equal(clean.textures, dirty.textures)


def test_at_least_45_recipes_and_every_class_finds_one():
    knowledge = default()
    unseen = {"Rooms", "BodyParts", "Characters", "People"}
    drawn = [name for name, known in knowledge.objects.items() if known.category not in unseen]
    assert len(RECIPES) >= 45
    assert [name for name in drawn if choice_of(name, knowledge).recipe == FALLBACK] == []
    assert choice_of("no_such_thing", knowledge).recipe == FALLBACK
    assert choice_of("bed", knowledge).recipe != FALLBACK


def test_looks_name_recipes_and_kinds_that_exist():
    for name, choice in looks().items():
        recipe = RECIPES[choice.recipe]
        assert choice.variant is None or choice.variant < recipe.variants, name


def test_the_same_object_always_looks_the_same():
    knowledge = default()
    one, same, other = (model_of("chair", (0.45, 0.9, 0.48), frozenset(), seed, knowledge) for seed in (5, 5, 6))
    assert one == same
    assert one != other
