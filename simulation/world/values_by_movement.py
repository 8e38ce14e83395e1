"""Values that follow from where things are, kept from tick to tick.

Worlds share their `Moved` as long as nothing is moved, so its identity stands for where every thing is. The key of a
value is what else it depends on.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import Generic, TypeVar

from hearth.simulation.world.moved_edges import Moved

T = TypeVar("T")

MOST_KEPT = 512
"""Values that a table keeps; of a home's few tables of masks, some hundred kilobytes."""


class ValuesByMovement(Generic[T]):
    """The last values of one kind, by movements and by a key."""

    __slots__ = ("_kept", "_most")

    def __init__(self, most: int = MOST_KEPT) -> None:
        self._kept: dict[tuple[int, Hashable], tuple[Moved, T]] = {}
        self._most = most

    def find(self, moved: Moved, key: Hashable) -> T | None:
        """Return the value that is kept for a key and these very movements, or None."""
        found = self._kept.get((id(moved), key))
        return found[1] if found is not None else None

    def keep(self, moved: Moved, key: Hashable, value: T) -> T:
        """Keep a value and return it; the movements are kept with it, so that no others get their identity."""
        if len(self._kept) >= self._most:
            self._kept.clear()
        self._kept[id(moved), key] = moved, value
        return value
