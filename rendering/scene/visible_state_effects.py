"""Effects: what is seen of things that are in a state, such as light, changing pictures, trembling and steam."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import cos, pi, radians, sin
from typing import Any

from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.scene.instances import Thing
from hearth.schemas.graph import Box, Point
from hearth.schemas.rng import derive
from hearth.schemas.yaml_limits import packaged

TREMBLES = 9.0
"""Times a second that a trembling thing moves to and fro."""

STEAM = "steam"
"""The recipe of steam."""

RISES, FORMS = 0.25, 8
"""Seconds for which steam has one form, and the number of its forms."""


@dataclass(frozen=True, slots=True)
class Shine:
    """A light that a thing gives.

    Attributes:
        strength: 1 lights white paper fully at a metre.
        color: `#rrggbb`; empty for that of lamps.
        up: its height as a share of the thing's box; None takes the model's lamp.
        out: metres in front of the box.
    """

    strength: float
    color: str = ""
    up: float | None = None
    out: float = 0.0


@dataclass(frozen=True, slots=True)
class Effect:
    """The visible effect of a thing's state; the fields of `visible_state_effects.yaml`."""

    light: Shine | None = None
    moments: int = 1
    every: float = 1.0
    shake: float = 0.0
    steam: float = 0.0

    @property
    def moves(self) -> bool:
        """Return whether it changes with time."""
        return self.moments > 1 or self.shake > 0 or self.steam > 0


def _effect(fields: dict[str, Any]) -> Effect:
    light = fields.get("light")
    return Effect(**(fields | {"light": Shine(**light)} if light else fields))


EFFECTS: Mapping[str, Mapping[str, Effect]] = {
    recipe: {state: _effect(fields) for state, fields in states.items()}
    for recipe, states in packaged("hearth.rendering.scene", "visible_state_effects.yaml").items()
}
"""Recipe -> state -> effect. To add one: a row of `visible_state_effects.yaml`."""


def effects_of(recipe: str, states: frozenset[str]) -> Iterator[Effect]:
    """Yield the effects of a recipe in some states."""
    for state, effect in EFFECTS.get(recipe, {}).items():
        if state in states:
            yield effect


def changes(thing: Thing) -> bool:
    """Return whether a thing looks different from moment to moment."""
    if not isinstance(thing.model, Model):
        return False
    return thing.model.recipe == STEAM or any(
        effect.moves for effect in effects_of(thing.model.recipe, thing.model.look.states)
    )


def at_time(thing: Thing, time: float) -> Iterator[Thing]:
    """Yield a thing as it looks some seconds after a film's start, then the steam above it.

    A node's first part is itself.
    """
    model, moved, above = thing.model, thing, list[Thing]()
    for effect in effects_of(model.recipe, model.look.states) if isinstance(model, Model) else ():
        assert isinstance(model, Model)
        start = derive(0, "effect", thing.id) % 97
        if effect.moments > 1:
            moment = (int(time / effect.every + 1e-6) + start) % effect.moments
            moved = replace(moved, model=replace(model, look=replace(model.look, moment=moment)))
        if effect.shake:
            way = effect.shake * sin(2 * pi * TREMBLES * time + start)
            x, y, z = moved.position
            moved = replace(moved, position=(x + way * cos(radians(thing.yaw)), y, z - way * sin(radians(thing.yaw))))
        if effect.steam:
            above.append(_steam(thing, model.look, effect.steam, int(time / RISES + 1e-6) + start))
    yield moved
    yield from above


def _steam(thing: Thing, look: Look, height: float, moment: int) -> Thing:
    x, y, z = thing.position
    wide = min(look.size[0], look.size[2]) * 0.5
    model = Model(STEAM, Look((wide, height, wide), moment=moment % FORMS))
    return replace(thing, model=model, position=(x, y + look.size[1] * 0.96, z), tilt=(0.0, 0.0, 0.0))


def shining(recipe: str, states: frozenset[str], lamp: float | None) -> Iterator[tuple[Shine, float]]:
    """Yield the lights of a recipe in some states, each with its height as a share of the box.

    `lamp` is the model's.
    """
    for effect in effects_of(recipe, states):
        up = lamp if effect.light is None or effect.light.up is None else effect.light.up
        if effect.light is not None and up is not None:
            yield effect.light, up


def light_point(shine: Shine, up: float, box: Box, yaw: float) -> Point:
    """Return where a light is in the world."""
    (x, y, z), (w, h, d) = box.center, box.size
    c, s = cos(radians(yaw)), sin(radians(yaw))
    deep = (abs(s) * w + abs(c) * d) / 2 + shine.out if shine.out else 0.0
    return x + s * deep, y + (up - 0.5) * h, z + c * deep
