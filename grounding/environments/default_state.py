"""Homes prepared for sampling: all nodes in their default states, with tables of instances and placements by class."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache, cached_property
from itertools import accumulate
from typing import NamedTuple

from hearth.grounding.environments.home_thinning import superfluous, without
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failure_words import NO_USUAL_PLACE
from hearth.schemas.failures import Code
from hearth.schemas.graph import Edge
from hearth.schemas.spoken_words import spoken
from hearth.schemas.vocabulary import STATES
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import extended
from hearth.simulation.world.home import Home
from hearth.simulation.world.node_states import states_of
from hearth.simulation.world.world import World

WITHOUT_PLACE = frozenset({"BodyParts", "Characters", "People", "Animals"})
"""Categories without placements."""

DRINK, DRINKWARE = "drink", "drinkware"
"""Kinds: a drink is a carton or a bottle, or what was poured from it into drinkware."""


class Spots(NamedTuple):
    """Usual places of a class in a home: (class, index of the place, ON or INSIDE), weights summed and each."""

    choices: tuple[tuple[str, int, str], ...]
    weights: tuple[int, ...]
    each: tuple[int, ...]


class Kind(NamedTuple):
    """The attributes of a new node of a class: category, sorted properties, default states."""

    category: str
    properties: tuple[str, ...]
    states: tuple[str, ...]


Homeless = tuple[Code, str, str]
"""A failure's code, `expected` and `actual`."""


class Base:
    """A home in its default state, with tables that sampling looks up repeatedly.

    Attributes:
        home: doors OPEN, lamps ON, everything else CLOSED, OFF, CLEAN and PLUGGED_IN; the character stands with empty
            hands (thesis 5.5.2).
        knowledge: its placements decide where things belong.
        start: the home as a world.
        character: id of the character's node.
        room: index of each node's room, or -1.
        whole: the home that this is a thinned version of; else the home itself.
        removed: ids of the nodes that were thinned out.
    """

    def __init__(self, home: Home, whole: Home | None = None, removed: tuple[int, ...] = ()) -> None:
        self.knowledge: Knowledge = home.knowledge
        self.home = _in_default_state(home)
        self.whole = whole or self.home
        self.removed = removed
        self.start = World.start(self.home)
        self.character = self.home.ids[self.home.agents[0]]
        self.room = [self.home.direct_room[i] for i in range(len(self.home))]
        self.instances, self.kind = cache(self._instances), cache(self._kind)
        self.homeless, self.spots = cache(self._homeless), cache(self._spots)
        self._thinned = cache(self._without_many)

    def thinned(self, most: int) -> Base:
        """Return the home thinned to at most `most` nodes, if possible, by removing small movable things."""
        return self if len(self.home) <= most else self._thinned(most)

    def _without_many(self, most: int) -> Base:
        removed = superfluous(self.home, most)
        return Base(without(self.home, removed), self.home, removed)

    @cached_property
    def seats(self) -> int:
        """The seats and beds."""
        return self.home.properties["SITTABLE"] | self.home.properties["LIEABLE"]

    def rooms(self, name: str) -> tuple[int, ...]:
        """Return indices of the rooms that serve as the named one; of all rooms where none does."""
        return self.instances(name) or tuple(indices(self.home.rooms))

    def _instances(self, name: str) -> tuple[int, ...]:
        """Return indices of the instances of a class, under the first of its names that occurs in the home."""
        return tuple(indices(self.home.instances(name)))

    def _kind(self, name: str) -> Kind:
        """Properties and states of a new node of a class."""
        thing = self.knowledge.object_class(name)
        properties = tuple(sorted(thing.properties)) if thing else ()
        category = thing.category if thing else "placable_objects"
        return Kind(category, properties, self.knowledge.default_states(name))

    def _homeless(self, name: str) -> Homeless | None:
        """Return the failure of any sampling that needs a thing of a class; None if the home can hold one."""
        knowledge, home = self.knowledge, self.home
        if knowledge.is_room(name):
            if self.instances(name):
                return None
            rooms = ", ".join(sorted({home.classes[i] for i in indices(home.rooms)})) or "none"
            return (
                Code.NO_ROOM,
                f"a home with a {spoken(name)}, or a room that serves as one",
                f"{home.name} has {rooms}",
            )
        known = knowledge.object_class(name)
        if known is None or known.category in WITHOUT_PLACE or known.rooms or self.instances(name):
            return None
        if knowledge.placements(name):
            return None
        return Code.NO_PLACE, NO_USUAL_PLACE, "none"

    def _spots(self, name: str) -> Spots:
        """Return where a thing of a class belongs in this home, by the knowledge's placements and their weights.

        A drink in its carton or bottle stands in no glass, where its placements have the drink that was poured.
        """
        places = self._places(name)
        if DRINK in self.knowledge.ancestors(name):
            places = (place for place in places if not self.towers_over(name, self.home.classes[place[0][1]]))
        return _weighted(places)

    def towers_over(self, name: str, holder: str) -> bool:
        """Return whether drinkware of a class is smaller than a thing of another class."""
        thing, vessel = map(self.knowledge.object_class, (name, holder))
        if thing is None or vessel is None or DRINKWARE not in self.knowledge.ancestors(holder):
            return False
        return max(thing.size) > max(vessel.size)

    @cached_property
    def fillers(self) -> Spots:
        """Every movable thing at every place it belongs: what makes one environment differ from another."""
        movable = (c.name for c in self.knowledge.objects.values() if "GRABBABLE" in c.properties and not c.same_as)
        return _weighted(spot for name in movable for spot in self._places(name))

    def _places(self, name: str) -> Iterable[tuple[tuple[str, int, str], int]]:
        for placement in self.knowledge.placements(name):
            if placement.relation == "NEARBY":
                continue
            for i in self.instances(placement.destination):
                room = self.home.classes[self.room[i]] if self.room[i] >= 0 else ""
                if placement.room in ("", room):
                    yield (name, i, placement.edge), placement.weight


