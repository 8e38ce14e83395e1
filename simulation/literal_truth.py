"""Tests of literals in a world: one small function a predicate, all over bit sets.

A literal whose terms stand for several nodes holds when it holds of some subject and some target.
"""

from collections.abc import Callable, Mapping
from functools import partial
from operator import attrgetter
from typing import Any, NamedTuple, TypeVar

from hearth.schemas.literals import (
    AGENT,
    HANDS,
    HOLDS,
    LACK_OF_SET_3,
    RELATION_OF,
    STATE_OF,
    STATE_OF_SET_3,
    Key,
    Literal,
    Name,
)
from hearth.schemas.vocabulary import CHARACTER_CLASS, EVERY_STATE_ID, STATE_ID, STATES
from hearth.simulation.world import edge_rows
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

T = TypeVar("T", bound=Key | Name)

UNBOUND: Mapping[Any, int] = {}
"""Nothing is bound. A binding has the node ids of a program's objects, or of variables; characters need none."""

PETS = ("cat", "dog")
"""Animals that may lie on a seat."""

Unary = Callable[[World, int], bool]
"""A test whether a predicate holds of a node."""

Binary = Callable[[World, int, int], int]
"""With which of some targets a predicate holds of a node."""


def holds(literal: Literal[T], world: World, binding: Mapping[T, int] = UNBOUND) -> bool:
    """Return whether a literal holds; without its negation, one about a term that stands for nothing does not.

    Examples:
        >>> literal = hearth.Literal.of("HOLDS", "agent", "milk")
        >>> hearth.holds(literal, world), hearth.holds(literal, execution.final)
        (False, True)
    """
    name, terms, negated = literal
    home = world.home
    subjects = nodes(terms[0], home, binding)
    if len(terms) == 1:
        test = UNARY.get(name) or unary(name)
        while subjects:
            i = subjects.bit_length() - 1
            if test(world, i):
                return not negated
            subjects ^= 1 << i
        return negated
    targets = nodes(terms[1], home, binding)
    related = BINARY.get(name) or binary(name)
    while subjects and targets:
        i = subjects.bit_length() - 1
        if related(world, i, targets):
            return not negated
        subjects ^= 1 << i
    return negated


class Candidates(NamedTuple):
    """The nodes that may make a literal hold, and so how often it can.

    What is counted are subjects; of two terms of which the first are characters, for each of them the targets.

    Attributes:
        literal: whose candidates they are.
        subjects, targets: sets of nodes; a state has no targets.
        by_target: what is counted are targets.
    """

    literal: Literal[Name]
    subjects: int
    targets: int
    by_target: bool

    def needed(self, wanted: int) -> int:
        """Return how often it must hold to be reached.

        As often as is wanted; if negated, of all candidates, as in `holds`.
        """
        if not self.literal.negated:
            return wanted
        return self.subjects.bit_count() * (self.targets.bit_count() if self.by_target else 1)

    def met(self, world: World) -> tuple[int, ...]:
        """Return the candidates for which the literal holds in a world: subjects, or for each character targets."""
        name, _, negated = self.literal
        if self.by_target:
            related, targets = binary(name), self.targets
            found = (related(world, i, targets) for i in indices(self.subjects))
            return tuple(targets & ~mask for mask in found) if negated else tuple(found)
        return (self._subjects(world, self.subjects),)

    def updated(self, met: tuple[int, ...], world: World, changed: int) -> tuple[int, ...]:
        """Return the same from its value in an earlier world, where only the edges and states of some nodes differ."""
        if self.by_target:
            return self.met(world)
        return (met[0] & ~changed | self._subjects(world, self.subjects & changed),)

    def _subjects(self, world: World, among: int) -> int:
        name, terms, negated = self.literal
        if len(terms) == 1:
            test = unary(name)
            return mask_of(i for i in indices(among) if test(world, i) != negated)
        related, targets = binary(name), self.targets
        return mask_of(i for i in indices(among) if bool(related(world, i, targets)) != negated)


