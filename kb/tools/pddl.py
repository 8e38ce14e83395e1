"""The knowledge as PDDL: how formulas, requirements and effects are written, and the domain of all executed actions.

In that domain places, states and properties become predicates; derived predicates become axioms; what depends on a
found thing (`room(o)`) is stated for every such thing. Where a Grab would remember one of several places, the
domain remembers all of them, its only difference from the engine. A rule that a derived predicate asks for (`option`)
is a predicate without arguments, such as `(option-made-bed)`: problems in which the rule is on state it.

Of action set 3 each process is an action, too: to wait until it is done (`waiting`). In a plan it stands for as many
`Wait` as the process takes ticks. That other processes go on meanwhile is left out, so a plan has to be tried.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from itertools import combinations

from hearth.kb.action_sets import LATEST, states_of_set
from hearth.kb.derived_uses import derived_used
from hearth.kb.formula import GONE, OPTION, TRUE, And, Count, Effect, Formula, Not, Or, Some, Term, free
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action, Condition, Process, Requirement
from hearth.schemas.failures import Code
from hearth.schemas.literals import HANDS, Literal
from hearth.schemas.vocabulary import RELATIONS

Names = Mapping[str, str]
"""Names of a formula's variables in PDDL."""

LIMITS = ("seat_limit", "bed_limit")


def dashed(name: str) -> str:
    """`HOLDS_RH` -> `holds-rh`."""
    return name.lower().replace("_", "-")


_PREFIXES = {"state": "is", "property": "p", "class": "class", "class_contains": "named", "came_from": "came-from"}
"""Literals whose second term is part of the predicate, and how this begins."""


def predicate(name: str, word: str) -> str:
    """`state`, `PLUGGED_IN` -> `is-plugged-in`; `property`, `CAN_OPEN` -> `p-can-open`; see `_PREFIXES`."""
    return f"{_PREFIXES[name]}-{dashed(word)}"


def limit_predicate(kind: str, limit: int) -> str:
    """Return a seat or bed that takes `limit` things -> `seat-limit-4`."""
    return f"{dashed(kind)}-{limit}"


def unary_predicates(knowledge: Knowledge, properties: Iterable[str] = ()) -> list[str]:
    """Return the predicates of one thing, sorted.

    These properties and all that executed actions need, and its states.
    """
    words = {("state", state) for state in states_of_set(knowledge.action_set)} | {
        ("property", name) for name in properties
    }
    formulas = [body for _, body in derived_used(knowledge).values()]
    formulas += [each.condition for each in knowledge.processes.values()] if knowledge.action_set == LATEST else []
    for action in knowledge.actions.values():
        if action.executed:
            formulas += [check.formula for check in action.preconditions]
            formulas += [effect.condition for effect in action.effects]
            for need in action.needs:
                words.update(("property", name) for name in need.any_of | need.all_of)
                words.update(("class", name) for name in need.classes | need.also | need.never)
                words.update(("class_contains", part) for part in need.contains)
    words.update(pair for formula in formulas for pair in _named(formula))
    limits = {limit_predicate(kind, limit) for kind in LIMITS for limit in _limits(knowledge, kind)}
    return sorted({"is-room", *limits, *(predicate(*pair) for pair in words)})


def waiting(knowledge: Knowledge) -> dict[str, Process]:
    """Return the processes by the actions that wait for them, such as `await-kettle-boils`; none of sets 1 and 2."""
    processes = knowledge.processes.values() if knowledge.action_set == LATEST else ()
    return {f"await-{dashed(each.name)}": each for each in processes}


def literals_of(process: Process) -> tuple[Literal[Term], ...]:
    """Return what has to hold while a process goes on."""
    parts = process.condition.parts if isinstance(process.condition, And) else (process.condition,)
    return tuple(part for part in parts if isinstance(part, Literal))


def states_in(formula: Formula) -> Iterator[str]:
    """Yield the states that a formula asks for, or asks to be absent."""
    if isinstance(formula, Literal):
        if formula.name == "state":
            yield formula.terms[1].name
        return
    for part in formula.parts if isinstance(formula, And | Or) else (formula.part,):
        yield from states_in(part)


def _wait(name: str, process: Process) -> Action:
    """Return waiting for a process as an action on the thing and its device."""
    names = {"x": "o", "d": "s"}

    def renamed(literal: Literal[Term]) -> Literal[Term]:
        return literal._replace(terms=tuple(replace(t, name=names.get(t.name, t.name)) for t in literal.terms))

    checks = tuple(Condition(renamed(part), Code.WRONG_STATE) for part in literals_of(process))
    effects = tuple(replace(each, literal=renamed(each.literal)) for each in process.effects)
    roles = ("thing", "device")[: len(free(process.condition))]
    anything = Requirement(anything=True)
    return Action(name, -1, True, roles, tuple(anything for _ in roles), (), checks, effects, name)


