"""The slots of arrays: which node of a home stands in which row."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.actions.legal import Legal
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.home import Home


@dataclass(frozen=True, eq=False)
class Slots:
    """Nodes of a home by slot. A node keeps its slot as long as the home is the same, seen or not.

    Attributes:
        home: the home.
        size: number of slots; those beyond `order` are empty.
        order: index of the node in each slot.
    """

    home: Home
    size: int
    order: tuple[int, ...]

    @classmethod
    def of(cls, home: Home, size: int, things: Iterable[str | int] | None = None) -> Slots:
        """Return the slots of a home.

        Args:
            home: the home.
            size: number of slots.
            things: the nodes of arrays: names of classes, and ids; everything where None, in the order of ids.

        Raises:
            HearthError: BAD_ARGUMENT, where the home has more nodes than there are slots, or nothing of that name.
        """
        if things is None:
            order = tuple(indices(home.everything))
        else:
            order = tuple(dict.fromkeys(i for name in things for i in _nodes(name, home)))
        if len(order) > size:
            raise HearthError.of(Code.BAD_ARGUMENT, f"{len(order)} nodes of {home!r} for {size} slots",
                                 suggestion=f"nodes={-len(order) // 64 * -64}")  # fmt: skip
        return cls(home, size, order)

    @cached_property
    def mask(self) -> int:
        """Return the nodes that have a slot."""
        return mask_of(self.order)

    @cached_property
    def by_index(self) -> NDArray[np.int64]:
        """Slot of each node of the home by index; -1 of one that has none."""
        found = np.full(len(self.home), -1, np.int64)
        found[list(self.order)] = np.arange(len(self.order))
        return found

    @cached_property
    def _order(self) -> NDArray[np.int64]:
        return np.array(self.order, np.int64)

    def rows(self, masks: Sequence[int]) -> NDArray[np.int8]:
        """Return sets of nodes as int8 (sets, slots)."""
        count = len(self.home)
        width = count + 7 >> 3
        whole = (1 << count) - 1
        packed = b"".join([(mask & whole).to_bytes(width, "little") for mask in masks])
        bits = np.unpackbits(np.frombuffer(packed, np.uint8).reshape(len(masks), width), axis=1, bitorder="little")
        found = np.zeros((len(masks), self.size), np.int8)
        found[:, : len(self.order)] = bits[:, self._order]
        return found

    def members(self, mask: int) -> list[int]:
        """Return the slots of a set of nodes, in the order of their ids."""
        by_index = self._slots
        return [by_index[i] for i in indices(mask & self.mask)]

    def ordered(self, mask: int) -> list[int]:
        """Return the indices of a set of nodes, in the order of their slots."""
        return [i for i in self.order if mask >> i & 1]

    @cached_property
    def _slots(self) -> list[int]:
        found: list[int] = self.by_index.tolist()
        return found

    def slot(self, ref: ObjectRef) -> int | None:
        """Return the slot of the node that a reference is bound to; None where it has none."""
        index = self.home.index.get(-1 if ref.node is None else ref.node)
        slot = -1 if index is None else self._slots[index]
        return None if slot < 0 else slot

    def reference(self, slot: int) -> ObjectRef:
        """Return a reference to the node of a slot; to none, where the slot is empty."""
        if not 0 <= slot < len(self.order):
            return ObjectRef("nothing", 0, None)
        i = self.order[slot]
        return ObjectRef(self.home.classes[i], 0, self.home.ids[i])

    def choices(self, masks: Sequence[int]) -> list[tuple[int, ...]]:
        """Return the slots of the objects of each instruction of an action, by its masks in `Legal`.

        Two objects differ.
        """
        return [slots for slots in product(*map(self.members, masks)) if len(set(slots)) == len(slots)]

    def count(self, legal: Legal) -> int:
        """Return how many instructions `instructions` lists."""
        return sum(len(self.choices(masks)) for masks in legal.masks.values())

    def instruction(self, legal: Legal, place: int) -> Step | None:
        """Return the instruction at a place of `instructions`, from 0, without making those before it.

        The result is None beyond the end.
        """
        for action in sorted(legal.masks):
            choices = self.choices(legal.masks[action])
            if place < len(choices):
                return Step(action, tuple(map(self.reference, choices[place])), legal.agent)
            place -= len(choices)
        return None

    def instructions(self, legal: Legal) -> Iterator[Step]:
        """Yield the legal instructions about nodes that have slots, in the order of `Legal`.

        No instruction names one thing twice, as no program may.
        """
        for action in sorted(legal.masks):
            for slots in self.choices(legal.masks[action]):
                yield Step(action, tuple(map(self.reference, slots)), legal.agent)


def _nodes(name: str | int, home: Home) -> list[int]:
    if isinstance(name, int):
        found = [home.index[name]] if name in home.index else []
    else:
        found = list(indices(home.instances(name)))
    if not found:
        raise HearthError.of(Code.BAD_ARGUMENT, f"{home!r} has nothing called {name!r}"[:200])
    return found
