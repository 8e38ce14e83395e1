"""Scenes: an environment graph with boxes, made of triangles that rays can hit."""

from dataclasses import dataclass, field
from functools import cached_property

from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.lights import Daylight, Light, daylight
from hearth.rendering.scene.triangles import NOTHING, Geometry, Part, StaticThings


@dataclass(frozen=True, eq=False)
class Scene:
    """Things, lights and daylight of one picture. Immutable; geometry is built at its first use.

    Attributes:
        things: the moving things.
        lights: lamps that are on, and windows by day.
        day: sun and sky.
        static: further things, whose geometry is shared with other scenes.
    """

    things: tuple[Thing, ...]
    lights: tuple[Light, ...] = ()
    day: Daylight = field(default_factory=daylight)
    static: StaticThings = NOTHING

    @property
    def everything(self) -> tuple[Thing, ...]:
        """Static and moving things."""
        return self.static.things + self.things

    @cached_property
    def geometry(self) -> Geometry:
        """Everything."""
        return Geometry(self.static.whole, Part.of(self.things))

    @cached_property
    def opened(self) -> Geometry:
        """Geometry without ceilings and hanging things, for views from above."""
        moving = tuple(thing for thing in self.things if not thing.above)
        return Geometry(self.static.opened, Part.of(moving) if len(moving) < len(self.things) else self.geometry.moving)

    @cached_property
    def _by_id(self) -> dict[int, Thing]:
        found: dict[int, Thing] = {}
        for thing in self.everything:
            found.setdefault(thing.id, thing)
        return found

    def find(self, node_id: int) -> Thing | None:
        """Return the thing of a node; the first if the node is drawn as several."""
        return self._by_id.get(node_id)
