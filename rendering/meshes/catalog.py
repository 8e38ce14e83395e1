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
    kitchen_tools,
    lighting,
    oddments,
    playthings,
    seats,
    stationery,
    storage,
    structure,
    tables,
    tableware,
    toiletries,
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
    **toiletries.RECIPES,
    **tableware.RECIPES,
    **kitchen_tools.RECIPES,
    **food.RECIPES,
    **cleaning.RECIPES,
    **clothing.RECIPES,
    **stationery.RECIPES,
    **decor.RECIPES,
    **oddments.RECIPES,
    **playthings.RECIPES,
    **animals.RECIPES,
    **structure.RECIPES,
}
