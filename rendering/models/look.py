"""What a recipe is told about the object it draws."""

from __future__ import annotations

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
    """One object as it is to be drawn.

    Attributes:
        size: width (x), height (y), depth (z) in metres of the box it fills.
        variant: which of the recipe's designs.
        seed: decides colours and other small choices.
        states: names of `vocabulary.STATES`.
        color: overrides the main colour.
        kind: overrides what is special to a class (`apple`, `lemon`); recipes say which they know.
        level: height in metres at which things stand on it, if known (a seat's, a mattress's); 0 for the recipe's own.
        hole: (x0, x1, z0, z1) cut out of its top for what is sunk into it, in its own frame.
        ajar: how far its doors and drawers are open when it is OPEN: from 0 to 1.
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

    def seat(self, usual: float, share: float) -> float:
        """The height things stand at: `level`, else `usual` metres, but never above `share` of the height."""
        return min(self.level or usual, self.size[1] * share)

    @property
    def open(self) -> float:
        """How far it is open: 0 unless it is OPEN."""
        return self.ajar if "OPEN" in self.states else 0.0

    @property
    def on(self) -> bool:
        """Whether it is ON."""
        return "ON" in self.states

    def pick(self, options: Sequence[Choice], use: str) -> Choice:
        """One of the options: always the same one for the same object and use."""
        return options[derive(self.seed, use) % len(options)]

    def paint(self, options: Sequence[Paint], use: str = "paint") -> Paint:
        """One of the paints, in the look's own colour if it has one."""
        return self.pick(options, use).tinted(self.color)

    def tint(self, paint: Paint, colors: Sequence[str], use: str = "color") -> Paint:
        """`paint` in one of the colours, or in the look's own if it has one."""
        return paint.tinted(self.color or self.pick(colors, use))


class Region(NamedTuple):
    """A horizontal rectangle of a model on which things can stand, in its own frame (metres).

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
    """The whole upper side, but for its rim."""
    return (over(look, look.size[1]),)


def over(look: Look, y: float, inset: float = 0.02) -> Region:
    """The whole footprint at height `y`, but for its rim."""
    x, z = max(look.size[0] / 2 - inset, 0.01), max(look.size[2] / 2 - inset, 0.01)
    return Region(y, -x, x, -z, z)


def nowhere(look: Look) -> tuple[Region, ...]:
    """Nothing stands there."""
    return ()


def shelves(look: Look, count: int, low: float = 0.03, high: float = 0.03, inset: float = 0.03) -> tuple[Region, ...]:
    """Places on `count` shelves, equally spaced between `low` above the foot and `high` under the top; lowest first."""
    step = (look.size[1] - low - high) / count
    return tuple(over(look, low + step * k, inset)._replace(clear=step - 0.03) for k in range(count))


@dataclass(frozen=True, slots=True)
class Recipe:
    """How a kind of object is drawn.

    Attributes:
        draw: look -> mesh standing on y = 0, facing +z, within the look's size (open doors may reach out).
        size: a typical size in metres.
        variants: how many designs it has.
        on: where things stand on it.
        inside: where things stand in it.
        kinds: the kinds it knows, for the sheet.
        lamp: height of its bulb as a share of the box when it lights a room, else None.
        states: pairs of states that change how it looks, for the sheet.
    """

    draw: Callable[[Look], Mesh]
    size: Size
    variants: int = 1
    on: Regions = top
    inside: Regions = nowhere
    kinds: tuple[str, ...] = ()
    lamp: float | None = None
    states: tuple[str, ...] = ()
