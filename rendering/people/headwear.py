"""Things that are worn on the head: hats, spectacles, headsets. Other garments are the body's own clothes."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import asin, atan2, degrees
from typing import Any, NamedTuple

import numpy as np

from hearth.rendering.models.mesh import rotation
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.scene.instances import Thing, tilted
from hearth.rendering.scene.object_boxes import Places
from hearth.rendering.scene.scene_preparation import PreparedScene
from hearth.schemas.graph import Node, Point
from hearth.schemas.yaml_limits import packaged


class Worn(NamedTuple):
    """The way in which a thing is worn on the head.

    Attributes:
        at: from the head's joint, in the head's own directions, shares of the person's height.
        size: as it is worn, metres; None for its own.
        pitch: degrees by which its top is tilted backwards.
    """

    at: Point
    size: Point | None = None
    pitch: float = 0.0


def _read(fields: Mapping[str, Any]) -> Worn:
    values: dict[str, Any] = {key: tuple(each) if isinstance(each, list) else each for key, each in fields.items()}
    return Worn(**values)


WORN: Mapping[str, Worn] = {
    name: _read(fields) for name, fields in packaged("hearth.rendering.people", "headwear.yaml").items()
}
"""By class; other garments are not drawn as things."""


def on_head(prepared: PreparedScene, places: Places, actor: Actor, node: Node) -> Iterator[Thing]:
    """Yield the drawn things of a node that is worn on the head, which they turn and nod with; none of other nodes."""
    worn = WORN.get(node.class_name)
    if worn is None:
        return
    joints = actor.figure().joints()
    ahead = joints["face"] - joints["head"]
    x, y, z = ahead / np.linalg.norm(ahead)
    turn, nod = degrees(atan2(x, z)), degrees(asin(y))
    turned = rotation("y", turn)
    middle = joints["head"] + turned @ tilted((nod, 0.0, 0.0)) @ (np.array(worn.at) * actor.body.height)
    tilt = (nod + worn.pitch, 0.0, 0.0)
    for thing in prepared.at_origin(node, worn.size or places.size_of(node)):
        px, py, pz = (middle + turned @ tilted(tilt) @ np.array(thing.position)).tolist()
        yield replace(thing, position=actor.world((px, py, pz)), yaw=actor.yaw + turn, tilt=tilt)