def prepared(home: Home) -> Base:
    """Return the home prepared for sampling, once for each home."""
    known: dict[str, Base] = home.worked_out
    base = known.get("prepared")
    if base is None:
        base = known["prepared"] = Base(home)
    return base


def _weighted(spots: Iterable[tuple[tuple[str, int, str], int]]) -> Spots:
    pairs = tuple(spots)
    each = tuple(weight for _, weight in pairs)
    return Spots(tuple(spot for spot, _ in pairs), tuple(accumulate(each)), each)


def need_somebody(home: Home) -> None:
    """Refuse a home without a character.

    Raises:
        HearthError: BAD_GRAPH.
    """
    if not home.agents:
        remedy = "`home edit HOME --add character:inside:ROOM` adds one"
        raise HearthError.of(Code.BAD_GRAPH, f"nobody is in the home `{home.name}`", suggestion=remedy)


def _in_default_state(home: Home) -> Home:
    """Return the home with default states, its (first) character standing in the room it is in, if it has rooms.

    Raises:
        HearthError: BAD_GRAPH: nobody is in it.
    """
    states: dict[int, tuple[str, ...]] = {}
    for i, node_id in enumerate(home.ids):
        wanted = _default_states(home, i)
        if wanted != states_of(i, home.states):
            states[node_id] = wanted
    start = World.start(home)
    need_somebody(home)
    if not home.rooms:
        return extended(home, (), (), (), states)
    (agent, *_) = start.agents
    me = home.ids[agent.index]
    removed = [edge for edge in start.edges() if me in (edge.source, edge.target)]
    room = next(indices(agent.inside & home.rooms), next(indices(home.rooms)))
    return extended(home, (), [Edge(me, "INSIDE", home.ids[room])], removed, states)


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
