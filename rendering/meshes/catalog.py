"""Every recipe by its name. To add one: a function and a row in its module, and its classes in `looks.yaml`."""

from __future__ import annotations

from hearth.rendering.meshes import (
    animals,
    appliances,
    bath,
    cleaning,
    clothing,
    decor,
    electronics,
    food,
    lighting,
    oddments,
    seats,
    stationery,
    storage,
    structure,
    tables,
    tableware,
)
from hearth.rendering.meshes.look import Recipe

RECIPES: dict[str, Recipe] = {
    **seats.RECIPES,
    **tables.RECIPES,
    **storage.RECIPES,
    **appliances.RECIPES,
    **electronics.RECIPES,
    **lighting.RECIPES,
    **bath.RECIPES,
    **tableware.RECIPES,
    **food.RECIPES,
    **cleaning.RECIPES,
    **clothing.RECIPES,
    **stationery.RECIPES,
    **decor.RECIPES,
    **oddments.RECIPES,
    **animals.RECIPES,
    **structure.RECIPES,
}
