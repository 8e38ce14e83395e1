"""The executed actions as a PDDL domain, written from their literals.

Places, states and properties become predicates; derived predicates become axioms; what depends on a found thing
(`room(o)`) is said of every thing that is found so. Where a Grab would remember one of several places, the domain
remembers all of them, which is the only way it differs from the engine.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from hearth.kb.formula import FUNCTIONS, TRUE, And, Count, Effect, Formula, Not, Or, Some, Term
from hearth.kb.knowledge import Knowledge
from hearth.kb.records import Action, Requirement
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import RELATIONS, STATES

REQUIREMENTS = (":adl", ":derived-predicates")


def domain(knowledge: Knowledge, name: str = "hearth") -> str:
    """The domain as text: predicates, axioms, and one action for each that is executed.

    Preconditions that depend on an option are left out. The acting character is the first parameter.
    """
    actions = [action for action in knowledge.actions.values() if action.executed]
    parts = [
        f"(define (domain {name})",
        f"  (:requirements {' '.join(REQUIREMENTS)})",
        "  (:predicates",
        *(f"    {line}" for line in _predicates(knowledge, actions)),
        "  )",
        *_axioms(knowledge),
        *(line for action in actions for line in _action(knowledge, action)),
        ")",
    ]
    return "\n".join(parts) + "\n"


def state_predicate(state: str) -> str:
    """`PLUGGED_IN` -> `is-plugged-in`."""
    return f"is-{_dashed(state)}"


def property_predicate(prop: str) -> str:
    """`CAN_OPEN` -> `p-can-open`."""
    return f"p-{_dashed(prop)}"


def class_predicate(name: str) -> str:
    """`hands_both` -> `class-hands-both`."""
    return f"class-{_dashed(name)}"


def named_predicate(part: str) -> str:
    """A class with `knife` in its name -> `named-knife`."""
    return f"named-{_dashed(part)}"


def limit_predicate(kind: str, limit: int) -> str:
    """A seat or bed that takes `limit` things -> `seat-limit-4`."""
    return f"{_dashed(kind)}-{limit}"


def _predicates(knowledge: Knowledge, actions: Iterable[Action]) -> list[str]:
    unary = {"is-room", *map(state_predicate, STATES)}
    for action in actions:
        for need in action.needs:
            unary.update(_need_predicates(need))
        for literal in (*(c.formula for c in action.preconditions), *(e.condition for e in action.effects)):
            unary.update(_named_predicates(literal))
    for _, body in knowledge.derived.values():
        unary.update(_named_predicates(body))
    unary |= {
        limit_predicate(kind, limit) for kind in ("seat_limit", "bed_limit") for limit in _limits(knowledge, kind)
    }
    binary = {_dashed(relation) for relation in RELATIONS} | {"remembers", "same"}
    binary |= {f"came-from-{_dashed(relation)}" for relation in ("ON", "INSIDE")} - binary
    lines = [f"({name} ?x)" for name in sorted(unary)]
    lines += [f"({name} ?x ?y)" for name in sorted(binary) if name != "same" and not name.startswith("came-from")]
    lines += [f"({name} ?x)" for name in sorted(binary) if name.startswith("came-from")]
    heads = [atom for atom, _ in knowledge.derived.values()]
    return [*lines, "(in-room ?x ?r)", "(place ?x ?p)", *(_head(atom) for atom in heads)]


def _need_predicates(need: Requirement) -> set[str]:
    return {
        *(property_predicate(name) for name in need.any_of | need.all_of),
        *(class_predicate(name) for name in need.classes),
        *(named_predicate(part) for part in need.contains),
    }


def _named_predicates(formula: Formula) -> Iterator[str]:
    """The one-place predicates a formula uses for properties and classes."""
    if isinstance(formula, Literal):
        makers = {"property": property_predicate, "class": class_predicate, "class_contains": named_predicate}
        if formula.name in makers:
            yield makers[formula.name](formula.terms[1].name)
        return
    for part in formula.parts if isinstance(formula, And | Or) else (formula.part,):
        yield from _named_predicates(part)


def _limits(knowledge: Knowledge, kind: str) -> list[int]:
    limit = knowledge.seat_limit if kind == "seat_limit" else knowledge.bed_limit
    return sorted({limit(name) for name in knowledge.objects})


def _axioms(knowledge: Knowledge) -> Iterator[str]:
    yield "  (:derived (in-room ?x ?r)"
    yield "    (and (is-room ?r) (or (= ?x ?r) (inside ?x ?r) (exists (?y) (and (inside ?x ?y) (in-room ?y ?r))))))"
    yield "  (:derived (place ?x ?p)"
    on, inside = (f"(exists (?q) (and ({name} ?x ?q) (not (is-room ?q))))" for name in ("on", "inside"))
    yield "    (and (not (is-room ?p)) (or (on ?x ?p)"
    yield f"      (and (inside ?x ?p) (not {on}))"
    yield f"      (and (close ?x ?p) (not {on}) (not {inside})))))"
    for atom, body in knowledge.derived.values():
        yield f"  (:derived {_head(atom)}"
        yield f"    {_formula(knowledge, body, None)})"


def _head(atom: Literal[Term]) -> str:
    return f"({_derived(atom.name)} {' '.join(f'?{term.name}' for term in atom.terms)})"


def _derived(name: str) -> str:
    """Derived predicates differ from relations in more than case, which PDDL does not see: close -> near-close."""
    dashed = _dashed(name)
    return f"loosely-{dashed}" if name.upper() in RELATIONS else dashed


def _action(knowledge: Knowledge, action: Action) -> Iterator[str]:
    checks = [c.formula for c in action.preconditions if not c.option]
    before = " ".join(_formula(knowledge, formula, action) for formula in checks)
    parameters = " ".join(f"?{name}" for name in ("a", *"os"[: action.arity]))
    yield f"  (:action {action.name}"
    yield f"    :parameters ({parameters})"
    yield f"    :precondition (and {before})".replace("(and )", "(and)")
    yield "    :effect (and"
    for effect in action.effects:
        for text in _effects(knowledge, effect, action):
            yield f"      {text}"
    yield "    ))"


def _effects(knowledge: Knowledge, effect: Effect, action: Action) -> Iterator[str]:
    """An effect as one or more PDDL effects: symmetric ones twice, a state with the end of its opposite."""
    literal = effect.literal
    changes = [literal]
    if literal.name == "CLOSE":
        changes.append(literal._replace(terms=literal.terms[::-1]))
    if literal.name == "state" and not literal.negated:
        subject, state = literal.terms
        changes += [Literal("state", (subject, Term(other)), True) for other in knowledge.excludes(state.name)]
    if literal.name == "REMEMBERS":
        changes = list(_memory(literal))
    for change in changes:
        yield _quantified(knowledge, replace(effect, literal=change), action)


def _memory(literal: Literal[Term]) -> Iterator[Literal[Term]]:
    """What Grab remembers and Drop forgets: the place, and how the thing was there."""
    thing, negated = literal.subject, literal.negated
    yield Literal("REMEMBERS", (thing, Term("p")), True) if negated else literal
    for relation in ("ON", "INSIDE"):
        yield Literal("came_from", (thing, Term(relation)), negated)


def _quantified(knowledge: Knowledge, effect: Effect, action: Action) -> str:
    """One change under its variables and condition, found things turned into variables of their own."""
    literal = effect.literal
    variables = list(effect.variables)
    guards = [] if effect.condition == TRUE else [_formula(knowledge, effect.condition, action)]
    terms: list[Term] = []
    for number, term in enumerate(literal.terms):
        if term.function:
            fresh = f"{term.function[0]}{number}"
            variables.append(fresh)
            guards.append(_found(term, fresh))
            terms.append(Term(fresh))
        else:
            terms.append(term)
    if literal.name == "REMEMBERS" and literal.negated:
        variables.append("p")
    if literal.name == "came_from" and not literal.negated:
        guards.append(_came(literal))
    text = _plain(literal.name, tuple(terms))
    text = f"(not {text})" if literal.negated else text
    if guards:
        guard = guards[0] if len(guards) == 1 else f"(and {' '.join(guards)})"
        text = f"(when {guard} {text})"
    return f"(forall ({' '.join(f'?{name}' for name in variables)}) {text})" if variables else text


def _came(atom: Literal[Term]) -> str:
    thing, relation = atom.terms[0].name, _dashed(atom.terms[1].name)
    there = f"(exists (?q) (and ({relation} ?{thing} ?q) (not (is-room ?q))))"
    if relation == "on":
        return there
    return f"(and {there} (not (exists (?q) (and (on ?{thing} ?q) (not (is-room ?q))))))"


def _found(term: Term, variable: str) -> str:
    """The condition under which a variable is the thing that a function finds."""
    name = {"room": "in-room", "origin": "remembers", "place": "place"}[term.function]
    return f"({name} ?{term.name} ?{variable})"


def _plain(name: str, terms: tuple[Term, ...]) -> str:
    if name == "state":
        return f"({state_predicate(terms[1].name)} ?{terms[0].name})"
    if name == "came_from":
        return f"(came-from-{_dashed(terms[1].name)} ?{terms[0].name})"
    return f"({_dashed(name)} {' '.join(f'?{term.name}' for term in terms)})"


def _formula(knowledge: Knowledge, formula: Formula, action: Action | None) -> str:
    if isinstance(formula, Literal):
        text = _atom(formula, action, knowledge)
        return f"(not {text})" if formula.negated else text
    if isinstance(formula, Not):
        return f"(not {_formula(knowledge, formula.part, action)})"
    if isinstance(formula, And | Or):
        word = "and" if isinstance(formula, And) else "or"
        return f"({word} {' '.join(_formula(knowledge, part, action) for part in formula.parts)})"
    if isinstance(formula, Some):
        return f"(exists (?{formula.variable}) {_formula(knowledge, formula.part, action)})"
    return _fewer(knowledge, formula, action)


def _fewer(knowledge: Knowledge, formula: Count, action: Action | None) -> str:
    """Fewer than n: for each limit n there is, not n different things; classes say which limit is theirs."""
    subject, kind = formula.limit.name, formula.limit.function
    cases = []
    for limit in _limits(knowledge, kind):
        names = [f"{formula.variable}{number}" for number in range(1, limit + 1)]
        each = [_formula(knowledge, _renamed(formula.part, formula.variable, name), action) for name in names]
        apart = [f"(not (= ?{x} ?{y}))" for i, x in enumerate(names) for y in names[i + 1 :]]
        many = f"(exists ({' '.join(f'?{name}' for name in names)}) (and {' '.join([*each, *apart])}))"
        cases.append(f"(and ({limit_predicate(kind, limit)} ?{subject}) (not {many}))")
    return f"(or {' '.join(cases)})"


def _renamed(formula: Formula, old: str, new: str) -> Formula:
    if not isinstance(formula, Literal):
        raise TypeError("only plain facts are counted")
    return formula._replace(terms=tuple(Term(new) if term.name == old else term for term in formula.terms))


def _atom(atom: Literal[Term], action: Action | None, knowledge: Knowledge) -> str:
    """An atom; one about a found thing holds of some thing that is found so."""
    for position, term in enumerate(atom.terms):
        if term.function in FUNCTIONS:
            fresh = f"{term.function[0]}{position}"
            inner = Literal(atom.name, (*atom.terms[:position], Term(fresh), *atom.terms[position + 1 :]))
            return f"(exists (?{fresh}) (and {_found(term, fresh)} {_atom(inner, action, knowledge)}))"
    first = f"?{atom.terms[0].name}"
    named = {"property": property_predicate, "class": class_predicate, "class_contains": named_predicate}
    if atom.name in named:
        return f"({named[atom.name](atom.terms[1].name)} {first})"
    if atom.name == "same":
        return f"(= {first} ?{atom.terms[1].name})"
    if atom.name == "affords" and action is not None:
        return _need(action.needs["os".index(atom.terms[0].name)], first)
    if atom.name in knowledge.derived:
        return f"({_derived(atom.name)} {' '.join(f'?{term.name}' for term in atom.terms)})"
    return _plain(atom.name, atom.terms)


def _need(need: Requirement, subject: str) -> str:
    if need.anything:
        return f"(not (is-room {subject}))" if need.no_rooms else "(and)"
    cases = [f"({property_predicate(name)} {subject})" for name in sorted(need.any_of)]
    if need.all_of:
        cases.append(f"(and {' '.join(f'({property_predicate(name)} {subject})' for name in sorted(need.all_of))})")
    cases += [f"({class_predicate(name)} {subject})" for name in sorted(need.classes | need.also)]
    cases += [f"({named_predicate(part)} {subject})" for part in need.contains]
    return cases[0] if len(cases) == 1 else f"(or {' '.join(cases)})"


def _dashed(name: str) -> str:
    return name.lower().replace("_", "-")
