"""Scenes of iGibson, written as URDF in JSON: links say what things are, joints where; both are joined here."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from hearth.kb.spelling import key_of

WORLD = "world"
"""The link that everything hangs on."""


def joined(data: Any) -> Any:
    """Return a URDF as a list of objects with their poses; any other value as it is.

    Names of attributes may begin with `@`, as converters of XML write them. Vectors may be texts: `1.0 2.0 0.5`. A
    thing on a link that is not the world, such as a door of a cabinet, is part of another thing and stays out.
    """
    robot = _plain(_plain(data).get("robot", data))
    links, joints = (robot.get(name) for name in ("link", "joint"))
    if not isinstance(links, list) or not isinstance(joints, list):
        return data
    placed: dict[str, Mapping[str, Any]] = {}
    for joint in map(_plain, joints):
        parent, child = (str(_plain(joint.get(end)).get("link", "")) for end in ("parent", "child"))
        if parent == WORLD:
            placed[child] = _plain(joint.get("origin"))
    return with_rooms(
        [_object(each, placed[str(each.get("name"))]) for each in map(_plain, links) if str(each.get("name")) in placed]
    )


def with_rooms(things: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return things whose `rooms` are names as a scene with these rooms; a door of two rooms is between them."""
    names = dict.fromkeys(str(room) for thing in things for room in thing.get("rooms", ()) if room)
    objects = []
    for thing in things:
        own = [str(room) for room in thing.pop("rooms", ()) if room]
        place: dict[str, Any] = {"between": own[:2]} if len(own) > 1 and "door" in str(thing.get("label")) else {}
        objects.append({**thing, **(place or ({"room": own[0]} if own else {}))})
    return {"rooms": [{"id": name, "label": name} for name in names], "objects": objects}


def _object(link: Mapping[str, Any], origin: Mapping[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = {"id": link.get("name"), "label": link.get("category", link.get("name"))}
    room = link.get("rooms", link.get("room", link.get("inrooms")))
    found["rooms"] = room.split(",") if isinstance(room, str) else room if isinstance(room, list) else []
    size, xyz, rpy = (_vector(value) for value in (link.get("boundingbox"), origin.get("xyz"), origin.get("rpy")))
    return found | ({"size": size} if size else {}) | {"pose": {"position": xyz, "orientation": rpy}}


def _vector(value: Any) -> Any:
    """Return the numbers of a text; any other value as it is."""
    if not isinstance(value, str):
        return value
    try:
        return [float(word) for word in value.split()]
    except ValueError:
        return value


def _plain(value: Any) -> Mapping[str, Any]:
    """Return a mapping by plain keys: without `@`, case, hyphens and underscores."""
    return {key_of(str(key).lstrip("@")): each for key, each in value.items()} if isinstance(value, Mapping) else {}
