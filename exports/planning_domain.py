"""The executed actions as a PDDL domain that planners without axioms can read.

`hearth.kb.pddl` writes derived predicates as axioms, which few planners take. Here they are written out where they are
used, and the character is an object of type `agent`. Every thing of a problem has an INSIDE edge to its room from the
start; all actions keep it so, and a room is found without following containers. Left out are two actions (`OMITTED`),
the place that Grab remembers for one of them, and that what is watched must be on, which is an option.

Closed doors stop a walk as in the engine (`Rules.doors`): a problem says by `blocks` which doors part which rooms. To a
door that is closed between the character and the door's own room it walks on its own side (`this-side`: from where, the
room); that is an action of its own here, `WalkToDoor`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import combinations, count

from hearth.kb.formula import TRUE, And, Count, Effect, Formula, Not, Or, Some, Term
from hearth.kb.knowledge import Knowledge
from hearth.kb.pddl import (
    class_predicate,
    limit_predicate,
    named_predicate,
    property_predicate,
    state_predicate,
)
from hearth.kb.records import Action, Requirement
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import PROPERTIES, RELATIONS, STATES

Names = Mapping[str, str]
"""What each variable of a formula is called in PDDL."""

OMITTED = frozenset({"Find", "PutObjBack"})
"""What they do depends on things that problems leave out: what else is near, and where a thing stood. Walk, PutBack and
PutIn do the same."""

TO_DOOR = "WalkToDoor"
"""A Walk in our words."""

WALKS = ("Walk", "Run")

LIMITS = {"seat_limit": "seat-limit", "bed_limit": "bed-limit"}

_BY_PROPERTY = {"property": property_predicate, "class": class_predicate, "class_contains": named_predicate}


def planning_domain(knowledge: Knowledge, actions: Iterable[str] = (), loose: bool = True) -> str:
    """The domain as text.

    Args:
        knowledge: of which the executed actions are written.
        actions: only these; all if none.
        loose: whether to be close to something that is close to a thing, or under it, is to be close to it (semantics:
            the loose rule). Without it there are fewer ways to do a thing, so that a planner decides faster; its plans
            are plans with it, too.
    """
    executed = {name for name, action in knowledge.actions.items() if action.executed} - OMITTED
    wanted = executed & {*actions} or executed
    writer = _Writer(knowledge, loose)
    written = [line for name in sorted(wanted) for line in writer.action(knowledge.actions[name])]
    written += writer.to_door(knowledge.actions["Walk"]) if "Walk" in wanted else []
    lines = [
        "(define (domain hearth)",
        "  (:requirements :adl)",
        "  (:types agent - object)",
        "  (:predicates",
        *(f"    ({name} ?x - object)" for name in unary_predicates(knowledge)),
        *(f"    ({name} ?x - object ?y - object)" for name in binary_predicates()),
        "    (blocks ?d - object ?r - object ?q - object)",
        "    (this-side ?d - object ?r - object ?q - object)",
        "  )",
        *written,
        ")",
    ]
    return "\n".join(lines) + "\n"


def unary_predicates(knowledge: Knowledge) -> list[str]:
    """The predicates of one thing: what it is, which never changes, and its states."""
    found = {"is-room"}
    found.update(map(state_predicate, STATES))
    found.update(map(property_predicate, PROPERTIES))
    for action in knowledge.actions.values():
        for need in action.needs if action.executed else ():
            found.update(map(class_predicate, need.classes | need.also | need.never))
            found.update(map(named_predicate, need.contains))
        literals = (*(c.formula for c in action.preconditions), *(e.condition for e in action.effects))
        found.update(name for literal in literals for name in _named(literal))
    found.update(limit_predicate(word, limit) for kind, word in LIMITS.items() for limit in limits(knowledge, kind))
    return sorted(found)


def binary_predicates() -> list[str]:
    """The relations."""
    return [*map(relation_predicate, RELATIONS)]


def limits(knowledge: Knowledge, kind: str) -> list[int]:
    """The different seat or bed limits."""
    limit = knowledge.seat_limit if kind == "seat_limit" else knowledge.bed_limit
    return sorted({limit(name) for name in knowledge.objects})


def relation_predicate(name: str) -> str:
    """`HOLDS_RH` -> `holds-rh`; CLOSE -> `close-to`, for there is an action Close, and PDDL does not see capitals."""
    return "close-to" if name == "CLOSE" else dashed(name)


def dashed(name: str) -> str:
    """`HOLDS_RH` -> `holds-rh`."""
    return name.lower().replace("_", "-")


def _named(formula: Formula) -> Iterator[str]:
    if isinstance(formula, Literal):
        if formula.name in _BY_PROPERTY:
            yield _BY_PROPERTY[formula.name](formula.terms[1].name)
        return
    for part in formula.parts if isinstance(formula, And | Or) else (formula.part,):
        yield from _named(part)


class _Writer:
    """Writes actions; every bound variable gets a name of its own."""

    def __init__(self, knowledge: Knowledge, loose: bool) -> None:
        self._knowledge = knowledge
        self._loose = loose
        self._on_own_side = False
        self._numbers = count()

    def action(self, action: Action) -> Iterator[str]:
        """One action, the acting character first."""
        stopped = [f"(not {self._stopped()})"] if action.name in WALKS else []
        yield from self._written(action, action.name, stopped)

    def to_door(self, walk: Action) -> list[str]:
        """A walk to a closed door with its room behind it, no other in between: it ends in the room on this side."""
        self._on_own_side = True
        lines = list(self._written(walk, TO_DOOR, [self._stopped_by_itself()]))
        self._on_own_side = False
        return lines

    def _written(self, action: Action, name: str, more: list[str]) -> Iterator[str]:
        self._numbers = count(1)
        self._needs = dict(zip("os", action.needs, strict=False))
        names = {name: f"?{name}" for name in ("a", *"os"[: action.arity])}
        objects = "".join(f" ?{name} - object" for name in "os"[: action.arity])
        before = [self.formula(check.formula, names) for check in action.preconditions if not check.option]
        yield f"  (:action {name}"
        yield f"    :parameters (?a - agent{objects})"
        yield f"    :precondition {_both([*before, *more])}"
        yield "    :effect (and"
        for effect in action.effects:
            for change in self._changes(effect):
                yield f"      {self._effect(change, names)}"
        yield "    ))"

    def _stopped(self) -> str:
        """A closed door parts the character from the object's room."""
        where = "(and (is-closed ?d) (blocks ?d ?r ?q) (inside ?a ?r) (or (= ?o ?q) (inside ?o ?q)))"
        return f"(exists (?d - object ?r - object ?q - object) {where})"

    def _stopped_by_itself(self) -> str:
        """The object is a closed door that parts the character from its room, and no other closed one does."""
        other = "(exists (?d - object) (and (is-closed ?d) (blocks ?d ?r ?q) (not (= ?d ?o))))"
        where = f"(and (inside ?a ?r) (inside ?o ?q) (is-closed ?o) (blocks ?o ?r ?q) (not {other}))"
        return f"(exists (?r - object ?q - object) {where})"

    def formula(self, formula: Formula, names: Names) -> str:
        """A formula, derived predicates written out."""
        if isinstance(formula, Literal):
            text = self._atom(formula, names)
            return f"(not {text})" if formula.negated else text
        if isinstance(formula, Not):
            return f"(not {self.formula(formula.part, names)})"
        if isinstance(formula, And):
            return _both([self.formula(part, names) for part in formula.parts])
        if isinstance(formula, Or):
            return f"(or {' '.join(self.formula(part, names) for part in formula.parts)})"
        if isinstance(formula, Some):
            fresh = self._fresh(formula.variable)
            return _some(fresh, self.formula(formula.part, {**names, formula.variable: fresh}))
        return self._fewer(formula, names)

    def _fresh(self, name: str) -> str:
        return f"?{name}{next(self._numbers)}"

    def _fewer(self, formula: Count, names: Names) -> str:
        """Fewer than n: for each limit that there is, not so many different things."""
        cases = []
        for limit in limits(self._knowledge, formula.limit.function):
            fresh = [self._fresh(formula.variable) for _ in range(limit)]
            each = [self.formula(formula.part, {**names, formula.variable: name}) for name in fresh]
            apart = [f"(not (= {one} {other}))" for one, other in combinations(fresh, 2)]
            many = f"(exists ({' '.join(f'{name} - object' for name in fresh)}) {_both([*each, *apart])})"
            limited = limit_predicate(LIMITS[formula.limit.function], limit)
            cases.append(f"(and ({limited} {names[formula.limit.name]}) (not {many}))")
        return f"(or {' '.join(cases)})"

    def _atom(self, atom: Literal[Term], names: Names) -> str:
        for position, term in enumerate(atom.terms):
            if term.function:
                fresh = self._fresh(term.function[0])
                plain = Literal(atom.name, (*atom.terms[:position], Term(fresh), *atom.terms[position + 1 :]))
                found = self._found(term, names, fresh)
                return _some(fresh, _both([found, self._atom(plain, {**names, fresh: fresh})]))
        if atom.name == "affords":
            return self._need(self._needs[atom.terms[0].name], names[atom.terms[0].name])
        if atom.name in self._knowledge.derived:
            if atom.name == "close" and not self._loose:
                return _plain(Literal("CLOSE", atom.terms), names)
            head, body = self._knowledge.derived[atom.name]
            inner = {mine.name: names[given.name] for mine, given in zip(head.terms, atom.terms, strict=True)}
            return self.formula(body, inner)
        return _plain(atom, names)

    def _found(self, term: Term, names: Names, variable: str) -> str:
        """The condition under which a variable is the thing that a function finds."""
        thing = names[term.name]
        if self._on_own_side and term.name == "o":
            start = self._fresh("from")
            return _some(start, f"(and (inside ?a {start}) (this-side {thing} {start} {variable}))")
        return f"(and (is-room {variable}) (or (= {thing} {variable}) (inside {thing} {variable})))"

    def _need(self, need: Requirement, subject: str) -> str:
        if need.anything:
            return f"(not (is-room {subject}))" if need.no_rooms else "(and )"
        cases = [f"({property_predicate(name)} {subject})" for name in sorted(need.any_of)]
        if need.all_of:
            cases.append(_both([f"({property_predicate(name)} {subject})" for name in sorted(need.all_of)]))
        cases += [f"({class_predicate(name)} {subject})" for name in sorted(need.classes | need.also)]
        cases += [f"({named_predicate(part)} {subject})" for part in need.contains]
        allowed = cases[0] if len(cases) == 1 else f"(or {' '.join(cases)})"
        return _both([allowed, *(f"(not ({class_predicate(name)} {subject}))" for name in sorted(need.never))])

    def _changes(self, effect: Effect) -> Iterator[Effect]:
        """An effect as plain ones: CLOSE both ways, a state with the end of its opposite, nothing of places."""
        literal = effect.literal
        if literal.name == "REMEMBERS" or any(term.function == "place" for term in literal.terms):
            return
        changes = [literal]
        if literal.name == "CLOSE":
            changes.append(literal._replace(terms=literal.terms[::-1]))
        if literal.name == "state" and not literal.negated:
            subject, state = literal.terms
            opposites = (other for other in self._knowledge.excludes(state.name) if other in STATES)
            changes += [Literal("state", (subject, Term(other)), True) for other in opposites]
        for change in changes:
            yield replace(effect, literal=change)

    def _effect(self, effect: Effect, names: Names) -> str:
        bound = {name: self._fresh(name) for name in effect.variables}
        names = {**names, **bound}
        guards = [] if effect.condition == TRUE else [self.formula(effect.condition, names)]
        terms = []
        for term in effect.literal.terms:
            if not term.function:
                terms.append(term)
                continue
            fresh = self._fresh(term.function[0])
            guards.append(self._found(term, names, fresh))
            bound[fresh] = names[fresh] = fresh
            terms.append(Term(fresh))
        text = _plain(effect.literal._replace(terms=tuple(terms)), names)
        text = f"(not {text})" if effect.literal.negated else text
        if guards:
            text = f"(when {_both(guards)} {text})"
        variables = " ".join(f"{name} - object" for name in bound.values())
        return f"(forall ({variables}) {text})" if bound else text


def _plain(atom: Literal[Term], names: Names) -> str:
    first = names[atom.terms[0].name]
    if atom.name in _BY_PROPERTY:
        return f"({_BY_PROPERTY[atom.name](atom.terms[1].name)} {first})"
    if atom.name == "state":
        return f"({state_predicate(atom.terms[1].name)} {first})"
    if atom.name == "is_room":
        return f"(is-room {first})"
    second = f" {names[atom.terms[1].name]}" if len(atom.terms) > 1 else ""
    return f"({'=' if atom.name == 'same' else relation_predicate(atom.name)} {first}{second})"


def _both(parts: list[str]) -> str:
    return parts[0] if len(parts) == 1 else f"(and {' '.join(parts)})"


def _some(variable: str, part: str) -> str:
    return f"(exists ({variable} - object) {part})"
