"""Scenes of OmniGibson: what an object is stands apart from where it is; both are joined here."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from hearth.interop.scene_graphs.urdf_scenes import with_rooms


def joined(data: Any) -> Any:
    """Return a scene of OmniGibson as a list of objects with their poses; any other value as it is.

    `objects_info` has the class and the rooms of each object by its name, `state.object_registry` its place.
    """
    info = _mapping(_mapping(data).get("objects_info")).get("init_info")
    state = _mapping(data).get("state")
    registry = _mapping(state).get("object_registry") or _mapping(_mapping(state).get("registry")).get(
        "object_registry"
    )
    if not isinstance(info, Mapping) or not isinstance(registry, Mapping):
        return data
    return with_rooms([_object(str(name), _mapping(each), _mapping(registry.get(name))) for name, each in info.items()])


def _object(name: str, info: Mapping[str, Any], state: Mapping[str, Any]) -> dict[str, Any]:
    given, root = _mapping(info.get("args")), _mapping(state.get("root_link"))
    found: dict[str, Any] = {"id": name, "label": given.get("category", name)}
    rooms = given.get("in_rooms")
    found["rooms"] = rooms if isinstance(rooms, list) else rooms.split(",") if isinstance(rooms, str) else []
    if root.get("pos") is not None:
        found["pose"] = {"position": root["pos"], "orientation": root.get("ori")}
    for key in ("bounding_box", "bbox_extent"):
        if isinstance(given.get(key), list):
            found["size"] = given[key]
    states = _mapping(state.get("non_kin"))
    for key, flag in (("Open", "isOpen"), ("ToggledOn", "isToggled")):
        value = _mapping(states.get(key)).get("value", states.get(key))
        if isinstance(value, bool):
            found[flag] = value
    return found


def _mapping(value: Any) -> Mapping[str, Any]:
    return value if isinstance(value, Mapping) else {}
