"""The truth of a literal, read slowly off the edges of a graph: the twin of `hearth.simulation.literal_truth`.

Every predicate is asked of one node, or of one and another; what a term stands for is tried node by node.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from hearth.kb.knowledge import Knowledge
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.literals import HANDS, Key, Literal, Name
from hearth.schemas.vocabulary import RELATIONS
from oracles.facts import Facts

STATES = {
    "closed": "CLOSED", "open": "OPEN", "is_off": "OFF", "is_on": "ON", "dirty": "DIRTY", "clean": "CLEAN",
    "unplugged": "PLUGGED_OUT", "plugged": "PLUGGED_IN", "sitting": "SITTING", "lying": "LYING",
}  # fmt: skip
OF_SET_3 = {"broken": "BROKEN", "cold": "COLD", "cut": "CUT", "empty": "EMPTY", "full": "FULL", "hot": "HOT"}
LACKS = {"uncut": "CUT", "intact": "BROKEN"}
EDGES = {"in": "ON", "inside": "INSIDE", "atreach": "CLOSE", "nearby": "CLOSE", "facing": "FACING"}
DOORS = "BETWEEN"
BEDDING = ("blanket", "comforter", "pillow", "sheets")


@dataclass(frozen=True)
class Plain:
    """A graph as it is now and as it was at the start, and what its names mean."""

    now: Facts
    start: Facts
    knowledge: Knowledge

    @classmethod
    def of(cls, now: EnvironmentGraph, start: EnvironmentGraph, knowledge: Knowledge) -> Plain:
        """The reading of a graph."""
        return cls(Facts.of(now), Facts.of(start), knowledge)

    def holds(self, literal: Literal[Key] | Literal[Name], binding: Mapping[object, int]) -> bool:
        """Return whether the literal holds of some nodes that its terms stand for."""
        first, *rest = (self.meant(term, binding) for term in literal.terms)
        if rest:
            return any(self.related(literal.name, x, y) for x in first for y in rest[0]) != literal.negated
        return any(self.is_so(literal.name, x) for x in first) != literal.negated

    def count(self, literal: Literal[Name]) -> int:
        """Count how often the literal holds: each target of subjects that are characters, else each subject once."""
        name, terms, negated = literal
        first, *rest = (self.meant(term, {}) for term in terms)
        if not rest:
            return sum(self.is_so(name, x) != negated for x in first)
        if first <= self.characters():
            return sum(self.related(name, x, y) != negated for x in first for y in rest[0])
        return sum(any(self.related(name, x, y) for y in rest[0]) != negated for x in first)

    def meant(self, term: Key | Name, binding: Mapping[object, int]) -> set[int]:
        """The nodes that a term may stand for."""
        agents = sorted(self.characters())
        if isinstance(term, tuple) and term[0] == "character" and 0 < term[1] <= len(agents):
            return {agents[term[1] - 1]}
        if isinstance(term, tuple) and term not in binding and self.knowledge.is_room(term[0]):
            return {node for node in self.meant(term[0], {}) if self.now.is_room(node)}
        if isinstance(term, int | tuple) or term in binding:
            return {term if isinstance(term, int) else binding.get(term)} & {*self.now.nodes()}
        if term == "agent":
            return {*agents}
        if term.startswith("agent:"):
            number = term.removeprefix("agent:")
            return {*agents[int(number) : int(number) + 1]} if number.isdecimal() else set()
        for name in (term, *self.knowledge.same_class(term)):
            found = {node for node in self.now.nodes() if self.now.class_name(node) == name}
            if found:
                return found
        return set()

    def characters(self) -> set[int]:
        return {node for node in self.now.nodes() if self.now.class_name(node) == "character"}

    def is_so(self, name: str, x: int) -> bool:
        """Return whether a predicate of one term holds."""
        now, above = self.now, self.now.sources("ON", x)
        if name in ("free", "occupied"):
            kind = now.class_name(x)
            limit = max(self.knowledge.seat_limit(kind), self.knowledge.bed_limit(kind))
            return (len(self.counted(x, above)) < limit) == (name == "free")
        if name == "full_hands":
            return x in self.characters() and all(now.targets(hand, x) for hand in HANDS)
        if name == "doors_closed":
            doors = now.sources(DOORS, now.room(x)) if now.room(x) is not None else ()
            return any(now.has_state(door, "CLOSED") for door in doors)
        if name == "pet":
            return any(now.class_name(other) in ("cat", "dog") for other in above)
        if name in LACKS:
            return not now.has_state(x, LACKS[name])
        return now.has_state(x, {**STATES, **OF_SET_3}.get(name, name))

    def counted(self, x: int, above: Iterable[int]) -> list[int]:
        """Return the nodes that take room on a seat; on a bed or sofa to lie on, bedding does not."""
        made = "LIEABLE" in self.now.properties(x)
        return [other for other in above if not made or self.now.class_name(other) not in BEDDING]

    def related(self, name: str, x: int, y: int) -> bool:
        """Return whether a predicate of two terms holds."""
        now = self.now
        if name in EDGES or name in RELATIONS:
            return y in now.targets(EDGES.get(name, name), x)
        if name == "HOLDS":
            return any(y in now.targets(hand, x) for hand in HANDS)
        if name == "holds":
            return y in self.characters() and any(x in now.targets(hand, y) for hand in HANDS)
        if name in ("location", "other_room"):
            return (now.room(x) == y) == (name == "location")
        if name == "together":
            return now.room(x) == now.room(y)
        if name == "facing_away":
            return y not in now.targets("FACING", x)
        if name == "in_closed_container":
            around = now.targets("INSIDE", x)
            return any(now.has_state(place, "CLOSED") and not now.is_room(place) for place in around)
        return name == "not_near" and not self.beside(x) & self.around(y)

    def beside(self, x: int) -> set[int]:
        """A thing, what it is close to, and what it is on."""
        near = set() if x in self.characters() else self.now.targets("CLOSE", x) | self.now.targets("ON", x)
        return {x, *near} - (self.characters() - {x}) - self.bodies()

    def around(self, y: int) -> set[int]:
        """Return the nodes that a character is close to after a walk to a thing, at the start."""
        if y in self.characters():
            return {y} - self.bodies()
        start = self.start
        places = {place for place in start.targets("INSIDE", y) if not start.is_room(place)}
        above = start.sources("ON", y) if "SURFACES" in start.properties(y) else set()
        return ({y} | places | above) - self.bodies() - (self.characters() - {y})

    def bodies(self) -> set[int]:
        return {node for node in self.now.nodes() if "BODY_PART" in self.now.properties(node)}
