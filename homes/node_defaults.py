"""Fields that a graph's file leaves out of its nodes, filled in from the knowledge of their classes.

People write nodes with an id, a class and perhaps states; Unity writes the prefab as the category of an object that was
added to a scene. A field that a file has is kept, an empty list of properties too.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.schemas.vocabulary import CHARACTER_CLASS

CATEGORIES = (
    "Animals", "Appliances", "BodyParts", "Ceiling", "Characters", "Clothes", "Decor", "Doors", "Electronics", "Floor",
    "Floors", "Food", "Furniture", "Lamps", "People", "Props", "Rooms", "Walls", "Windows", "placable_objects",
)  # fmt: skip
"""The categories that the release's graphs and ours know; of `Floor` and `Floors` both occur."""


class Filled(NamedTuple):
    """A graph as the release writes it, and the labels of the nodes that were filled in, `salmon (1000)`."""

    data: Mapping[str, Any]
    nodes: tuple[str, ...]


def filled(data: Mapping[str, Any], knowledge: Knowledge) -> Filled:
    """Return a graph whose nodes have the category, properties and states of their class where they say none.

    A category that graphs do not have, such as a prefab's name, counts as left out. What is not a mapping stays.
    """
    given = data.get("nodes")
    if not isinstance(given, list):
        return Filled(data, ())
    nodes = [_filled(node, knowledge) if isinstance(node, dict) else node for node in given]
    changed = [node for node, before in zip(nodes, given, strict=True) if node is not before]
    labels = tuple(f"{node.get('class_name')} ({node.get('id')})" for node in changed)
    return Filled({**data, "nodes": nodes} if changed else data, labels)


def _filled(node: Mapping[str, Any], knowledge: Knowledge) -> Mapping[str, Any]:
    name = node.get("class_name")
    known = knowledge.object_class(name) if isinstance(name, str) else None
    if known is None:
        return node
    own: dict[str, Any] = {}
    category = node.get("category")
    if not category or (isinstance(category, str) and category not in CATEGORIES):
        own["category"] = known.category
    if name != CHARACTER_CLASS:
        if node.get("properties") is None and known.properties:
            own["properties"] = sorted(known.properties)
        if node.get("states") is None and known.properties & {"CAN_OPEN", "HAS_SWITCH", "HAS_PLUG"}:
            own["states"] = list(knowledge.default_states(known.name))
    return {**node, **own} if own else node
