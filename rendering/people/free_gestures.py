"""Gestures without a thing: places of the palms, a stoop, feet, and motions of the whole body."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import pi, sin
from typing import Any, NamedTuple

from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import BodyPose, Foot, Hand
from hearth.rendering.people.palm_targets import Aim
from hearth.schemas.graph import Point
from hearth.schemas.yaml_limits import packaged


class FreeGesture(NamedTuple):
    """A gesture without a thing.

    Attributes:
        palms: by side, in heights of the body, with the form of the hand.
        stoop: 0 to 1; None is the least with which the hands reach.
        gaze: where it looks, in heights of the body; None looks ahead.
        feet: the right and the left foot; None has them side by side.
    """

    palms: Mapping[str, tuple[Point, str]]
    stoop: float | None
    gaze: Point | None
    feet: tuple[Foot, Foot] | None


def _read(row: Mapping[str, Any]) -> FreeGesture:
    palms = {
        side: ((row[side][0], row[side][1], row[side][2]), row[side][3]) for side in ("right", "left") if side in row
    }
    feet = (Foot(*row["feet"][0]), Foot(*row["feet"][1])) if "feet" in row else None
    gaze = (row["gaze"][0], row["gaze"][1], row["gaze"][2]) if "gaze" in row else None
    return FreeGesture(palms, row.get("stoop"), gaze, feet)


FREE: dict[str, FreeGesture] = {
    name: _read(row) for name, row in packaged("hearth.rendering.people", "free_gestures.yaml").items()
}
"""The gestures by name."""


def free_aims(name: str, actor: Actor, carried: Mapping[str, Aim]) -> dict[str, Aim]:
    """Return the aims of the hands; one that carries a thing holds it as before."""
    h = actor.body.height
    return {
        side: Aim((x * h, y * h, z * h), carried[side].hand if side in carried else Hand(grip))
        for side, ((x, y, z), grip) in FREE[name].palms.items()
    }


def freely(pose: BodyPose, name: str, height: float) -> BodyPose:
    """Return a pose with the stoop, the feet and the gaze of a gesture; a person that sits keeps its own."""
    found = FREE[name]
    gaze = pose.gaze if found.gaze is None else _times(found.gaze, height)
    if pose.posture != "standing":
        return replace(pose, gaze=gaze)
    return replace(pose, gaze=gaze, effort=found.stoop, feet=found.feet)


def _times(point: Point, height: float) -> Point:
    return point[0] * height, point[1] * height, point[2] * height


HOP, TURNED = 0.38, 16.0
"""Metres of a jump, and degrees by which a dancer turns."""


def whole_body(actor: Actor, motion: str, time: float, soft: float) -> Actor:
    """Return a person that jumps, or turns to and fro."""
    if motion == "hop":
        return replace(actor, level=actor.level + HOP * max(0.0, sin(2 * pi * 0.9 * time)) * soft)
    if motion == "sway":
        return replace(actor, yaw=actor.yaw + TURNED * soft * sin(2 * pi * 0.7 * time))
    return actor
