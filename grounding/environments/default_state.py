"""Homes made ready for sampling: everything in its default state, and tables of what can be found and put where."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from itertools import accumulate
from typing import NamedTuple
from weakref import WeakKeyDictionary

from hearth.grounding.environments.thinning import superfluous, without
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code
from hearth.schemas.graph import Edge
from hearth.schemas.vocabulary import STATES
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import extended
from hearth.simulation.world.home import Home
from hearth.simulation.world.nodes import states_of
from hearth.simulation.world.world import World

WITHOUT_PLACE = frozenset({"BodyParts", "Characters", "People", "Animals"})
"""Categories of what is wherever it is."""


class Spots(NamedTuple):
    """Where things of a class belong in a home: (class, index of the place, ON or INSIDE), weights summed and each."""

    choices: tuple[tuple[str, int, str], ...]
    weights: tuple[int, ...]
    each: tuple[int, ...]


class Kind(NamedTuple):
    """What a new node of a class is like: category, sorted properties, default states."""

    category: str
    properties: tuple[str, ...]
    states: tuple[str, ...]


Homeless = tuple[Code, str, str]
"""A failure's code, what was expected, and what there is."""


class Base:
    """A home in its default state, with what sampling asks of it again and again.

    Attributes:
        home: doors OPEN, lamps ON, everything else CLOSED, OFF, CLEAN and PLUGGED_IN; the character stands with empty
            hands (thesis 5.5.2).
        knowledge: what decides where things belong.
        start: the home as a world.
        character: id of the character's node.
        room: index of each node's room, or -1.
        whole: the home that this is a thinned version of; else the home itself.
        gone: ids of the nodes that it lacks for that.
    """

    def __init__(self, home: Home, whole: Home | None = None, gone: tuple[int, ...] = ()) -> None:
        self.knowledge: Knowledge = home.knowledge
        self.home = _at_rest(home)
        self.whole = whole or self.home
        self.gone = gone
        self._thinned: dict[int, Base] = {}
        self.start = World.start(self.home)
        self.character = self.home.ids[self.home.agents[0]]
        self.room = [_room(self.home, i) for i in range(len(self.home))]
        self._spots: dict[str, Spots] = {}
        self._kinds: dict[str, Kind] = {}
        self._named: dict[str, tuple[int, ...]] = {}
        self._serving: dict[str, tuple[int, ...]] = {}
        self._homeless: dict[str, Homeless | None] = {}

    def thinned(self, most: int) -> Base:
        """The home with at most so many nodes, if that can be: without small loose things that it has many of."""
        if len(self.home) <= most:
            return self
        found = self._thinned.get(most)
        if found is None:
            gone = superfluous(self.home, most)
            found = self._thinned[most] = Base(without(self.home, gone), self.home, gone)
        return found

    @cached_property
    def seats(self) -> int:
        """What one sits or lies on."""
        return self.home.properties["SITTABLE"] | self.home.properties["LIEABLE"]

    def rooms(self, name: str) -> tuple[int, ...]:
        """Indices of the rooms that serve as the named one; of all rooms where none does."""
        return self.serving(name) or tuple(indices(self.home.rooms))

    def serving(self, name: str) -> tuple[int, ...]:
        """Indices of the rooms of that class, or of its nearest stand-in; none where the home has neither."""
        known = self._serving.get(name)
        if known is None:
            seen: set[str] = set()
            room, found = name, 0
            while room and room not in seen and not found:
                seen.add(room)
                found = self.home.by_class.get(room, 0) & self.home.rooms
                room = self.knowledge.room_standins.get(room, "")
            known = self._serving[name] = tuple(indices(found))
        return known

    def instances(self, name: str) -> tuple[int, ...]:
        """Indices of what a program may mean by a class name: of the first of its names that the home knows."""
        found = self._named.get(name)
        if found is None:
            found = self._named[name] = tuple(indices(self.home.instances(name)))
        return found

    def kind(self, name: str) -> Kind:
        """What a new node of a class is like."""
        found = self._kinds.get(name)
        if found is None:
            thing = self.knowledge.object_class(name)
            properties = tuple(sorted(thing.properties)) if thing else ()
            category = thing.category if thing else "placable_objects"
            found = self._kinds[name] = Kind(category, properties, self.knowledge.default_states(name))
        return found

    def homeless(self, name: str) -> Homeless | None:
        """Why the home can't hold a thing of a class, whatever is sampled: the code, what is expected, and what is."""
        if name not in self._homeless:
            self._homeless[name] = self._why_homeless(name)
        return self._homeless[name]

    def _why_homeless(self, name: str) -> Homeless | None:
        knowledge, home = self.knowledge, self.home
        if knowledge.is_room(name):
            if self.serving(name):
                return None
            rooms = ", ".join(sorted({home.classes[i] for i in indices(home.rooms)}))
            return Code.NO_ROOM, f"a home with a {name}, or a room that serves as one", f"{home.name} has {rooms}"
        known = knowledge.object_class(name)
        if known is None or known.category in WITHOUT_PLACE or known.rooms or self.instances(name):
            return None
        if knowledge.placements(name):
            return None
        return Code.NO_PLACE, f"a place for {name}: a row in placements.csv, or one in the home", "neither"

    def spots(self, name: str) -> Spots:
        """Where a thing of a class belongs in this home, by the knowledge's placements and their weights."""
        found = self._spots.get(name)
        if found is None:
            found = self._spots[name] = _weighted(self._places(name))
        return found

    @cached_property
    def fillers(self) -> Spots:
        """Every loose thing at every place it belongs: what makes one environment differ from another."""
        loose = (c.name for c in self.knowledge.objects.values() if "GRABBABLE" in c.properties and not c.same_as)
        return _weighted(spot for name in loose for spot in self._places(name))

    def _places(self, name: str) -> Iterable[tuple[tuple[str, int, str], int]]:
        for placement in self.knowledge.placements(name):
            if placement.relation == "NEARBY":
                continue
            for i in self.instances(placement.destination):
                room = self.home.classes[self.room[i]] if self.room[i] >= 0 else ""
                if placement.room in ("", room):
                    yield (name, i, placement.edge), placement.weight


