"""The sheet of all recipes, variants, kinds and states, for review by eye."""

from collections.abc import Iterator
from math import radians, tan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.cameras.camera import Camera, point_of
from hearth.rendering.modalities import render
from hearth.rendering.models.appearance import Look, Size
from hearth.rendering.models.class_appearance import Model, draw
from hearth.rendering.models.model_recipes import RECIPES
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.lights import Daylight, Light
from hearth.rendering.scene.scene import Scene
from hearth.schemas.optional_libraries import library

TILE = 128
LABEL = 14
STUDIO = Daylight((0.45, 0.72, 0.52), (0.85, 0.82, 0.76), (0.9, 0.92, 0.95), (0.9, 0.92, 0.95), 0.55, 1.0)


def entries() -> Iterator[tuple[str, Model]]:
    """(label, model) of every recipe: variants and kinds first, then each visible state."""
    for name, recipe in RECIPES.items():
        designs = [(v, kind) for v in range(recipe.variants) for kind in (recipe.kinds or ("",))]
        for number, (variant, kind) in enumerate(designs):
            label = name + (f" {kind}" if kind else "") + (f" #{variant + 1}" if recipe.variants > 1 else "")
            yield label, Model(name, Look(recipe.size, variant, seed=number + 5, kind=kind))
        for state in recipe.states:
            look = Look(recipe.size, seed=5, kind=recipe.kinds[0] if recipe.kinds else "", states=frozenset((state,)))
            yield f"{name} {state}", Model(name, look)


def portrait(model: Model, size: Size, side: int = TILE, quality: str = "fine") -> NDArray[np.uint8]:
    """(side, side, 3) a picture of one model on a pale floor, from the front left and above."""
    low, high = draw(model).bounds()
    middle, radius = (low + high) / 2, float(np.linalg.norm(high - low)) / 2
    flat = size[1] < 0.25 * max(size[0], size[2])
    direction = np.array((-0.42, 0.95 if flat else 0.42, 0.85))
    direction /= np.linalg.norm(direction)
    fov = 26.0
    eye = middle + direction * radius * 1.04 / tan(radians(fov) / 2)
    camera = Camera("portrait", point_of(eye), point_of(middle), side, side, fov)
    ground = Thing(
        0, "floor", Model("ceiling", Look((radius * 40, 0.02, radius * 40))), (0.0, float(low[1]) - 0.022, 0.0)
    )
    light = Light((-2.0 * radius, 3 * radius, 2.2 * radius), (0.3, 0.3, 0.32), (0.3, 0.3, 0.3))
    scene = Scene((ground, Thing(1, model.recipe, model)), (light,), STUDIO)
    picture: NDArray[np.uint8] = render(scene, camera, ("rgb",), quality=quality)["rgb"]
    return picture


def sheet(columns: int = 14, side: int = TILE, quality: str = "fine") -> NDArray[np.uint8]:
    """All entries with labels, in rows of `columns`."""
    tiles = [labelled(portrait(model, model.look.size, side, quality), label) for label, model in entries()]
    blank = np.full_like(tiles[0], 255)
    tiles += [blank] * (-len(tiles) % columns)
    rows = [np.concatenate(tiles[i : i + columns], axis=1) for i in range(0, len(tiles), columns)]
    return np.concatenate(rows)


def labelled(image: NDArray[np.uint8], label: str) -> NDArray[np.uint8]:
    """Return the picture above a line of text."""
    cv2 = library("cv2")

    strip: NDArray[Any] = np.full((LABEL, image.shape[1], 3), 255, np.uint8)
    cv2.putText(strip, label, (2, 10), cv2.FONT_HERSHEY_SIMPLEX, 0.32, (40, 40, 40), 1, cv2.LINE_AA)
    return np.concatenate((image, strip))
