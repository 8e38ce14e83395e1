"""Appearance parameters of an object, and recipes that draw it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

from hearth.rendering.models.mesh import Mesh
from hearth.rendering.models.paint import Paint
from hearth.schemas.rng import derive

Choice = TypeVar("Choice")
Size = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Look:
    """The appearance parameters of one object.

    Attributes:
        size: width (x), height (y), depth (z) of its box, metres.
        variant: number of the recipe's design.
        seed: decides colours and other details.
        states: names of `vocabulary.STATES`.
        color: overrides the main colour.
        kind: the variety of a class (`apple`, `lemon`), one of `Recipe.kinds`.
        level: height of its supporting surface (a seat, a mattress), metres; 0 for the recipe's own.
        hole: (x0, x1, z0, z1) cut out of its top for a basin, in its own frame.
        ajar: opening share of its doors and drawers when it is OPEN, from 0 to 1.
        moment: number of the way in which it looks now, if it changes with time (`scene/visible_state_effects.yaml`).
    """

    size: Size
    variant: int = 0
    seed: int = 0
    states: frozenset[str] = frozenset()
    color: str = ""
    kind: str = ""
    level: float = 0.0
    hole: tuple[float, float, float, float] | None = None
    ajar: float = 1.0
    moment: int = 0

    def seat(self, usual: float, share: float) -> float:
        """Height of the supporting surface: `level`, else `usual` metres, at most `share` of the height."""
        return min(self.level or usual, self.size[1] * share)

    @property
    def open(self) -> float:
        """Its opening share: 0 unless it is OPEN."""
        return self.ajar if "OPEN" in self.states else 0.0

    @property
    def on(self) -> bool:
        """Return whether it is ON."""
        return "ON" in self.states

    def pick(self, options: Sequence[Choice], use: str) -> Choice:
        """One of the options, always the same for the same seed and use."""
        return options[derive(self.seed, use) % len(options)]

    def paint(self, options: Sequence[Paint], use: str = "paint") -> Paint:
        """One of the paints, in the look's colour if it has one."""
        return self.pick(options, use).tinted(self.color)

    def tint(self, paint: Paint, colors: Sequence[str], use: str = "color") -> Paint:
        """`paint` in one of the colours, or in the look's colour if it has one."""
        return paint.tinted(self.color or self.pick(colors, use))


class Region(NamedTuple):
    """A horizontal support rectangle of a model, in the model's frame (metres).

    Attributes:
        y: height above the model's foot.
        x0, x1, z0, z1: its sides.
        clear: free height above it.
    """

    y: float
    x0: float
    x1: float
    z0: float
    z1: float
    clear: float = 10.0


Regions = Callable[[Look], tuple[Region, ...]]


def top(look: Look) -> tuple[Region, ...]:
    """Return the whole upper side without its rim."""
    return (over(look, look.size[1]),)


def over(look: Look, y: float, inset: float = 0.02) -> Region:
    """Return the whole footprint at height `y` without its rim."""
    x, z = max(look.size[0] / 2 - inset, 0.01), max(look.size[2] / 2 - inset, 0.01)
    return Region(y, -x, x, -z, z)


def nowhere(look: Look) -> tuple[Region, ...]:
    """Return an empty tuple of regions."""
    return ()


def shelves(look: Look, count: int, low: float = 0.03, high: float = 0.03, inset: float = 0.03) -> tuple[Region, ...]:
    """Return the regions of `count` shelves, spaced evenly from `low` above the foot to `high` below the top.

    Lowest first.
    """
    step = (look.size[1] - low - high) / count
    return tuple(over(look, low + step * k, inset)._replace(clear=step - 0.03) for k in range(count))


@dataclass(frozen=True, slots=True)
class Recipe:
    """A model of a kind of object.

    Attributes:
        draw: look -> mesh that stands on y = 0, faces +z and fits the look's size (open doors may exceed it).
        size: a typical size, metres.
        variants: number of designs.
        on: support regions for things ON it.
        inside: support regions for things INSIDE it.
        kinds: its varieties, for the sheet.
        lamp: height of its bulb as a share of the box if it lights a room, else None.
        states: pairs of states that change its appearance, for the sheet.
    """

    draw: Callable[[Look], Mesh]
    size: Size
    variants: int = 1
    on: Regions = top
    inside: Regions = nowhere
    kinds: tuple[str, ...] = ()
    lamp: float | None = None
    states: tuple[str, ...] = ()