_BASES: WeakKeyDictionary[Home, Base] = WeakKeyDictionary()


def prepared(home: Home) -> Base:
    """The home made ready, once for each home."""
    base = _BASES.get(home)
    if base is None:
        base = _BASES[home] = Base(home)
    return base


def _weighted(spots: Iterable[tuple[tuple[str, int, str], int]]) -> Spots:
    pairs = tuple(spots)
    each = tuple(weight for _, weight in pairs)
    return Spots(tuple(spot for spot, _ in pairs), tuple(accumulate(each)), each)


def _at_rest(home: Home) -> Home:
    """The home with default states, its (first) character standing in the room it is in."""
    states: dict[int, tuple[str, ...]] = {}
    for i, node_id in enumerate(home.ids):
        wanted = _default_states(home, i)
        if wanted != states_of(i, home.states):
            states[node_id] = wanted
    agent = World.start(home).agents[0]
    me = home.ids[agent.index]
    gone = [edge for edge in World.start(home).edges() if me in (edge.source, edge.target)]
    room = next(indices(agent.inside & home.rooms), next(indices(home.rooms)))
    return extended(home, (), [Edge(me, "INSIDE", home.ids[room])], gone, states)


_BY_PROPERTY = (("CAN_OPEN", "CLOSED"), ("HAS_SWITCH", "OFF"), ("HAS_PLUG", "PLUGGED_IN"))


def _default_states(home: Home, i: int) -> tuple[str, ...]:
    """By the node's own properties, which may be more than its class's; a class's own defaults go first."""
    if (home.rooms | home.characters) >> i & 1:
        return ()
    known = home.knowledge.default_states(home.classes[i])
    pairs = [{name, STATES[number ^ 1]} for number, name in enumerate(STATES)]
    wanted = set(known)
    for prop, state in _BY_PROPERTY:
        if home.properties.get(prop, 0) >> i & 1 and not wanted & pairs[STATES.index(state)]:
            wanted.add(state)
    return tuple(name for name in STATES if name in wanted)


def _room(home: Home, i: int) -> int:
    return home.direct_room[i]
