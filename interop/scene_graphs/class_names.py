"""The class of ours that a label of another project means."""

from __future__ import annotations

import re
from typing import NamedTuple

from hearth.interop.scene_graphs.shape import Shape
from hearth.kb.knowledge import Knowledge
from hearth.kb.spelling import key_of


class ClassOf(NamedTuple):
    """The class of a label.

    Attributes:
        name: the class; "" where there is none.
        by: how it was found: `name`, `other name`, `table` or `number left out`; `building` for parts of the building,
            which are left out; "" where it was not found.
    """

    name: str
    by: str


def class_of(label: str, shape: Shape, knowledge: Knowledge) -> ClassOf:
    """Return the class that a label means.

    The shape's table comes first, then the names of the knowledge; then both without a number at the label's end.
    """
    for text, how in ((label, ""), (_without_number(label), "number left out")):
        key = key_of(text)
        if key in shape.classes:
            named = shape.classes[key]
            meant = knowledge.object_class(named) if named else None
            return ClassOf(meant.name, "table") if meant is not None else ClassOf("", "building")
        known = knowledge.object_class(key) if key else None
        if known is not None:
            return ClassOf(known.name, how or ("name" if key_of(known.name) == key else "other name"))
    return ClassOf("", "")


_NUMBER = re.compile(r"(?:[|#:/].*|[\s_.-]*\d+(?:_\d+)*|[_-][0-9a-f]{6,})$", re.IGNORECASE)
"""Text behind a label: `Fridge|+01.2|-0.1`, `chair_12`, `Cup_5f3a9c21`."""


def _without_number(label: str) -> str:
    return _NUMBER.sub("", label.strip())
