"""Homes and goals of ours as BDDL problems."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from hearth.interop.bddl.words import words
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal, Joined
from hearth.schemas.graph import EnvironmentGraph, Node
from hearth.schemas.literals import AGENT, Literal, Name
from hearth.schemas.vocabulary import CHARACTER_CLASS, ROOM_CATEGORY

PANELS = frozenset({"wall", "floor", "ceiling"})
"""Classes of the parts of a building; of the floors BDDL has one for each room."""


def problem_text(graph: EnvironmentGraph, goal: Goal, knowledge: Knowledge, name: str = "home-0") -> str:
    """Return a home and a goal as a BDDL problem.

    Raises:
        HearthError: NOT_UNDERSTOOD: a part of the goal is about an order, a time or an action, which BDDL can't say.
    """
    writer = _Writing(graph, knowledge)
    facts = "\n".join(f"        {fact}" for fact in writer.facts())
    wanted = writer.goal(goal, {})
    used = dict.fromkeys(name for *_, name in SUBSTANCES if name in facts + wanted)
    listed = [*(f"{name} - {name.rpartition('_')[0]}" for name in used),
              *(f"{' '.join(names)} - {kind}" for kind, names in writer.objects().items())]  # fmt: skip
    objects = "\n".join(f"        {line}" for line in listed)
    return (
        f"(define (problem {name})\n    (:domain omnigibson)\n\n    (:objects\n{objects}\n    )\n\n"
        f"    (:init\n{facts}\n    )\n\n    (:goal\n        {wanted}\n    )\n)\n"
    )


SUBSTANCES = (
    ("DIRTY", "CLEAN", "covered", "dust.n.01_1"),
    ("WET", "DRY", "covered", "water.n.06_1"),
    ("FULL", "EMPTY", "filled", "water.n.06_1"),
)
"""States of ours that are predicates of a thing and a substance: of true, of false, the predicate, the substance."""


@dataclass
class _Writing:
    """The writing of one home and its goal."""

    graph: EnvironmentGraph
    knowledge: Knowledge

    def __post_init__(self) -> None:
        self.rooms = {node.id: node for node in self.graph.nodes if node.category == ROOM_CATEGORY}
        self.nodes = {node.id: node for node in self.graph.nodes}
        self.things = [n for n in self.graph.nodes if n.class_name not in PANELS and n.id not in self.rooms]
        self.room_of = {
            e.source: e.target for e in self.graph.edges if e.relation == "INSIDE" and e.target in self.rooms
        }
        self.count = 0

    def objects(self) -> dict[str, list[str]]:
        """Return the names of the instances of each synset; each room has a floor."""
        found: dict[str, list[str]] = {"floor.n.01": [self.instance(room) for room in self.rooms.values()]}
        for node in self.things:
            found.setdefault(synset(node.class_name), []).append(self.instance(node))
        return found

    def instance(self, node: Node) -> str:
        """Return the name of a node; of a room, and of each part of its floor, that of its floor."""
        if node.class_name == "floor":
            node = self.rooms[self.room_of[node.id]]
        return f"{synset('floor' if node.id in self.rooms else node.class_name)}_{node.id}"

    def facts(self) -> Iterator[str]:
        """Yield the facts at the start."""
        for room in self.rooms.values():
            yield f"(inroom {self.instance(room)} {room.class_name})"
        held = {e.source for e in self.graph.edges if e.relation in ("ON", "INSIDE") and e.target not in self.rooms}
        known = {node.id for node in self.things}
        for source, relation, target in self.graph.edges:
            node, other = self.nodes[source], self.nodes.get(target)
            if source not in known or other is None or relation not in ("ON", "INSIDE"):
                continue
            if target in self.rooms:
                loose = node.class_name == CHARACTER_CLASS or self.knowledge.has(node.class_name, "GRABBABLE")
                place = f"(ontop {self.instance(node)} {self.instance(other)})" if loose and source not in held else ""
                yield place or f"(inroom {self.instance(node)} {other.class_name})"
            elif target in known:
                word = "ontop" if relation == "ON" else "inside"
                yield f"({word} {self.instance(node)} {self.instance(other)})"
        for node in [*self.things, *(node for node in self.graph.nodes if node.class_name == "floor")]:
            usual = self.knowledge.default_states(node.class_name)
            facts = (_state(state, self.instance(node)) for state in node.states)
            yield from (
                fact for state, fact in zip(node.states, facts, strict=True)
                if fact and not (fact.startswith("(not") and state in usual)
            )  # fmt: skip

    def goal(self, goal: Goal, bound: Mapping[str, str]) -> str:
        """Return the expression of a goal."""
        parts = [self._counted(literal, number, bound) for literal, number in goal]
        parts += [self._joined(part, bound) for part in goal.parts]
        return parts[0] if len(parts) == 1 else f"(and {' '.join(parts)})"

    def _joined(self, part: Joined, bound: Mapping[str, str]) -> str:
        if part.join == "or":
            return f"(or {' '.join(self.goal(goal, bound) for goal in part.goals)})"
        if part.join == "not":
            return f"(not {self.goal(part.goals[0], bound)})"
        if part.join in ("exists", "forall", "forn", "forpairs") and part.kind:
            pairs = [(part.variable, part.kind), *([part.other] if part.other[0] else [])]
            names = {variable: self._fresh() for variable, _ in pairs}
            over = " ".join(f"({names[variable]} - {synset(kind)})" for variable, kind in pairs)
            count = f"({part.number}) " if part.join == "forn" else ""
            return f"({part.join} {count}{over} {self.goal(part.goals[0], {**bound, **names})})"
        raise _unsaid(f"`{part.join}` of things of any class" if part.variable else f"`{part.join}`")

    def _counted(self, literal: Literal[Name], number: int, bound: Mapping[str, str]) -> str:
        """Return a literal that must hold of at least a number of things; BDDL says `exactly`."""
        first = literal.terms[0] if literal.terms else ""
        if literal.negated:
            return f"(not {self._counted(literal._replace(negated=False), 1, bound)})"
        if not isinstance(first, str) or first in bound or first.startswith(AGENT) or number == 1:
            return self._some(literal, bound)
        things = sum(node.class_name in self.knowledge.found_as(first) for node in self.things)
        name = self._fresh()
        inner = literal._replace(terms=(name, *literal.terms[1:]))
        body = self._some(inner, {**bound, name: name})
        each = [f"(forn ({k}) ({name} - {synset(first)}) {body})" for k in range(number, max(things, number) + 1)]
        return each[0] if len(each) == 1 else f"(or {' '.join(each)})"

    def _some(self, literal: Literal[Name], bound: Mapping[str, str]) -> str:
        """Return a literal with `exists` for each class among its terms."""
        names: list[str] = []
        over: list[str] = []
        for place, term in enumerate(literal.terms):
            if isinstance(term, int):
                names.append(f"?{self.instance(self.nodes[term])}")
            elif term in bound:
                names.append(bound[term])
            elif self.knowledge.is_room(term) and place == 1:
                return f"(inroom {names[0]} {term})" if not over else f"({over[0]} (inroom {names[0]} {term}))"
            else:
                name = self._fresh()
                over.append(f"exists ({name} - {synset(CHARACTER_CLASS if term == AGENT else term)})")
                names.append(name)
        text = _state(literal.name, names[0]) if len(names) == 1 else _relation(literal.name, names)
        if not text:
            raise _unsaid(str(literal))
        for each in reversed(over):
            text = f"({each} {text})"
        return text

    def _fresh(self) -> str:
        self.count += 1
        return f"?v{self.count}"


def synset(class_name: str) -> str:
    """Return a synset that is read as a class."""
    return f"{AGENT if class_name == CHARACTER_CLASS else class_name}.n.01"


def _state(state: str, name: str) -> str:
    """Return the predicate of a state; "" for a state that BDDL does not have."""
    for predicate, (true, false) in words().states.items():
        if state == true:
            return f"({predicate} {name})"
        if state == false and state:
            return f"(not ({predicate} {name}))"
    for true, false, predicate, substance in SUBSTANCES:
        if state == true:
            return f"({predicate} {name} {substance})"
        if state == false:
            return f"(not ({predicate} {name} {substance}))"
    return ""


def _relation(relation: str, names: list[str]) -> str:
    word = {"ON": "ontop", "INSIDE": "inside", "CLOSE": "nextto"}.get(relation)
    return f"({word} {' '.join(names)})" if word else ""


def _unsaid(what: str) -> HearthError:
    return HearthError.of(Code.NOT_UNDERSTOOD, f"BDDL can't say {what}", suggestion="states and relations at the end")
