"""Scenes: an environment graph with boxes, made of triangles that rays can hit."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.lights import Daylight, Light, daylight
from hearth.rendering.scene.triangles import NOTHING, Geometry, Part, Still


@dataclass(frozen=True, eq=False)
class Scene:
    """What a picture is taken of. Immutable; geometry is built when it is first needed.

    Attributes:
        things: what has a shape and is not among `still`.
        lights: lamps that are on, and windows by day.
        day: sun and sky.
        still: further things, whose geometry is shared with other scenes that have the same ones.
    """

    things: tuple[Thing, ...]
    lights: tuple[Light, ...] = ()
    day: Daylight = field(default_factory=daylight)
    still: Still = NOTHING

    @property
    def everything(self) -> tuple[Thing, ...]:
        """All things with a shape."""
        return self.still.things + self.things

    @cached_property
    def geometry(self) -> Geometry:
        """Everything."""
        return Geometry(self.still.whole, Part.of(self.things))

    @cached_property
    def opened(self) -> Geometry:
        """Everything but ceilings and what hangs there: for views from above."""
        moving = tuple(thing for thing in self.things if not thing.above)
        return Geometry(self.still.opened, Part.of(moving) if len(moving) < len(self.things) else self.geometry.moving)

    @cached_property
    def _by_id(self) -> dict[int, Thing]:
        found: dict[int, Thing] = {}
        for thing in self.everything:
            found.setdefault(thing.id, thing)
        return found

    def find(self, node_id: int) -> Thing | None:
        """The thing of that id; the first, if it is drawn as several."""
        return self._by_id.get(node_id)
