"""The JSON schema of scene graphs, made from the vocabulary."""

from __future__ import annotations

from typing import Any

from hearth.schemas.vocabulary import PROPERTIES, RELATIONS, STATES


def graph_schema() -> dict[str, Any]:
    """Return the JSON schema of a scene graph in the release's layout.

    Examples:
        >>> from hearth.schemas.graph_json_schema import graph_schema
        >>> graph_schema()["required"]
        ['nodes', 'edges']
    """
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Scene graph of a home",
        "description": "Rooms, things and characters of a home and their relations, in the release's layout.",
        "type": "object",
        "required": ["nodes", "edges"],
        "properties": {"nodes": _list_of(_NODE), "edges": _list_of(_EDGE)},
        "$defs": {"vector": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}},
    }


def _list_of(item: dict[str, Any]) -> dict[str, Any]:
    return {"type": "array", "items": item}


def _words(words: tuple[str, ...], about: str) -> dict[str, Any]:
    return {"type": ["array", "null"], "items": {"enum": list(words)}, "description": about}


_VECTOR = {"$ref": "#/$defs/vector"}

_NODE: dict[str, Any] = {
    "type": "object",
    "required": ["id", "class_name"],
    "properties": {
        "id": {"type": "integer", "description": "unique in the graph"},
        "class_name": {"type": "string", "description": "a class of the knowledge, or another name of one"},
        "category": {"type": ["string", "null"], "description": "that of the class where it is left out"},
        "properties": _words(PROPERTIES, "those of the class where they are left out"),
        "states": _words(STATES, "the usual ones of the class where they are left out"),
        "prefab_name": {"type": ["string", "null"]},
        "bounding_box": {
            "type": ["object", "null"],
            "required": ["center", "size"],
            "properties": {
                "center": {**_VECTOR, "description": "metres, y upwards"},
                "size": {**_VECTOR, "description": "metres"},
            },
        },
        "yaw": {"type": ["number", "null"], "description": "degrees about y from +z, clockwise as seen from above"},
    },
}

_EDGE: dict[str, Any] = {
    "type": "object",
    "required": ["from_id", "relation_type", "to_id"],
    "properties": {
        "from_id": {"type": "integer"},
        "relation_type": {"enum": list(RELATIONS)},
        "to_id": {"type": "integer"},
    },
}