def candidates(literal: Literal[Name], home: Home) -> Candidates:
    """Return the nodes of a home that may make a literal hold."""
    subjects = nodes(literal.terms[0], home)
    if len(literal.terms) == 1:
        return Candidates(literal, subjects, 0, by_target=False)
    return Candidates(literal, subjects, nodes(literal.terms[1], home), by_target=not subjects & ~home.characters)


def nodes(term: T, home: Home, binding: Mapping[T, int] = UNBOUND) -> int:
    """Return the nodes that a term stands for: a program's object or a variable for the one it is bound to, a class,
    and a room that a program does not name, for its instances (see `Home.instances`).
    """
    if isinstance(term, tuple):
        if term[0] == CHARACTER_CLASS and 0 < term[1] <= len(home.agents):
            return 1 << home.agents[term[1] - 1]
        node_id = binding.get(term, -1)
        if node_id < 0 and home.knowledge.is_room(term[0]):
            return home.instances(term[0]) & home.rooms
    elif isinstance(term, int):
        node_id = term
    elif term in binding:
        node_id = binding[term]
    else:
        return _named(term, home)
    index = home.index.get(node_id, -1)
    return 1 << index if index >= 0 else 0


def _named(name: str, home: Home) -> int:
    if name == AGENT:
        return home.characters
    first, _, number = name.partition(":")
    if first != AGENT:
        return home.instances(name)
    if len(number) > _DIGITS or not number.isdecimal() or int(number) >= len(home.agents):
        return 0
    return 1 << home.agents[int(number)]


_DIGITS = 9
"""Of a character's number at most; Python refuses to read numbers of thousands of digits."""


def unary(name: str) -> Unary:
    """Return the predicate of one term; a state that the world does not simulate holds where the graph stores it."""
    return UNARY.get(name) or partial(_kept, name)


def _kept(name: str, world: World, i: int) -> bool:
    number = EVERY_STATE_ID.get(name, len(world.states))
    if number < len(world.states):
        return bool(world.states[number] >> i & 1)
    return name in world.home.node(i).states


def _lacks(states: tuple[str, ...], world: World, i: int) -> bool:
    return not any(_kept(name, world, i) for name in states)


def binary(name: str) -> Binary:
    """Return the predicate of two terms; a relation that is not simulated holds where the graph stores it."""
    return BINARY.get(name) or (lambda world, i, targets: _stored(world, i, name) & targets)


def _stored(world: World, i: int, *relations: str) -> int:
    home = world.home
    edges = (edge for edge in home.others if edge[1] in relations and edge[0] == home.ids[i])
    return mask_of(home.index[target] for _, _, target in edges if target in home.index)


def _mirrored(row: Callable[[World, int], int], out: Callable[[Agent], int], into: Callable[[Agent], int]) -> Binary:
    """Return a relation that the rows of things hold together with the characters' own edges, `out` and `into` them."""

    def related(world: World, i: int, targets: int) -> int:
        characters = world.home.characters
        if characters >> i & 1:
            return out(edge_rows.character(world, i)) & targets
        found = row(world, i) & targets
        if targets & characters:
            for agent in world.agents:
                if into(agent) >> i & 1:
                    found |= agent.bit & targets
        return found

    return related


def _held(hand: Callable[[Agent], int], *relations: str) -> Binary:
    def related(world: World, i: int, targets: int) -> int:
        if world.home.characters >> i & 1:
            return hand(edge_rows.character(world, i)) & targets
        return _stored(world, i, *relations) & targets if world.home.others else 0

    return related


def _between(world: World, i: int, targets: int) -> int:
    return world.home.between[i] & targets


def _state(name: str) -> Unary:
    number = STATE_ID[name]
    return lambda world, i: bool(world.states[number] >> i & 1)


def _free(world: World, i: int) -> bool:
    """One more fits on the seat or bed, which may be made: bedding does not count."""
    home = world.home
    limit = max(home.limit(i), home.limit(i, lying=True))
    return edge_rows.taking_room(world, i).bit_count() < limit


