"""The chooser's features of a node for an object of a sketch: its place, its states, and the other candidates.

Ids are not among it: those of things that were added to a home for a program are the highest.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from hearth.models.sketches.candidate_choices import Candidate, Choice
from hearth.models.sketches.name_numbers import Words
from hearth.schemas.literals import Key
from hearth.schemas.program import Step
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.world import World

MOST = 32
"""Candidates of one object; of more, the nearest."""

KINDS = 6
"""Numbers of names for a node: its class, its room's, that of the ON and INSIDE neighbor, and two of CLOSE ones."""


class Use(NamedTuple):
    """An object of a sketch, and its uses in the sketch.

    Attributes:
        key: its name and instance.
        uses: (action, argument) pairs.
    """

    key: Key
    uses: tuple[tuple[str, int], ...]


def used(sketch: Sequence[Step]) -> tuple[Use, ...]:
    """Return the objects of a sketch in the order of their first mention."""
    found: dict[Key, list[tuple[str, int]]] = {}
    for step in sketch:
        for place, ref in enumerate(step.objects):
            found.setdefault(ref.key, []).append((step.action, place))
    return tuple(Use(key, tuple(dict.fromkeys(uses))) for key, uses in found.items())


class Places:
    """The world at the start, as the choice of nodes looks at it; each node's features are computed once."""

    def __init__(self, world: World, sketch: Sequence[Step], words: Words) -> None:
        self.world, self.words, self.home = world, words, world.home
        self.me = world.agents[0]
        self.room = edge_rows.agent_room(world, self.me)
        self.objects = used(sketch)
        self.candidates = {use.key: self._candidates(use) for use in self.objects}
        self._nodes: dict[int, tuple[list[int], list[float]]] = {}
        self._rooms = {
            key: frozenset(edge_rows.room_of(world, node) for node in nodes) for key, nodes in self.candidates.items()
        }

    def _candidates(self, use: Use) -> list[int]:
        """Return indices of the nodes that an object may be, the nearest first.

        Of its class, and fit for all its uses.
        """
        home, world = self.home, self.world
        able = home.everything & ~self.me.bit
        for action, place in use.uses:
            known = home.knowledge.actions.get(action)
            if known is not None and known.executed and place < known.arity:
                able &= home.able(action, place)
        names = home.knowledge.same_class(use.key[0])
        mask = next((found for name in names if (found := home.by_class.get(name, 0) & able)), 0)
        rank = {
            i: (not edge_rows.is_close(world, self.me, i), edge_rows.room_of(world, i) != self.room, i)
            for i in indices(mask)
        }
        return sorted(rank, key=rank.__getitem__)[:MOST]

    def features(self, use: Use, node: int, bound: Mapping[Key, int]) -> tuple[list[int], list[float]]:
        """Return a candidate's names and numbers: its own, and those relative to the nodes chosen so far.

        Args:
            use: the object.
            node: index of the candidate.
            bound: indices of the nodes chosen for earlier objects.
        """
        names, own = self._node(node)
        world, chosen = self.world, list(bound.values())
        room = edge_rows.room_of(world, node)
        nodes = self.candidates[use.key]
        others = [rooms for key, rooms in self._rooms.items() if key != use.key]
        here = 1 << node
        rooms = [edge_rows.room_of(world, other) for other in chosen]
        beside = [
            float(node in chosen),
            rooms.count(room) / max(1, len(rooms)),
            float(bool(rooms) and rooms[-1] == room),
            float(not rooms),
            sum(room in each for each in others) / max(1, len(others)),
            float(any(edge_rows.on(world, node) >> o & 1 or edge_rows.inside(world, node) >> o & 1 for o in chosen)),
            float(any(self._holds(o, here) for o in chosen)),
            float(any(edge_rows.close(world, node) >> o & 1 for o in chosen)),
            1 / len(nodes),
            1 / sum(edge_rows.room_of(world, other) == room for other in nodes),
        ]
        return names, own + beside

    def _holds(self, node: int, here: int) -> bool:
        return bool((edge_rows.on(self.world, node) | edge_rows.inside(self.world, node)) & here)

    def _node(self, node: int) -> tuple[list[int], list[float]]:
        """Return the names and numbers of a node that do not depend on other choices."""
        known = self._nodes.get(node)
        if known is None:
            known = self._nodes[node] = self._names(node), self._numbers(node)
        return known

    def _names(self, node: int) -> list[int]:
        world, home, word = self.world, self.home, self.words.thing
        room = edge_rows.room_of(world, node)
        on, inside = (
            list(indices(mask)) for mask in (edge_rows.on(world, node), edge_rows.inside(world, node) & ~home.rooms)
        )
        close = list(indices(edge_rows.close(world, node) & ~home.rooms & ~home.characters))
        near = sorted({word(home.classes[i]) for i in close})
        names = [node, room, on[0] if on else -1, inside[0] if inside else -1]
        return [word(home.classes[i]) if i >= 0 else 0 for i in names] + [*near[:1], *near[-1:], 0, 0][:2]

    def _numbers(self, node: int) -> list[float]:
        world, room = self.world, edge_rows.room_of(self.world, node)
        counts = (
            edge_rows.close(world, node),
            edge_rows.on(world, node),
            edge_rows.inside(world, node),
            edge_rows.bearing(world, node),
        )
        return [
            *[float(state >> node & 1) for state in world.states],
            float(room == self.room),
            float(edge_rows.is_close(world, self.me, node)),
            float(edge_rows.closed_container(world, node) >= 0),
            *[float(np.log1p(mask.bit_count())) / 3 for mask in counts],
            float(bool(edge_rows.facing(world, node))),
        ]


NUMBERS = 10 + 3 + 4 + 1 + 10
"""Numbers of a candidate."""


def node_choice(places: Places, use: Use, bound: Mapping[Key, int], right: int | None = None) -> Choice:
    """Return the choice of a node for an object of a sketch; `right` is the index of the right node in the home."""
    words, nodes = places.words, places.candidates[use.key]
    actions = [words.action(action) for action, _ in use.uses]
    names = [words.thing(use.key[0]), *[*actions, 0, 0][:2], words.code(use.uses[0][1])]
    room = places.home.classes[places.room] if places.room >= 0 else ""
    names += [words.thing(room), words.code(len(bound)), words.code(len(nodes))]
    bag = [number for each in places.objects for number in _bag(each, words)]
    candidates = [Candidate(*places.features(use, node, bound)) for node in nodes]
    return Choice(names, bag, [1 / len(nodes)], candidates, nodes.index(right) if right in nodes else -1)


def _bag(use: Use, words: Words) -> list[int]:
    return [words.thing(use.key[0]), *(words.action(action) for action, _ in use.uses[:1])]