def option_predicate(name: str) -> str:
    """`made_bed` -> `option-made-bed`: a fact of a problem whose executions use that rule."""
    return f"{OPTION}-{dashed(name)}"


def options(knowledge: Knowledge) -> list[str]:
    """Return the names of the rules that derived predicates and effects ask for, sorted."""
    formulas = [body for _, body in derived_used(knowledge).values()]
    formulas += [effect.condition for action in knowledge.actions.values() for effect in action.effects]
    return sorted({name for formula in formulas for name in _asked(formula)})


def _asked(formula: Formula) -> Iterator[str]:
    if isinstance(formula, Literal):
        if formula.name == OPTION:
            yield formula.terms[0].name
        return
    for part in formula.parts if isinstance(formula, And | Or) else (formula.part,):
        yield from _asked(part)


def _named(formula: Formula) -> Iterator[tuple[str, str]]:
    """Yield the properties and classes that a formula names."""
    if isinstance(formula, Literal):
        if formula.name in ("property", "class", "class_contains"):
            yield formula.name, formula.terms[1].name
        return
    for part in formula.parts if isinstance(formula, And | Or) else (formula.part,):
        yield from _named(part)


def _limits(knowledge: Knowledge, kind: str) -> list[int]:
    limit = knowledge.seat_limit if kind == "seat_limit" else knowledge.bed_limit
    return sorted({limit(name) for name in knowledge.objects})


def both(parts: list[str]) -> str:
    """All of some formulas; one stands alone."""
    return parts[0] if len(parts) == 1 else f"(and {' '.join(parts)})"


