"""The goal of a BDDL problem as a goal of ours, exactly, and one way to reach it that a planner can take."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations, permutations
from math import comb, perm
from typing import TypeVar

from hearth.interop.bddl.environment import Activity
from hearth.interop.bddl.expressions import Expression
from hearth.interop.bddl.words import words
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal, Joined
from hearth.schemas.literals import Literal, Name
from hearth.schemas.vocabulary import ROOM_CATEGORY

T = TypeVar("T")

Bound = Mapping[str, str]
"""Variables of BDDL -> instances, or variables of ours, which begin with `?`."""


def goal_of(activity: Activity, knowledge: Knowledge) -> Goal:
    """Return the goal of an activity; things are nodes, and classes where a class has no other things there.

    Raises:
        HearthError: UNKNOWN_OBJECT: it is about a thing that is not in the home; NOT_UNDERSTOOD: a predicate or a word
            is none of ours; both with the line.
    """
    return _Reading(activity, knowledge).goal(activity.problem.goal, {})


MOST_WAYS = 120
"""Alternatives that `forn` and `forpairs` may have where they are written out."""

CHOICES = 3
"""Ways that are tried: see `way_of`."""


def way_of(activity: Activity, knowledge: Knowledge, choice: int = 0) -> Goal:
    """Return literals about nodes that together reach the goal, or come near it.

    Args:
        activity: with its goal.
        knowledge: for classes.
        choice: of alternatives and things: 0 the first ones; 1 the first, the second, the third, ... in turn; 2 the
            last ones.

    Raises:
        HearthError: as `goal_of`.
    """
    reading = _Reading(activity, knowledge)
    reading.choice = choice
    found = list(dict.fromkeys(reading.ways(activity.problem.goal, {}, False)))
    return Goal.of(*dict.fromkeys(_put_near(literal, found, activity, knowledge) for literal in found))


def _put_near(
    literal: Literal[Name], others: Sequence[Literal[Name]], activity: Activity, knowledge: Knowledge
) -> Literal[Name]:
    """Return a literal; of nearness, that the first thing is where the second one is."""
    if literal.name != "CLOSE" or literal.negated:
        return literal
    classes: dict[Name, str] = {node.id: node.class_name for node in activity.graph.nodes}
    one, other = literal.terms
    if not knowledge.has(classes.get(one, ""), "GRABBABLE"):
        one, other = other, one
    placed = [each for each in others if each.name in ("ON", "INSIDE") and len(each.terms) == 2 and not each.negated]
    places = [(each.name, each.terms[1]) for each in placed if each.terms[0] == other]
    edges = [e for e in activity.graph.edges if e.source == other and e.relation in ("ON", "INSIDE")]
    places += [(e.relation, e.target) for e in edges if not knowledge.is_room(classes[e.target])]
    places = [(relation, target) for relation, target in places if classes.get(target) != "floor"]
    relation, target = places[0] if places else ("ON", other)
    return Literal(relation, (one, target))


@dataclass
class _Reading:
    """The reading of one goal."""

    activity: Activity
    knowledge: Knowledge
    rooms: set[int] = field(default_factory=set)
    choice: int = 0
    chosen: int = 0

    def __post_init__(self) -> None:
        self.rooms = {node.id for node in self.activity.graph.nodes if node.category == ROOM_CATEGORY}

    def goal(self, each: Expression, bound: Bound) -> Goal:
        """Return the goal of an expression."""
        head = each.head
        if head == "and" or (not head and len(each.parts) == 1):
            found = Goal()
            for part in each.parts:
                found &= self.goal(part, bound)
            return found
        if head == "or":
            return _joined("or", [self.goal(part, bound) for part in each.parts])
        if head == "imply" and len(each.parts) == 2:
            first, second = (self.goal(part, bound) for part in each.parts)
            return _joined("or", [_negated(first, free=bool(_variables(bound))), second])
        if head == "not" and len(each.parts) == 1:
            return _negated(self.goal(each.parts[0], bound), free=bool(_variables(bound)))
        if head in ("exists", "forall"):
            return self._quantified(each, bound)
        if head in ("forn", "forpairs", "fornpairs"):
            return self._counted(each, bound)
        return Goal.of(self.literal(each, bound))

    def _quantified(self, each: Expression, bound: Bound) -> Goal:
        variable, synset, body = self._over(each.parts[0]), _synset(each.parts[0]), each.parts[-1]
        kind = self._kind(synset)
        if kind and len(_variables(bound)) < 2:
            own = f"?x{len(_variables(bound)) + 1}"
            return Goal(parts=(Joined(each.head, (self.goal(body, {**bound, variable: own}),), own, kind=kind),))
        goals = [self.goal(body, {**bound, variable: name}) for name in self._things(synset, each.line)]
        if each.head == "exists":
            return _joined("or", goals)
        found = Goal()
        for goal in goals:
            found &= goal
        return found

    def _counted(self, each: Expression, bound: Bound) -> Goal:
        """Return `forn`, or `forpairs`, whose things are all things of their classes in the home."""
        lists = each.parts[1:-1] if each.head == "forn" else each.parts[:-1]
        number = each.parts[0].head if each.head == "forn" else ""
        kinds = [self._kind(_synset(one)) for one in lists]
        if not all(kinds) or _variables(bound) or each.head == "fornpairs" or len(lists) > 2:
            return self._one_by_one(each, lists, number, bound)
        own = [f"?x{count}" for count in range(1, len(lists) + 1)]
        inner = {**bound, **{self._over(one): name for one, name in zip(lists, own, strict=True)}}
        other = (own[1], kinds[1]) if len(lists) == 2 else ("", "")
        body = self.goal(each.parts[-1], inner)
        return Goal(parts=(Joined(each.head, (body,), own[0], kind=kinds[0], number=int(number or 0), other=other),))

    def _one_by_one(self, each: Expression, lists: Sequence[Expression], number: str, bound: Bound) -> Goal:
        """Return `forn` or `forpairs` as alternatives about nodes, where their number is small."""
        things = [self._things(_synset(one), each.line) for one in lists]
        goals: list[Goal] = []
        if each.head == "forn" and comb(len(things[0]), int(number)) <= MOST_WAYS:
            free = bool(_variables(bound))
            for chosen in combinations(things[0], int(number)):
                goals.append(Goal())
                for name in things[0]:
                    goal = self.goal(each.parts[-1], {**bound, self._over(lists[0]): name})
                    goals[-1] &= goal if name in chosen else _negated(goal, free=free)
        elif each.head == "forpairs" and perm(*sorted(map(len, things), reverse=True)) <= MOST_WAYS:
            few, many = sorted((0, 1), key=lambda side: len(things[side]))
            names = [self._over(one) for one in lists]
            for chosen in permutations(things[many], len(things[few])):
                goals.append(Goal())
                for one, other in zip(things[few], chosen, strict=True):
                    goals[-1] &= self.goal(each.parts[-1], {**bound, names[few]: one, names[many]: other})
        if not goals:
            raise self._fault(Code.NOT_UNDERSTOOD, f"`{each.head}` over these things can't be said", each.line,
                              f"synsets with fewer things: {MOST_WAYS} ways at most")  # fmt: skip
        return _joined("or", goals)

    def _kind(self, synset: str) -> str:
        """Return the class that all instances of a synset, and no other nodes, are found by; "" without one."""
        nodes = {self._node(name, stateful=True) for name in self.activity.problem.of_synset(synset)}
        name = words().class_of(synset, self.knowledge)
        if not name or None in nodes:
            return ""
        found = {node.id for node in self.activity.graph.nodes if node.class_name in self.knowledge.found_as(name)}
        return name if found == nodes else ""

    def literal(self, each: Expression, bound: Bound) -> Literal[Name]:
        """Return the literal of a predicate that is to hold."""
        return self._literal(each, bound, negated=False)

    def _literal(self, each: Expression, bound: Bound, *, negated: bool) -> Literal[Name]:
        table, terms = words(), [bound.get(word, word.lstrip("?")) for word in each.words]
        if each.head == "inroom" and len(terms) == 2:
            room = self.knowledge.object_class(table.room_of(terms[1], self.knowledge))
            if room is not None:
                return Literal("INSIDE", (self._term(terms[0], each.line), room.name))
        if each.head in table.relations and len(terms) == 2:
            one, other = (self._term(term, each.line) for term in terms)
            relation = "INSIDE" if other in self.rooms else table.relations[each.head]
            return Literal(relation, (one, other))
        if each.head in table.states and len(terms) == 1 and table.states[each.head][negated]:
            return Literal(table.states[each.head][negated], (self._term(terms[0], each.line, stateful=True),))
        if each.head in table.substances and len(terms) == 2:
            kind = table.kind_of(self.activity.problem.instances.get(terms[1], terms[1].lstrip("?")))
            states = table.substances[each.head].get(kind)
            if states is not None:
                return Literal(states[negated], (self._term(terms[0], each.line, stateful=True),))
        raise self._fault(Code.NOT_UNDERSTOOD, f"`{each}` is no goal of ours", each.line, "a predicate of `words.yaml`")

    def _term(self, name: str, line: int, *, stateful: bool = False) -> Name:
        if name.startswith("?"):
            return name
        node = self._node(name, stateful)
        if node is None:
            raise self._fault(Code.UNKNOWN_OBJECT, f"`{name}` is not in the home", line, "a synset of `words.yaml`")
        return node

    def _node(self, name: str, stateful: bool) -> int | None:
        return (self.activity.floors.get(name) if stateful else None) or self.activity.nodes.get(name)

    def _things(self, synset: str, line: int) -> tuple[str, ...]:
        found = self.activity.problem.of_synset(synset)
        if not found:
            raise self._fault(Code.UNKNOWN_OBJECT, f"there is no `{synset}`", line, "an instance in `:objects`")
        return found

    def _over(self, each: Expression) -> str:
        return each.head

    def _fault(self, code: Code, message: str, line: int, suggestion: str) -> HearthError:
        return HearthError(Diagnostic(code, message, self.activity.problem.file, line, suggestion=suggestion))

    def ways(self, each: Expression, bound: Bound, negated: bool) -> Iterator[Literal[Name]]:
        """Yield literals about nodes that reach an expression, or with `negated` its opposite."""
        head, parts = each.head, each.parts
        if head == "not":
            yield from self.ways(parts[0], bound, not negated)
        elif head == "imply":
            yield from self.ways(parts[1], bound, negated)
        elif head in ("and", "or") or (not head and len(parts) == 1):
            for part in parts if (head != "or") != negated else self._some(parts):
                yield from self.ways(part, bound, negated)
        elif head in ("forall", "exists"):
            things = self._things(_synset(parts[0]), each.line)
            every = (head == "forall") != negated
            for name in things if every else self._some(things):
                yield from self.ways(parts[-1], {**bound, parts[0].head: name}, negated)
        elif head == "forn":
            for name in self._things(_synset(parts[1]), each.line)[: int(parts[0].head)]:
                yield from self.ways(parts[-1], {**bound, parts[1].head: name}, negated)
        elif head == "forpairs":
            ones, others = (self._things(_synset(part), each.line) for part in parts[:2])
            for one, other in zip(ones, others, strict=False):
                yield from self.ways(parts[-1], {**bound, parts[0].head: one, parts[1].head: other}, negated)
        else:
            yield self._way(each, bound, negated)

    def _some(self, options: Sequence[T]) -> Sequence[T]:
        """Return the option that this way takes."""
        self.chosen += 1
        number = (0, self.chosen - 1, -1)[self.choice] % len(options)
        return options[number : number + 1]

    def _way(self, each: Expression, bound: Bound, negated: bool) -> Literal[Name]:
        literal = self._literal(each, bound, negated=negated)
        is_state = len(literal.terms) == 1
        return literal if is_state or not negated else literal._replace(negated=True)


def _variables(bound: Bound) -> list[str]:
    return [name for name in bound.values() if name.startswith("?")]


def _synset(each: Expression) -> str:
    """Return the synset of `(?x - synset)`."""
    return each.words[-1] if each.words else ""


def _joined(join: str, goals: list[Goal]) -> Goal:
    return goals[0] if len(goals) == 1 else Goal(parts=(Joined(join, tuple(goals)),))


def _negated(goal: Goal, *, free: bool) -> Goal:
    """Return the opposite of a goal, as `read_goal` reads it: of a literal without variables, a negated literal."""
    match goal.counts:
        case ((literal, 1),) if not free and not goal.parts and not literal.negated:
            return Goal.of(literal._replace(negated=True))
    return Goal(parts=(Joined("not", (goal,)),))
