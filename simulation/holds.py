"""Whether a literal holds in a world: one small function a predicate, all over bit sets.

A literal whose terms stand for several nodes holds when it holds of some subject and some target.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from operator import attrgetter
from typing import Any, NamedTuple, TypeVar

from hearth.schemas.literals import AGENT, HANDS, HOLDS, RELATION_OF, STATE_OF, Key, Literal, Name
from hearth.schemas.vocabulary import CHARACTER_CLASS, STATE_ID, STATES
from hearth.simulation import rows
from hearth.simulation.agent import Agent
from hearth.simulation.bits import indices, mask_of
from hearth.simulation.home import Home
from hearth.simulation.world import World

T = TypeVar("T", bound=Key | Name)

UNBOUND: Mapping[Any, int] = {}
"""Nothing is bound. A binding has the node ids of a program's objects, or of variables; characters need none."""

PETS = ("cat", "dog")
"""What may lie on a seat that is wanted."""

Row = Callable[[World, int], int]
"""What a node stands in a relation to."""

Test = Callable[[World, int, int], bool]
"""Whether a predicate holds of a node and of some of a set of targets; without a target the set is empty."""


def holds(literal: Literal[T], world: World, binding: Mapping[T, int] = UNBOUND) -> bool:
    """Whether a literal holds; without its negation, one about a term that stands for nothing does not."""
    _, terms, negated = literal
    home = world.home
    subjects = nodes(terms[0], home, binding)
    targets = 0
    if len(terms) > 1:
        targets = nodes(terms[1], home, binding)
        if not targets:
            return negated
    test = _test(literal)
    while subjects:
        bit = subjects & -subjects
        if test(world, bit.bit_length() - 1, targets):
            return not negated
        subjects ^= bit
    return negated


class Candidates(NamedTuple):
    """The nodes that may make a literal hold, and so how often it can.

    What is counted are subjects; of a relation of characters, for each character what it stands in the relation to.

    Attributes:
        literal: whose candidates they are.
        subjects, targets: sets of nodes; a state has no targets.
        of_characters: it is a relation of characters.
    """

    literal: Literal[Name]
    subjects: int
    targets: int
    of_characters: bool

    def met(self, world: World) -> tuple[int, ...]:
        """What makes the literal hold in a world: a set of subjects, or for each character a set of targets."""
        literal = self.literal
        if self.of_characters:
            row = RELATED[literal.name]
            mine = (row(world, agent.index) for agent in world.agents if self.subjects & agent.bit)
            return tuple(self.targets & (~found if literal.negated else found) for found in mine)
        return self.updated((0,), world, indices(self.subjects))

    def updated(self, met: tuple[int, ...], world: World, changed: Iterable[int]) -> tuple[int, ...]:
        """The same from what it was in an earlier world, where only edges and states of `changed` nodes differ."""
        if self.of_characters:
            return self.met(world)
        test, negated = _test(self.literal), self.literal.negated
        (mask,) = met
        for i in changed:
            if self.subjects >> i & 1:
                mask = mask | 1 << i if test(world, i, self.targets) != negated else mask & ~(1 << i)
        return (mask,)


def candidates(literal: Literal[Name], home: Home) -> Candidates:
    """The nodes of a home that may make a literal hold."""
    subjects = nodes(literal.terms[0], home)
    targets = nodes(literal.terms[1], home) if len(literal.terms) > 1 else 0
    of_characters = literal.name in RELATED and bool(targets) and not subjects & ~home.characters
    return Candidates(literal, subjects, targets, of_characters)


def nodes(term: T, home: Home, binding: Mapping[T, int] = UNBOUND) -> int:
    """The nodes that a term stands for: a program's object or a variable for the one it is bound to, a class for its
    instances (see `Home.instances`).
    """
    if isinstance(term, tuple):
        name, number = term
        if name == CHARACTER_CLASS and 0 < number <= len(home.agents):
            return 1 << home.agents[number - 1]
        return _node(binding.get(term), home)
    if isinstance(term, int):
        return _node(term, home)
    if term in binding:
        return _node(binding[term], home)
    name, _, text = term.partition(":")
    if name != AGENT:
        return home.instances(term)
    if term == AGENT:
        return home.characters
    return 1 << home.agents[int(text)] if text.isdecimal() and int(text) < len(home.agents) else 0


def _node(node_id: int | None, home: Home) -> int:
    index = -1 if node_id is None else home.index.get(node_id, -1)
    return 1 << index if index >= 0 else 0


def related(relation: str) -> Row:
    """The row of a relation, characters included; of one that is not simulated, as the graph stores it."""
    row = RELATED.get(relation)
    return row or (lambda world, i: _stored(world, i, relation))


def _stored(world: World, i: int, *relations: str) -> int:
    home = world.home
    edges = (edge for edge in home.others if edge[1] in relations and edge[0] == home.ids[i])
    return mask_of(home.index[target] for _, _, target in edges if target in home.index)


