"""The shapes of things as a floor plan needs them: sizes, where they are mounted, where things stand on and in them."""

import csv
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib.resources import files

from hearth.kb.knowledge import Knowledge


@dataclass(frozen=True, slots=True)
class Form:
    """A class's shape.

    Attributes:
        size: width (along its back), height and depth in metres.
        mount: `floor`; `flat` (a rug: others stand over it); `wall`; `ceiling`; `window`; `sunk` (into its support);
            `door`; or `item` (stands on or in something).
        up: the height of the underside of a thing that hangs on a wall.
        levels: heights above its underside at which things stand ON it; empty: on its top.
        shelves: at how many heights things stand INSIDE it.
        front: free depth that using it takes, in metres.
    """

    size: tuple[float, float, float]
    mount: str = "item"
    up: float = 0.0
    levels: tuple[float, ...] = ()
    shelves: int = 1
    front: float = 0.0


@lru_cache(maxsize=4096)
def form(class_name: str, knowledge: Knowledge) -> Form | None:
    """Return the shape of a class, in the knowledge's size unless at home it lies otherwise.

    None for an unknown class.
    """
    known = knowledge.objects.get(class_name)
    if known is None:
        return None
    table = _table()
    found = table.get(class_name) or table.get(known.same_as or "") or Form((0.0, 0.0, 0.0))
    return found if all(found.size) else replace(found, size=known.size)


@lru_cache(maxsize=4096)
def scaled(class_name: str, size: tuple[float | None, ...], knowledge: Knowledge) -> Form | None:
    """Return a class's shape where a plan gives a size of its own; None in it, or 0, stands for the usual extent."""
    known = form(class_name, knowledge)
    if known is None:
        return None
    width, height, depth = (own or usual for own, usual in zip(size, known.size, strict=True))
    # A shelf in a bookcase twice as high hangs twice as high.
    scale = height / known.size[1]
    levels = tuple(round(level * scale, 4) for level in known.levels)
    return replace(known, size=(width, height, depth), levels=levels)


@lru_cache(maxsize=1)
def _table() -> dict[str, Form]:
    text = (files("hearth.data_raw") / "forms.csv").read_text(encoding="utf-8")
    return {row["class"]: _form(row) for row in csv.DictReader(text.splitlines())}


def _form(row: dict[str, str]) -> Form:
    width, height, depth = map(float, row["size"].split()) if row["size"] else (0.0, 0.0, 0.0)
    return Form(
        size=(width, height, depth),
        mount=row["mount"] or "item",
        up=float(row["up"] or 0),
        levels=tuple(map(float, row["levels"].split())),
        shelves=int(row["shelves"] or 1),
        front=float(row["front"] or 0),
    )
