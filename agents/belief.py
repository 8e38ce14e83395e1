"""An agent's beliefs about the places and states of objects (thesis 6.4, B.1.1).

A thing that the agent has not observed is in any of the rooms and closed containers with equal probability. One world
is drawn from that belief and kept. A thing is drawn anew only once an observation refutes its place.
"""

from __future__ import annotations

from functools import reduce
from operator import or_
from random import Random
from typing import Literal, NamedTuple

from hearth.schemas.literals import HOLDS
from hearth.schemas.vocabulary import OPPOSITE, STATE_ID
from hearth.simulation.observation.views import View
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices, lowest, mask_of
from hearth.simulation.world.home import Home
from hearth.simulation.world.states import CLEAN, CLOSED, OFF, OPEN, PLUGGED_IN, with_state
from hearth.simulation.world.world import World

USUAL = {CLOSED: "CAN_OPEN", OFF: "HAS_SWITCH", PLUGGED_IN: "HAS_PLUG", CLEAN: "GRABBABLE"}
"""The believed state of an object that has not been observed, and the property of objects that can have this state."""


Extent = Literal["class", "goal", "any"]
"""The containers in which an agent looks for a thing: those in which its class belongs according to the knowledge, or
anything that the goal is about, or all.
"""


class Place(NamedTuple):
    """The place of a thing.

    Attributes:
        relation: `INSIDE` a room or a container, `ON` a thing, or `HOLDS` of the character that holds it.
        node: index of that room, thing or character.
    """

    relation: str
    node: int


def place_of(world: World, thing: int) -> Place:
    """Return the place of a thing in a world: its holder, the node it is in or on, or else its room."""
    for agent in world.agents:
        if agent.held >> thing & 1:
            return Place(HOLDS, agent.index)
    rooms = world.home.rooms
    inside = edge_rows.inside(world, thing) & ~rooms
    if inside:
        return Place("INSIDE", lowest(inside))
    on = edge_rows.on(world, thing) & ~rooms
    return Place("ON", lowest(on)) if on else Place("INSIDE", edge_rows.room_of(world, thing))


def containers(home: Home) -> int:
    """Return the fixed nodes that can be opened and, according to the knowledge, have things inside."""
    fixed = home.properties["CAN_OPEN"] & home.everything & ~(home.properties["GRABBABLE"] | home.rooms | home.doors)
    known = home.knowledge
    return mask_of(
        i for i in indices(fixed) if any(placement.edge == "INSIDE" for placement in known.holds(home.classes[i]))
    )


def usual_containers(home: Home, name: str) -> int:
    """Return the containers in which things of a class belong, by the knowledge; all where none is known."""
    every = containers(home)
    known = home.knowledge
    names = {placement.destination for placement in known.placements(name) if placement.edge == "INSIDE"}
    usual = mask_of(i for i in indices(every) if not names.isdisjoint(known.same_class(home.classes[i])))
    return usual or every


