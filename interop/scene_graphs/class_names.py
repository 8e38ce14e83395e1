"""The class of ours that a label of another project means."""

from __future__ import annotations

import re
from typing import NamedTuple

from hearth.interop.scene_graphs.shape import Shape
from hearth.kb.knowledge import Knowledge
from hearth.kb.language.adjectives import noun_of
from hearth.kb.spelling import key_of


class ClassOf(NamedTuple):
    """The class of a label.

    Attributes:
        name: the class; "" where there is none.
        by: how it was found: `name`, `other name`, `table`, `number left out` or `adjective left out`; `building` for
            parts of the building, which are left out; "" where it was not found.
    """

    name: str
    by: str


def class_of(label: str, shape: Shape, knowledge: Knowledge) -> ClassOf:
    """Return the class that a label means.

    The shape's table comes first, then the names of the knowledge; then both without a number at the label's end; then
    both without adjectives and rooms before the noun: a `wooden chair` is a chair, a `kitchen sink` is a sink.
    """
    label = _last_part(label)
    bare = _without_number(label)
    for text, how in ((label, ""), (bare, "number left out")):
        found = _named(text, how, shape, knowledge)
        if found.by:
            return found
    noun = noun_of(re.sub(r"[\s_-]+", " ", bare), knowledge)
    return _named(noun, "adjective left out", shape, knowledge) if noun else ClassOf("", "")


def _named(text: str, how: str, shape: Shape, knowledge: Knowledge) -> ClassOf:
    """Return the class that a text names in the shape's table or in the knowledge, found in the way `how`."""
    key = key_of(text)
    if key in shape.classes:
        named = shape.classes[key]
        meant = knowledge.object_class(named) if named else None
        return ClassOf(meant.name, how or "table") if meant is not None else ClassOf("", "building")
    known = knowledge.object_class(key) if key else None
    if known is None:
        return ClassOf("", "")
    return ClassOf(known.name, how or ("name" if key_of(known.name) == key else "other name"))


_NODE_SYMBOL = re.compile(r"(?:[A-Za-z]|room|region|zone|area|space)?[\s_.-]?\(?\d+\)?", re.IGNORECASE)
"""A label that only numbers an entry: `R0`, `R(3)`, `room_2`, `7`."""


def is_number_only(label: str) -> bool:
    """Return whether a label only numbers an entry, and says nothing of its class: `R0`, `room_2`, `7`."""
    return _NODE_SYMBOL.fullmatch(label.strip()) is not None


_NUMBER = re.compile(r"(?:[|#:/].*|[\s_.-]*\d+(?:_\d+)*|[_-][0-9a-f]{6,})$", re.IGNORECASE)
"""Text behind a label: `Fridge|+01.2|-0.1`, `chair_12`, `Cup_5f3a9c21`."""


def _last_part(label: str) -> str:
    """Return the last part of a path such as `objects/fridge.glb`, without the ending of a file."""
    return label.rstrip("/").rpartition("/")[2].partition(".")[0] if "/" in label else label


def _without_number(label: str) -> str:
    return _NUMBER.sub("", label.strip())
