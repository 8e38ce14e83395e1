"""Every model by name. To add one, write an entry in the file of its family, and its classes in `looks.yaml`."""

import re
from collections.abc import Iterator, Mapping
from functools import cache

from hearth.rendering.models.appearance import Look, Recipe, Region, Regions, nowhere, top
from hearth.rendering.models.model_expressions import Expression, Node, Scope, Values, entries_of, shared_of, text_of
from hearth.rendering.models.model_interpreter import Draw, Interpreter
from hearth.rendering.models.primitives import FUNCTIONS, KNOWN, names_of

PACKAGE = "hearth.rendering.models"
FAMILIES = (
    "seats.yaml", "tables_and_counters.yaml", "storage.yaml", "appliances.yaml", "electronics.yaml", "lighting.yaml",
    "bath.yaml", "toiletries.yaml", "tableware.yaml", "kitchen_tools.yaml", "food.yaml", "cleaning.yaml",
    "clothing.yaml", "stationery.yaml", "decor.yaml", "oddments.yaml", "playthings.yaml", "animals.yaml",
    "structure.yaml", "joinery.yaml",
)  # fmt: skip
"""Names of the model files."""
FACTS = ("size", "variants", "kinds", "states", "lamp", "on", "inside")
"""Keys of an entry that describe the model as a whole: fields of `Recipe`."""
ENTRY = re.compile(r"^(\w+)(\(.*\))?:", re.MULTILINE)
"""The first line of an entry: a model, or a shape with its parameters."""


class Catalog(Mapping[str, Recipe]):
    """The models, each read and compiled at its first use."""

    def __getitem__(self, name: str) -> Recipe:
        """Return the model's recipe."""
        return _recipe(name)

    def __iter__(self) -> Iterator[str]:
        return (name for name, (_, takes) in _index().items() if not takes)

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, name: object) -> bool:
        return _index().get(str(name), ("", "()"))[1] == ""


RECIPES: Mapping[str, Recipe] = Catalog()


@cache
def _index() -> dict[str, tuple[str, str]]:
    """Entry -> its family and its parameters. Entries begin at the margin, so finding them needs no parser."""
    found = ((family, *entry) for family in FAMILIES for entry in ENTRY.findall(text_of(PACKAGE, family)))
    return {name: (family, takes) for family, name, takes in found if name != "shared"}


def _scope(family: str, name: str, known: frozenset[str]) -> Scope:
    return Scope(f"rendering/models/{family}", name, known)


@cache
def _shared(family: str) -> Values:
    return shared_of(PACKAGE, family, FUNCTIONS)


@cache
def _drawn(name: str) -> Draw | None:
    """Return the shape of that name; None if no entry defines it."""
    family, takes = _index().get(name, ("", ""))
    if not family:
        return None
    entry = {key: node for key, node in entries_of(PACKAGE, family)[name + takes].items() if key not in FACTS}
    scope = _scope(family, name, KNOWN).knowing(_shared(family))
    return INTERPRETER.definition(entry, takes.strip("()"), _shared(family), scope)


INTERPRETER = Interpreter(_drawn)


@cache
def _recipe(name: str) -> Recipe:
    draw = _drawn(name)
    if not draw:
        raise KeyError(name)
    family = _index()[name][0]
    entry = entries_of(PACKAGE, family)[name]
    scope = _scope(family, name, KNOWN).knowing(_shared(family))
    return Recipe(
        draw=lambda look: draw(names_of(look), (), {}),
        size=scope.at("size").expression(entry["size"])(dict(FUNCTIONS)),
        variants=int(entry.get("variants", 1)),
        on=_regions("on", entry, scope) if "on" in entry else top,
        inside=_regions("inside", entry, scope) if "inside" in entry else nowhere,
        kinds=tuple(entry.get("kinds", ())),
        lamp=float(entry["lamp"]) if "lamp" in entry else None,
        states=tuple(entry.get("states", ())),
    )


def _regions(key: str, entry: dict[str, Node], scope: Scope) -> Regions:
    """Return the regions under `key` of an entry; their expressions may use the names of its `let`."""
    named, inside = INTERPRETER.named(entry.get("let", {}), scope)
    regions = inside.at(key).expression(entry[key])
    needed, needs = [], regions.needs
    for name, value in reversed(named):
        if name in needs and isinstance(value, Expression):
            needed.append((name, value))
            needs |= value.needs
    shared = _shared(scope.file.split("/")[-1])

    def found(look: Look) -> tuple[Region, ...]:
        names = {**names_of(look), **shared}
        for name, value in reversed(needed):
            names[name] = value(names)
        return tuple(regions(names))

    return found
