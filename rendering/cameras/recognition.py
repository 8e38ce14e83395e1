"""Recognition of persons and objects in a picture, by pixels: large enough, and less than half hidden."""

from typing import NamedTuple

import numpy as np

from hearth.rendering.rays.camera_shot import Shot
from hearth.rendering.rays.first_hits import Canvas
from hearth.schemas.vocabulary import CHARACTER_CLASS

PERSON, OBJECT = 0.015, 0.001
"""Least shares of the picture that a person and an object cover."""

HIDDEN = 0.5
"""Share of their pixels from which on others hide too much of them."""

CLOSE, FILLING = 0.7, 0.15
"""Metres nearer than which, and share of the picture from which on, something is in the camera's way."""


class Recognition(NamedTuple):
    """A node in a picture.

    Attributes:
        share: of the picture that it covers.
        unhidden: share of the pixels that it would cover alone; 0 where it would cover none.
    """

    share: float
    unhidden: float

    def suffices(self, least: float) -> bool:
        """Return whether it covers a share of the picture, and others hide less than half of it."""
        return self.share >= least and self.unhidden > HIDDEN


def recognition(shot: Shot, node: int) -> Recognition:
    """Return how well a picture shows a node, from its visible pixels and the pixels that it would cover alone."""
    things = shot.geometry.things
    numbers = [number for number, thing in enumerate(things) if thing.id == node]
    if not numbers:
        return Recognition(0.0, 0.0)
    seen = int(np.isin(shot.owner, numbers).sum())
    alone, first = Canvas(shot.camera, "alone"), len(shot.geometry.static.things)
    alone.draw(shot.geometry.static, np.array([number for number in numbers if number < first], np.int64))
    alone.draw(shot.geometry.moving, np.array([number - first for number in numbers if number >= first], np.int64))
    whole = int((alone.triangle >= 0).sum())
    return Recognition(seen / len(shot.owner), seen / whole if whole else 0.0)


def least_share(class_name: str) -> float:
    """Return the share of the picture that a thing of a class has to cover."""
    return PERSON if class_name == CHARACTER_CLASS else OBJECT


def shows(shot: Shot, person: int, objects: tuple[int, ...]) -> bool:
    """Return whether a person and all of some objects can be recognised."""
    found = recognition(shot, person).suffices(PERSON)
    others = (node for node in objects if node != person)
    names = {thing.id: thing.class_name for thing in shot.geometry.things} if found else {}
    return found and all(recognition(shot, node).suffices(least_share(names.get(node, ""))) for node in others)


def in_the_way(shot: Shot) -> bool:
    """Return whether one thing nearer than `CLOSE` fills a share of `FILLING` of the picture."""
    near = shot.owner[(shot.distance < CLOSE) & (shot.owner >= 0)]
    return len(near) > 0 and int(np.bincount(near).max()) >= FILLING * len(shot.owner)