class Belief:
    """The believed places of some things, and the believed states of everything.

    Attributes:
        things: the set of the things whose places it keeps.
        where: the place of each in the world that was drawn.
        known: those that were seen at that place.
        states: the believed sets of `World.states`.
        seen: the set of nodes in view.
        room: index of the room that the agent is in, or -1.
    """

    def __init__(self, home: Home, things: int, chooser: Random, *, looks_in: Extent = "goal") -> None:
        """Nothing seen yet.

        Args:
            home: of the episode.
            things: whose places are of interest.
            chooser: draws places.
            looks_in: the containers in which a thing may be; once all of them are refuted, any.
        """
        self.things = things
        self.where: dict[int, Place] = {}
        self.known = self.seen = 0
        self.room = -1
        empty = (0,) * len(home.states)
        self.states: tuple[int, ...] = tuple(
            home.properties[USUAL[number]] & home.everything if number in USUAL else row
            for number, row in enumerate(empty)
        )
        self._rooms = home.rooms
        self._closable = containers(home)
        self._everywhere = self._closable | home.rooms & home.everything
        usual = {name: usual_containers(home, name) for name in {home.classes[i] for i in indices(things)}}
        places = {i: usual[home.classes[i]] for i in indices(things)}
        if looks_in == "goal":
            places = dict.fromkeys(places, reduce(or_, usual.values(), 0))
        rooms = home.rooms & home.everything
        self._usual = {i: self._everywhere if looks_in == "any" else place | rooms for i, place in places.items()}
        self._possible = dict(self._usual)
        self._rest = dict.fromkeys(self._usual, self._everywhere)
        self._chooser = chooser

    def doubt(self, state: str, things: int, negated: bool) -> None:
        """Believe of things that were not seen that a wanted state does not hold, so that the agent goes and looks."""
        number = STATE_ID[state] if negated else STATE_ID[OPPOSITE[state]]
        self.states = with_state(self.states, number, things & ~self.seen)

    def observe(self, view: View) -> None:
        """Update the beliefs by an observation."""
        world, mask = view.world, view.mask
        self.seen = mask
        self.room = -1 if view.me.room is None else world.home.index[view.me.room]
        now = world.states[: len(self.states)]  # plans ask for none of the further states of action set 3
        self.states = tuple([old & ~mask | new & mask for old, new in zip(self.states, now, strict=True)])
        empty = self._closable & mask & world.states[OPEN] | (1 << self.room if self.room >= 0 else 0)
        for thing in indices(self.things & mask):
            self.where[thing] = place_of(world, thing)
        self.known |= self.things & mask
        for thing in indices(self.things & ~mask):
            if self.known >> thing & 1:
                if self._refuted(self.where[thing]):
                    self.known &= ~(1 << thing)
                    self._possible[thing] = self._usual[thing] & ~empty
                    self._rest[thing] = self._everywhere
                    self._draw(thing, empty)
            else:
                self._possible[thing] &= ~empty
                self._rest[thing] &= ~empty
                if thing not in self.where or not self._possible[thing] >> self.where[thing].node & 1:
                    self._draw(thing, empty)

    def rule_out(self, thing: int) -> None:
        """Draw the place of a thing anew: the agent can't look for it at the believed place."""
        self._possible[thing] &= ~(1 << self.where[thing].node)
        self._draw(thing, 1 << self.where[thing].node)

    def forget(self, thing: int) -> None:
        """Forget the place of a thing: it may be anywhere again."""
        self.known &= ~(1 << thing)
        self._possible[thing] = self._usual[thing]
        self._rest[thing] = self._everywhere
        self._draw(thing, 0)

    def _refuted(self, place: Place) -> bool:
        """Return whether an unseen thing can't be at a place, because the agent would see it there.

        The agent sees this room, and the things on or in visible objects that are not closed (a sink never is).
        Holders are not considered.
        """
        if place.relation == HOLDS:
            return True
        if self._rooms >> place.node & 1:
            return place.node == self.room
        hidden = self.states[CLOSED] if place.relation == "INSIDE" else 0
        return bool((self.seen & ~hidden) >> place.node & 1)

    def _draw(self, thing: int, empty: int) -> None:
        """Draw a place among those that no observation refutes: where such things belong, or else anywhere.

        Once every place is refuted, the draw begins anew.
        """
        possible = self._possible[thing] or self._rest[thing]
        if not possible:
            possible = self._rest[thing] = self._everywhere & ~empty or self._everywhere
        self._possible[thing] = possible
        self.where[thing] = Place("INSIDE", self._chooser.choice(list(indices(possible))))

    def shut_in(self, thing: int) -> int:
        """Index of the closed container in which a thing is believed to be, or -1."""
        place = self.where.get(thing)
        if place is None or place.relation != "INSIDE" or self._rooms >> place.node & 1:
            return -1
        return place.node if self.states[CLOSED] >> place.node & 1 else -1

    def probabilities(self, thing: int) -> dict[int, float]:
        """Return where a thing may be: the believed probability by index of the room, container, surface or holder."""
        if self.known >> thing & 1:
            return {self.where[thing].node: 1.0}
        possible = self._possible[thing]
        return dict.fromkeys(indices(possible), 1.0 / possible.bit_count())