class Writer(ABC):
    """Writes actions. A subclass defines functions, derived predicates and the names of variables."""

    agent = typed = ""
    """The types of a character and of other things, as ` - object`."""

    def __init__(self, knowledge: Knowledge) -> None:
        self.knowledge = knowledge
        self._needs: dict[str, Requirement] = {}

    def fresh(self, name: str, number: object = "") -> str:
        """Return a variable that a formula binds."""
        return f"?{name}{number}"

    def both(self, parts: list[str]) -> str:
        """All of the parts of a conjunction."""
        return both(parts)

    @abstractmethod
    def found(self, term: Term, names: Names, variable: str) -> str:
        """Return the condition under which a variable is the thing that a function finds."""

    @abstractmethod
    def derived(self, literal: Literal[Term], names: Names) -> str:
        """Return a derived predicate of some terms."""

    def relation(self, name: str) -> str:
        """`HOLDS_RH` -> `holds-rh`."""
        return dashed(name)

    def action(self, action: Action, name: str = "", more: Iterable[str] = ()) -> Iterator[str]:
        """Yield the lines of one action, the acting character first.

        Args:
            action: to write. Preconditions that depend on an option are left out.
            name: what it is called, if otherwise.
            more: preconditions.
        """
        variables = "os"[: action.arity]
        self._needs = dict(zip("os", action.needs, strict=False))
        names = {variable: f"?{variable}" for variable in ("a", *variables)}
        before = [self.formula(check.formula, names) for check in action.preconditions if not check.option]
        yield f"  (:action {name or action.name}"
        yield f"    :parameters (?a{self.agent}{''.join(f' ?{variable}{self.typed}' for variable in variables)})"
        yield f"    :precondition {self.both([*before, *more])}"
        yield "    :effect (and"
        yield from (f"      {self._effect(change, names)}" for each in action.effects for change in self.changes(each))
        yield "    ))"

    def wait(self, name: str, process: Process) -> Iterator[str]:
        """Yield the lines of the action that waits for a process."""
        return self.action(_wait(name, process))

    def formula(self, formula: Formula, names: Names) -> str:
        """Return a formula whose free variables have these names."""
        if isinstance(formula, Literal):
            text = self._literal(formula, names)
            return f"(not {text})" if formula.negated else text
        if isinstance(formula, Not):
            return f"(not {self.formula(formula.part, names)})"
        if isinstance(formula, And):
            return self.both([self.formula(part, names) for part in formula.parts])
        if isinstance(formula, Or):
            return f"(or {' '.join(self.formula(part, names) for part in formula.parts)})"
        if isinstance(formula, Some):
            fresh = self.fresh(formula.variable)
            return self.some([fresh], self.formula(formula.part, {**names, formula.variable: fresh}))
        return self._fewer(formula, names)

    def some(self, variables: Iterable[str], part: str) -> str:
        """There are such things."""
        return f"(exists ({' '.join(f'{name}{self.typed}' for name in variables)}) {part})"

    def _fewer(self, formula: Count, names: Names) -> str:
        """Fewer than n: for each limit n there is, not n different things; classes say which limit is theirs."""
        kind, cases = formula.limit.function, []
        for limit in _limits(self.knowledge, kind):
            fresh = [self.fresh(formula.variable, number) for number in range(1, limit + 1)]
            each = [self.formula(formula.part, {**names, formula.variable: name}) for name in fresh]
            apart = [f"(not (= {one} {other}))" for one, other in combinations(fresh, 2)]
            many = self.some(fresh, self.both([*each, *apart]))
            cases.append(f"(and ({limit_predicate(kind, limit)} {names[formula.limit.name]}) (not {many}))")
        return f"(or {' '.join(cases)})"

    def _literal(self, literal: Literal[Term], names: Names) -> str:
        """Return a literal, whether or not it is negated.

        One about a found thing holds of some thing that is found so.
        """
        for position, term in enumerate(literal.terms):
            if term.function:
                fresh = self.fresh(term.function[0], position)
                plain = (*literal.terms[:position], Term(fresh), *literal.terms[position + 1 :])
                found = self.found(term, names, fresh)
                inner = self._literal(literal._replace(terms=plain), {**names, fresh: fresh})
                return self.some([fresh], f"(and {found} {inner})")
        if literal.name == "affords":
            return self._need(self._needs[literal.terms[0].name], names[literal.terms[0].name])
        if literal.name in self.knowledge.derived:
            return self.derived(literal, names)
        return self.plain(literal, names)

    def plain(self, literal: Literal[Term], names: Names) -> str:
        """Return a literal about things that have names."""
        first, *second = literal.terms
        if literal.name == OPTION:
            return f"({option_predicate(first.name)})"
        if literal.name in _PREFIXES:
            return f"({predicate(literal.name, second[0].name)} {names[first.name]})"
        word = "=" if literal.name == "same" else self.relation(literal.name)
        return f"({' '.join([word, *(names[term.name] for term in literal.terms)])})"

    def _need(self, need: Requirement, subject: str) -> str:
        if need.anything:
            return f"(not (is-room {subject}))" if need.no_rooms else self.both([])
        any_of, all_of, classes, never = (
            [f"({predicate(kind, name)} {subject})" for name in sorted(names)]
            for kind, names in (
                ("property", need.any_of),
                ("property", need.all_of),
                ("class", need.classes | need.also),
                ("class", need.never),
            )
        )
        named = [f"({predicate('class_contains', part)} {subject})" for part in need.contains]
        cases = [*any_of, *([self.both(all_of)] if all_of else []), *classes, *named]
        allowed = cases[0] if len(cases) == 1 else f"(or {' '.join(cases)})"
        return both([allowed, *(f"(not {each})" for each in never)])

    def changes(self, effect: Effect) -> Iterator[Effect]:
        """Yield an effect as one or more: CLOSE both ways, a state with the end of its opposite."""
        literal = effect.literal
        if literal.name == GONE:
            yield from self._gone(effect)
            return
        yield effect
        if literal.name == "CLOSE":
            yield replace(effect, literal=literal._replace(terms=literal.terms[::-1]))
        if literal.name == "state" and not literal.negated:
            subject, state = literal.terms
            opposites = (
                other
                for other in self.knowledge.excludes(state.name)
                if other in states_of_set(self.knowledge.action_set)
            )
            yield from (replace(effect, literal=Literal("state", (subject, Term(each)), True)) for each in opposites)

    @staticmethod
    def _gone(effect: Effect) -> Iterator[Effect]:
        """Yield the effects of `gone`: a thing that is used up is in no place and in no hand, and close to nothing."""
        thing, anything = effect.literal.terms[0], Term("anything")
        yield replace(effect, literal=Literal("state", (thing, Term("GONE"))))
        pairs = [(name, (thing, anything)) for name in ("ON", "INSIDE", "CLOSE", "FACING")]
        pairs += [(name, (anything, thing)) for name in ("CLOSE", *HANDS)]
        for name, terms in pairs:
            literal = Literal(name, terms, negated=True)
            yield replace(effect, literal=literal, variables=(*effect.variables, anything.name))

    def _effect(self, effect: Effect, names: Names) -> str:
        """One change under its variables and condition, found things turned into variables of their own."""
        bound = {name: self.fresh(name) for name in effect.variables}
        names = {**names, **bound}
        guards = [] if effect.condition == TRUE else [self.formula(effect.condition, names)]
        terms = list(effect.literal.terms)
        for number, term in enumerate(terms):
            if term.function:
                fresh = self.fresh(term.function[0], number)
                guards.append(self.found(term, names, fresh))
                bound[fresh] = names[fresh] = fresh
                terms[number] = Term(fresh)
        text = self.plain(effect.literal._replace(terms=tuple(terms)), names)
        text = f"(not {text})" if effect.literal.negated else text
        text = f"(when {both(guards)} {text})" if guards else text
        return f"(forall ({' '.join(f'{name}{self.typed}' for name in bound.values())}) {text})" if bound else text