def _mirrored(of_thing: Row, of_character: Callable[[Agent], int], to_character: Callable[[Agent], int]) -> Row:
    """A row of a relation that the rows of things and each character's own edges hold together."""

    def row(world: World, i: int) -> int:
        if world.home.characters >> i & 1:
            return of_character(rows.character(world, i))
        found = of_thing(world, i)
        for agent in world.agents:
            if to_character(agent) >> i & 1:
                found |= agent.bit
        return found

    return row


def _held(of_character: Callable[[Agent], int], *hands: str) -> Row:
    def row(world: World, i: int) -> int:
        if world.home.characters >> i & 1:
            return of_character(rows.character(world, i))
        return _stored(world, i, *hands) if world.home.others else 0

    return row


RELATED: dict[str, Row] = {
    "ON": _mirrored(rows.on, attrgetter("on"), attrgetter("worn")),
    "INSIDE": _mirrored(rows.inside, attrgetter("inside"), attrgetter("contents")),
    "CLOSE": _mirrored(rows.close, attrgetter("close"), attrgetter("close")),
    "FACING": _mirrored(rows.facing, attrgetter("facing"), attrgetter("faced")),
    "BETWEEN": lambda world, i: world.home.between[i],
    HANDS[0]: _held(attrgetter("right"), HANDS[0]),
    HANDS[1]: _held(attrgetter("left"), HANDS[1]),
    HOLDS: _held(attrgetter("held"), *HANDS),
}
"""The relations, each with what a node stands in it to."""


def _test(literal: Literal[T]) -> Test:
    """The predicate of a literal; one that is not simulated holds as the graph stores it."""
    name = literal.name
    if len(literal.terms) > 1:
        return BINARY.get(name) or _relation(related(name))
    return UNARY.get(name) or (lambda world, i, _: name in world.home.node(i).states)


def _relation(row: Row) -> Test:
    return lambda world, i, targets: bool(row(world, i) & targets)


def _state(name: str) -> Test:
    number = STATE_ID[name]
    return lambda world, i, _: bool(world.states[number] >> i & 1)


def _free(world: World, i: int, _: int = 0) -> bool:
    """One more fits on the seat or bed."""
    home = world.home
    limit = max(home.limit(i), home.limit(i, lying=True))
    return rows.bearing(world, i).bit_count() < limit


def _full_hands(world: World, i: int, _: int) -> bool:
    return any(agent.right and agent.left for agent in world.agents if agent.index == i)


def _shut_in(world: World, i: int, _: int) -> bool:
    """A way into its room leads through a closed door."""
    room = rows.room_of(world, i)
    closed = world.home.doors & world.states[STATE_ID["CLOSED"]]
    return room >= 0 and any(world.home.between[door] >> room & 1 for door in indices(closed))


def _pet(world: World, i: int, _: int) -> bool:
    """A pet is on it."""
    pets = (world.home.by_class.get(name, 0) for name in PETS)
    return any(mask & rows.bearing(world, i) for mask in pets)


def _in_room(world: World, i: int, targets: int) -> bool:
    room = rows.room_of(world, i)
    return room >= 0 and bool(targets >> room & 1)


def _elsewhere(world: World, i: int, targets: int) -> bool:
    """It is in another room than the target, which is a room."""
    room = rows.room_of(world, i)
    return room < 0 or bool(targets & ~(1 << room))


def _together(world: World, i: int, targets: int) -> bool:
    """Both are in one room."""
    room = rows.room_of(world, i)
    return any(rows.room_of(world, j) == room for j in indices(targets))


def _is_held(world: World, i: int, targets: int) -> bool:
    """The target, a character, holds it."""
    return any(agent.held >> i & 1 for agent in world.agents if targets & agent.bit)


def _apart(world: World, i: int, targets: int) -> bool:
    """Who has walked to the target is not close to it."""
    mine = (1 << i | rows.close(world, i) | rows.on(world, i)) & ~world.home.properties["BODY_PART"]
    return any(not mine & world.home.reach[j] for j in indices(targets))


def _stowed(world: World, i: int, _: int) -> bool:
    """It is in something closed."""
    return rows.closed_container(world, i) >= 0


def _averted(world: World, i: int, targets: int) -> bool:
    """It does not face the target."""
    return bool(targets & ~RELATED["FACING"](world, i))


UNARY: dict[str, Test] = {
    **{name: _state(name) for name in STATES},
    **{name: _state(state) for name, state in STATE_OF.items()},
    "sitting": _state("SITTING"),
    "lying": _state("LYING"),
    "free": _free,
    "occupied": lambda world, i, _: not _free(world, i),
    "full_hands": _full_hands,
    "shut_in": _shut_in,
    "pet": _pet,
}
"""The predicates of one term: states, and conditions."""

BINARY: dict[str, Test] = {
    **{name: _relation(row) for name, row in RELATED.items()},
    **{name: _relation(RELATED[relation]) for name, relation in RELATION_OF.items()},
    "location": _in_room,
    "together": _together,
    "elsewhere": _elsewhere,
    "apart": _apart,
    "averted": _averted,
    "holds": _is_held,
    "stowed": _stowed,
}
"""The predicates of two terms: relations, and conditions."""
