"""The recipe of a class and its parameters: by `looks.yaml`, else by hypernyms, else a plain box."""

from dataclasses import dataclass, replace
from functools import cache, lru_cache
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.rendering.models.appearance import Look, Recipe, Size
from hearth.rendering.models.mesh import Mesh
from hearth.rendering.models.model_recipes import RECIPES
from hearth.rendering.models.textures import SLOTS
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import derive
from hearth.schemas.yaml_limits import packaged

FALLBACK = "crate"
"""The recipe of classes without an entry."""


@dataclass(frozen=True, slots=True)
class Choice:
    """The look of a class: the recipe's name and its fixed parameters."""

    recipe: str
    color: str = ""
    kind: str = ""
    variant: int | None = None


@dataclass(frozen=True, slots=True)
class Model:
    """A recipe and a look; equal models have equal meshes."""

    recipe: str
    look: Look


@cache
def looks() -> dict[str, Choice]:
    """Class or hypernym -> choice, from `looks.yaml`.

    Raises:
        HearthError: an entry names a recipe that does not exist.
    """
    table: dict[str, Any] = packaged("hearth.rendering.models", "looks.yaml")
    chosen = {
        name: Choice(**(entry if isinstance(entry, dict) else {"recipe": entry})) for name, entry in table.items()
    }
    wrong = [f"{name}: {choice.recipe}" for name, choice in chosen.items() if choice.recipe not in RECIPES]
    if wrong:
        raise HearthError.of(Code.BAD_TABLE, f"no such recipe: {', '.join(wrong)}", file="rendering/models/looks.yaml")
    return chosen


def choice_of(class_name: str, knowledge: Knowledge) -> Choice:
    """Return how a class is drawn: by its own entry, its synonym's, or its nearest hypernym's."""
    found = knowledge.objects.get(class_name)
    names = (class_name, found.same_as if found else "", *knowledge.ancestors(class_name))
    return next((looks()[name] for name in names if name in looks()), Choice(FALLBACK))


def recipe_of(class_name: str, knowledge: Knowledge) -> Recipe:
    """Return the recipe that draws a class."""
    return RECIPES[choice_of(class_name, knowledge).recipe]


def model_of(
    class_name: str, size: Size, states: frozenset[str], seed: int, knowledge: Knowledge, **more: Any
) -> Model:
    """Return the model of one object.

    Args:
        class_name: any, known or unknown.
        size: width, height, depth of its box when it faces +z, metres.
        states: its states.
        seed: of the object; decides variant and colours.
        knowledge: for hypernyms.
        more: further fields of `Look`.
    """
    choice = choice_of(class_name, knowledge)
    recipe = RECIPES[choice.recipe]
    variant = derive(seed, "variant") % recipe.variants if choice.variant is None else choice.variant
    visible = states & {"OPEN", "ON", "DIRTY", "PLUGGED_OUT"}
    look = Look(_rounded(size), variant, seed, visible, choice.color, choice.kind)
    return Model(choice.recipe, replace(look, **more))


def _rounded(size: Size) -> Size:
    x, y, z = (max(round(float(value), 4), 0.002) for value in size)
    return x, y, z


@lru_cache(maxsize=4096)
def draw(model: Model) -> Mesh:
    """Return the mesh of a model, which stands on y = 0 and faces +z."""
    mesh = RECIPES[model.recipe].draw(model.look)
    return _soiled(mesh) if "DIRTY" in model.look.states else mesh


def _soiled(mesh: Mesh) -> Mesh:
    """Return the mesh with stains on all untextured triangles."""
    bare = mesh.textures == SLOTS["plain"]
    textures, uvs, surface = mesh.textures.copy(), mesh.uvs.copy(), mesh.surface.copy()
    textures[bare] = SLOTS["grime"]
    extent = float(max(*(mesh.bounds()[1] - mesh.bounds()[0]), 0.05))
    uvs[bare] *= 1.2 / extent
    surface[~bare, :3] *= 0.75
    surface[:, 4] *= 0.3
    return replace(mesh, textures=textures, uvs=uvs, surface=surface)