def domain(knowledge: Knowledge, name: str = "hearth") -> str:
    """Return the domain as text: predicates, axioms, and one action for each that is executed."""
    writer, axioms = _AxiomWriter(knowledge), {}
    for head, body in derived_used(knowledge).values():
        names = {term.name: f"?{term.name}" for term in head.terms}
        axioms[writer.derived(head, names)] = writer.formula(body, names)
    lines = [
        f"(define (domain {name})",
        "  (:requirements :adl :derived-predicates)",
        "  (:predicates",
        *(f"    ({option_predicate(name)})" for name in options(knowledge)),
        *(f"    ({name} ?x)" for name in unary_predicates(knowledge)),
        *(f"    ({name} ?x ?y)" for name in sorted({*map(dashed, RELATIONS), "remembers"})),
        "    (came-from-inside ?x)",
        "    (came-from-on ?x)",
        *(f"    {head}" for head in ("(in-room ?x ?r)", "(place ?x ?p)", *axioms)),
        "  )",
        _PLACES,
        *(f"  (:derived {head}\n    {body})" for head, body in axioms.items()),
        *(line for action in knowledge.actions.values() if action.executed for line in writer.action(action)),
        *(line for name, process in waiting(knowledge).items() for line in writer.wait(name, process)),
        ")",
    ]
    return "\n".join(lines) + "\n"


_PLACES = """\
  (:derived (in-room ?x ?r)
    (and (is-room ?r) (or (= ?x ?r) (inside ?x ?r) (exists (?y) (and (inside ?x ?y) (in-room ?y ?r))))))
  (:derived (place ?x ?p)
    (and (not (is-room ?p)) (or (on ?x ?p)
      (and (inside ?x ?p) (not (exists (?q) (and (on ?x ?q) (not (is-room ?q))))))
      (and (close ?x ?p) (not (exists (?q) (and (on ?x ?q) (not (is-room ?q)))))\
 (not (exists (?q) (and (inside ?x ?q) (not (is-room ?q)))))))))"""
"""Results of the functions `room` and `place`."""


class _AxiomWriter(Writer):
    """Derived predicates are axioms of the domain, and variables keep their names."""

    def both(self, parts: list[str]) -> str:
        """All of the parts of a conjunction."""
        return f"(and {' '.join(parts)})" if parts else "(and)"

    def found(self, term: Term, names: Names, variable: str) -> str:
        """Return the condition under which a variable is the thing that a function finds."""
        name = {"room": "in-room", "origin": "remembers", "place": "place"}[term.function]
        return f"({name} {names[term.name]} {variable})"

    def derived(self, literal: Literal[Term], names: Names) -> str:
        """Its axiom's head, which differs from relations in more than case, which PDDL ignores: loosely-close."""
        name = f"loosely-{dashed(literal.name)}" if literal.name.upper() in RELATIONS else dashed(literal.name)
        return f"({' '.join([name, *(names[term.name] for term in literal.terms)])})"

    def changes(self, effect: Effect) -> Iterator[Effect]:
        """Yield an effect as one or more; Grab remembers the place and how the thing was there, Drop forgets both."""
        literal = effect.literal
        if literal.name != "REMEMBERS":
            yield from super().changes(effect)
            return
        thing, forgotten = literal.terms[0], literal.negated
        every = replace(effect, literal=literal._replace(terms=(thing, Term("p"))), variables=(*effect.variables, "p"))
        yield every if forgotten else effect
        on, inside = (_somewhere(thing, relation) for relation in ("ON", "INSIDE"))
        for relation, so in (("ON", on), ("INSIDE", And((inside, Not(on))))):
            came = replace(effect, literal=Literal("came_from", (thing, Term(relation)), forgotten))
            yield came if forgotten else replace(came, condition=so)


def _somewhere(thing: Term, relation: str) -> Formula:
    """Return a thing is ON or INSIDE something that is not a room."""
    place = Term("q")
    return Some("q", And((Literal(relation, (thing, place)), Literal("is_room", (place,), True))))
