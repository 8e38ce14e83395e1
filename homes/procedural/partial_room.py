"""A partially furnished room of a procedural home."""

from dataclasses import dataclass, field
from random import Random

from hearth.homes.geometry import Rect
from hearth.homes.plans.furniture import Furnishing
from hearth.homes.plans.plan import Piece
from hearth.homes.plans.shell import Opening
from hearth.kb.knowledge import Knowledge


@dataclass(slots=True)
class Suite:
    """A partially furnished room of a procedural home.

    Attributes:
        furnishing: what has its place so far, as for a plan.
        openings: of this room's walls.
        kept: floor to keep free: before doors and before what is used.
        solids: what stands or hangs: rectangle, underside, top.
        pieces: the entries so far, in the order placed.
    """

    furnishing: Furnishing
    openings: list[Opening]
    kept: list[Rect]
    rng: Random
    solids: list[tuple[Rect, float, float]] = field(default_factory=list)
    pieces: list[Piece] = field(default_factory=list)

    @property
    def knowledge(self) -> Knowledge:
        """For sizes and for what belongs where."""
        return self.furnishing.knowledge
