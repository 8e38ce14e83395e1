"""Targets for hands on the person's own body, to put on a garment or to wash."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import Hand
from hearth.rendering.people.palm_targets import OTHER, SIDES, Aim
from hearth.schemas.graph import Point
from hearth.schemas.yaml_limits import packaged

CHEST = "chest"
"""The place of garments that are not listed."""


class At(NamedTuple):
    """Position of a palm relative to a joint, metres, and its direction; of the right hand."""

    palm: Point
    facing: Point

    def aim(self, joint: Point, sign: float, grip: str) -> Aim:
        """Of the hand of a side: 1 the right, -1 the left."""
        (x, y, z), (px, py, pz) = self.palm, self.facing
        at = (joint[0] + sign * x, joint[1] + y, joint[2] + z)
        return Aim(at, Hand(grip, (sign * px, py, pz)))


class BodyPlace(NamedTuple):
    """A place on the body.

    Attributes:
        joint: from which it is measured.
        acting, other: where the acting hand and the other one are, as if the right one acted.
    """

    joint: str
    acting: At
    other: At

    @classmethod
    def of(cls, joint: str, at: Point, palm: Point, other: Mapping[str, Point] | None = None) -> BodyPlace:
        """As `own_body_targets.yaml` has it; the other hand mirrors the acting one unless it is said where it is."""
        mirrored = At((-at[0], at[1], at[2]), (-palm[0], palm[1], palm[2]))
        return cls(joint, At(at, palm), At(other["at"], other["palm"]) if other else mirrored)


_DATA = packaged("hearth.rendering.people", "own_body_targets.yaml")

PLACES: Mapping[str, BodyPlace] = {name: BodyPlace.of(**fields) for name, fields in _DATA["places"].items()}
"""By name."""

PLACE_OF: Mapping[str, str] = _DATA["classes"]
"""The places of parts of the body, and of garments that are not worn on the chest."""


def at_body(actor: Actor, class_name: str, acting: str, busy: Mapping[str, int], grip: str = "flat") -> dict[str, Aim]:
    """Return the aims of hands at the place on the body of a garment or a part of the body.

    Args:
        actor: with hands in default pose.
        class_name: of the garment or part.
        acting: the side of the acting hand.
        busy: what each side's hand holds; the other hand takes part only if it is free.
        grip: of the acting hand and the other one.
    """
    place = PLACES[PLACE_OF.get(class_name, CHEST)]
    x, y, z = np.asarray(actor.figure().joints()[place.joint]).tolist()
    sign = SIDES[acting]
    joint = (sign * x, y, z)
    found = {acting: place.acting.aim(joint, sign, grip)}
    if OTHER[acting] not in busy:
        found[OTHER[acting]] = place.other.aim(joint, sign, grip)
    return found
