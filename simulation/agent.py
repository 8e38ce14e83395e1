"""A character's own edges, kept apart from the things' because almost every step changes them."""

from __future__ import annotations

from typing import NamedTuple


class Agent(NamedTuple):
    """One character.

    Attributes:
        index: its node's index.
        bit: the set of it alone.
        close: what it is CLOSE to, and what is CLOSE to it.
        facing, faced: what it is FACING; what is FACING it.
        inside, contents: what it is INSIDE; what is INSIDE it.
        on, worn: what it is ON; what is ON it.
        right, left: what each hand holds.
        origins: where grabbed things came from: (thing, place, kind of relation), for PutObjBack.
    """

    index: int  # type: ignore[assignment] # what tuples call index is of no use here
    bit: int
    close: int = 0
    facing: int = 0
    faced: int = 0
    inside: int = 0
    contents: int = 0
    on: int = 0
    worn: int = 0
    right: int = 0
    left: int = 0
    origins: tuple[tuple[int, int, int], ...] = ()

    @property
    def held(self) -> int:
        """What either hand holds."""
        return self.right | self.left