def _occupied(world: World, i: int) -> bool:
    return not _free(world, i)


def _full_hands(world: World, i: int) -> bool:
    return any(agent.right and agent.left for agent in world.agents if agent.index == i)


def _doors_closed(world: World, i: int) -> bool:
    """Return a way into its room leads through a closed door."""
    room = edge_rows.room_of(world, i)
    closed = world.home.doors & world.states[STATE_ID["CLOSED"]]
    return room >= 0 and any(world.home.between[door] >> room & 1 for door in indices(closed))


def _pet(world: World, i: int) -> bool:
    """Return a pet is on it."""
    pets = (world.home.by_class.get(name, 0) for name in PETS)
    return any(mask & edge_rows.bearing(world, i) for mask in pets)


def _in_room(world: World, i: int, targets: int) -> int:
    room = edge_rows.room_of(world, i)
    return targets & 1 << room if room >= 0 else 0


def _other_room(world: World, i: int, targets: int) -> int:
    """It is in another room than the target, which is a room."""
    return targets & ~_in_room(world, i, targets)


def _together(world: World, i: int, targets: int) -> int:
    """Both are in one room."""
    room = edge_rows.room_of(world, i)
    return mask_of(j for j in indices(targets) if edge_rows.room_of(world, j) == room)


def _is_held(world: World, i: int, targets: int) -> int:
    """Return the target, a character, holds it."""
    return mask_of(agent.index for agent in world.agents if agent.held >> i & 1) & targets


def _not_near(world: World, i: int, targets: int) -> int:
    """Return a character that has walked to the target is not close to it."""
    home = world.home
    mine = (1 << i | edge_rows.close(world, i) | edge_rows.on(world, i)) & ~home.properties["BODY_PART"]
    return mask_of(j for j in indices(targets) if not mine & home.reach[j])


def _in_closed_container(world: World, i: int, targets: int) -> int:
    """It is in something closed, whatever the target, in or on which it belongs."""
    return targets if edge_rows.closed_container(world, i) >= 0 else 0


def _facing_away(world: World, i: int, targets: int) -> int:
    """It does not face the target."""
    return targets & ~BINARY["FACING"](world, i, targets)


UNARY: dict[str, Unary] = {
    **{name: _state(name) for name in STATES},
    **{name: _state(state) for name, state in STATE_OF.items()},
    **{name: partial(_kept, state) for name, state in STATE_OF_SET_3.items()},
    **{name: partial(_lacks, states) for name, states in LACK_OF_SET_3.items()},
    "sitting": _state("SITTING"),
    "lying": _state("LYING"),
    "free": _free,
    "occupied": _occupied,
    "full_hands": _full_hands,
    "doors_closed": _doors_closed,
    "pet": _pet,
}
"""The predicates of one term: states, and conditions."""

RELATED: dict[str, Binary] = {
    "ON": _mirrored(edge_rows.on, attrgetter("on"), attrgetter("worn")),
    "INSIDE": _mirrored(edge_rows.inside, attrgetter("inside"), attrgetter("contents")),
    "CLOSE": _mirrored(edge_rows.close, attrgetter("close"), attrgetter("close")),
    "FACING": _mirrored(edge_rows.facing, attrgetter("facing"), attrgetter("faced")),
    "BETWEEN": _between,
    HANDS[0]: _held(attrgetter("right"), HANDS[0]),
    HANDS[1]: _held(attrgetter("left"), HANDS[1]),
    HOLDS: _held(attrgetter("held"), *HANDS),
}
"""The relations."""

BINARY: dict[str, Binary] = {
    **RELATED,
    **{name: RELATED[relation] for name, relation in RELATION_OF.items()},
    "location": _in_room,
    "together": _together,
    "other_room": _other_room,
    "not_near": _not_near,
    "facing_away": _facing_away,
    "holds": _is_held,
    "in_closed_container": _in_closed_container,
}
"""The predicates of two terms: relations, and conditions."""
