"""The allowed next steps of a program: legal in the current world, and afforded by the grammar (thesis A.3)."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.simulation.actions.legal import legal
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

Masks = tuple[int, ...]


class Partial(NamedTuple):
    """The parts of a step that are chosen so far; None for a part that is not.

    Attributes:
        action: its name.
        first: index of the first object's node in the home, or NONE.
        second: likewise of the second object.
    """

    action: str | None = None
    first: int | None = None
    second: int | None = None


NONE = -1
"""Number in place of a node: the step has no such object."""

NOTHING = Partial()


class Affordances:
    """The nodes of a home that each argument of each action may be, by the grammar: constant for a home.

    Executability requires affordances as well as the engine (A.3). If every step is legal but affordances are ignored,
    about half of the programs are executable.
    """

    def __init__(self, home: Home) -> None:
        self._home = home
        self._known: dict[tuple[str, int], int] = {}

    def __call__(self, action: str, position: int) -> int:
        """Return the nodes, as a bit set."""
        key = action, position
        mask = self._known.get(key)
        if mask is None:
            mask = 0
            afforded = _afforded(self._home.knowledge, action, position)
            for name, nodes in self._home.by_class.items():
                if afforded[name]:
                    mask |= nodes
            self._known[key] = mask
        return mask


class _Afforded(dict[str, bool]):
    """A cache of answers: class name to whether the action affords that class."""

    def __init__(self, knowledge: Knowledge, action: str, position: int) -> None:
        self._affords = partial(knowledge.affords, action, position)

    def __missing__(self, name: str) -> bool:
        found = self[name] = self._affords(name)
        return found


@lru_cache(maxsize=1 << 10)
def _afforded(knowledge: Knowledge, action: str, position: int) -> _Afforded:
    # Each environment is a home of its own; their classes are the same.
    return _Afforded(knowledge, action, position)


@dataclass(frozen=True)
class Options:
    """The steps that may come next.

    Attributes:
        masks: for each action the nodes that each of its arguments may be; each argument has at least one, so that no
            choice of a part leaves the others without any.
    """

    masks: Mapping[str, Masks]

    def allows(self, action: str, nodes: Sequence[int]) -> bool:
        """Return whether an action may be done with these objects, by their indices in the home."""
        masks = self.masks.get(action)
        if masks is None or len(masks) != len(nodes):
            return False
        return len({*nodes}) == len(nodes) and all(mask >> node & 1 for mask, node in zip(masks, nodes, strict=True))

    def without(self, actions: Container[str], repeated: Iterable[tuple[str, int]] = ()) -> Options:
        """Return the options without these actions, and without these objects in the first place of an action."""
        masks = {name: found for name, found in self.masks.items() if name not in actions}
        for name, node in repeated:
            if name in masks and node == NONE:
                del masks[name]
            elif name in masks and (rest := masks[name][0] & ~(1 << node)):
                masks[name] = (rest, *masks[name][1:])
            else:
                masks.pop(name, None)
        return Options(masks)

    @cached_property
    def firsts(self) -> int:
        """Return the nodes that some action takes as its first object."""
        found = 0
        for masks in self.masks.values():
            if masks:
                found |= masks[0]
        return found

    def actions(self, chosen: Partial) -> list[str]:
        """Return the actions that agree with the chosen first object, in alphabetical order."""
        if chosen.first is None:
            return sorted(self.masks)
        if chosen.first == NONE:
            return sorted(name for name, masks in self.masks.items() if not masks)
        return sorted(name for name, masks in self.masks.items() if masks and masks[0] >> chosen.first & 1)

    def second(self, chosen: Partial) -> int:
        """Return the nodes that the chosen action takes as second object, given the chosen first object."""
        masks = self.masks[chosen.action or ""]
        return masks[1] & ~(1 << (chosen.first or 0)) if len(masks) > 1 else 0


class Grammar:
    """The options in the worlds of one home; a world that a step leaves as it was is the same object and costs nothing.

    Args:
        home: with its knowledge.
        rules: of the engine.
    """

    def __init__(self, home: Home, rules: Rules = DEFAULT) -> None:
        self._afforded = Affordances(home)
        self._rules = rules
        self._known: dict[int, tuple[World, Options]] = {}

    def options(self, world: World) -> Options:
        """Return the steps that are possible in a world."""
        # By identity: the hash of a world costs more than its options. The world is kept, so that its id stays its own.
        known = self._known.get(id(world))
        if known is None:
            known = self._known[id(world)] = world, self._options(world)
        return known[1]

    def _options(self, world: World) -> Options:
        found: dict[str, Masks] = {}
        for action, masks in legal(world, rules=self._rules).masks.items():
            kept = tuple([mask & self._afforded(action, place) for place, mask in enumerate(masks)])
            if all(kept) and (pair := _distinct(kept)) is not None:
                found[action] = pair
        return Options(found)


def _distinct(masks: Masks) -> Masks | None:
    """Masks of arguments that are never one node: a first object that leaves no second is taken out."""
    if len(masks) < 2:
        return masks
    first, second = masks
    if second.bit_count() == 1:
        first &= ~second
    return (first, second) if first else None
