"""Literals of preconditions and effects read in a world: the slow, plain reading of them.

Any world that can answer the few questions of `View` can be asked. The engine's own functions are fast and written
by hand; tests hold them against this reading.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Protocol

from hearth.kb.formula import And, Count, Effect, Formula, Not, Or, Some, Term, free
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action, Condition
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import RELATIONS

Binding = Mapping[str, int]
"""Variable -> node id: `a` the acting character, `o` and `s` the first and second object."""

Memory = tuple[str, int]
"""The place from which a thing was grabbed: relation and node."""

Fact = tuple[str, int, int | str]
"""`(relation, source, target)` or `("state", node, name)`."""


class View(Protocol):
    """The questions the literals ask of a world. Nodes are known by their ids."""

    def nodes(self) -> Iterable[int]:
        """Every node."""

    def targets(self, relation: str, source: int) -> Iterable[int]:
        """The nodes to which `source` stands in the relation."""

    def sources(self, relation: str, target: int) -> Iterable[int]:
        """The nodes that stand in the relation to `target`."""

    def has_state(self, node: int, state: str) -> bool:
        """Return whether the node is in the state."""

    def properties(self, node: int) -> frozenset[str]:
        """The node's properties."""

    def class_name(self, node: int) -> str:
        """The node's class."""

    def is_room(self, node: int) -> bool:
        """Return whether the node is a room."""

    def room(self, node: int) -> int | None:
        """The room itself, or the room reached along INSIDE, directly or through containers; None without one."""

    def origin(self, node: int) -> Memory | None:
        """Return the place from which the thing was grabbed, if that is remembered."""

    def place(self, node: int) -> Memory | None:
        """Return the place that would be remembered as the thing's origin if it were grabbed now."""


@dataclass(frozen=True, slots=True)
class Changes:
    """The changes of an action: first `removed` stops holding, then `added` holds.

    CLOSE is among them both ways. `remembered` says where things were grabbed from now, None for what is forgotten.
    """

    removed: frozenset[Fact]
    added: frozenset[Fact]
    remembered: Mapping[int, Memory | None] = field(default_factory=dict)
    gone: frozenset[int] = frozenset()


def first_failure(
    knowledge: Knowledge, view: View, action: Action, binding: Binding, options: frozenset[str] = frozenset()
) -> Condition | None:
    """The first check before the action that does not hold, or None when it can be done.

    Checks that depend on an option are made when it is among `options`, which are those that `option` asks for too.
    """
    reading = _Reading(knowledge, view, action, options)
    for condition in action.preconditions:
        if condition.option and condition.option not in options:
            continue
        if not reading.holds(condition.formula, dict(binding)):
            return condition
    return None


def changes(
    knowledge: Knowledge, view: View, action: Action, binding: Binding, options: frozenset[str] = frozenset()
) -> Changes:
    """Return the changes that the action makes in this world, by these options; its preconditions need not hold."""
    reading = _Reading(knowledge, view, action, options)
    draft = _Draft(reading)
    for effect in action.effects:
        for bound in reading.solutions(effect, dict(binding)):
            draft.note(effect, bound)
    gone = frozenset(draft.gone)
    return Changes(frozenset(draft.removed - draft.added), frozenset(draft.added), draft.remembered, gone)


def holds(knowledge: Knowledge, view: View, formula: Formula, binding: Binding, action: Action | None = None) -> bool:
    """Return whether the formula holds of the world; `affords` needs the action it is about."""
    return _Reading(knowledge, view, action).holds(formula, dict(binding))


class _Draft:
    """Changes being gathered; one about a thing that does not exist is left out."""

    def __init__(self, reading: _Reading) -> None:
        self.reading = reading
        self.removed: set[Fact] = set()
        self.added: set[Fact] = set()
        self.remembered: dict[int, Memory | None] = {}
        self.gone: set[int] = set()

    def note(self, effect: Effect, bound: Mapping[str, int]) -> None:
        """Add what one effect changes under one binding."""
        name, terms, delete = effect.literal
        first = self.reading.thing(terms[0], bound)
        if first is None:
            return
        if name == "gone":
            self.gone.add(first)
        elif name == "REMEMBERS":
            self.remembered[first] = None if delete else self.reading.view.place(first)
        elif name == "state":
            self._state(first, terms[1].name, delete)
        else:
            second = self.reading.thing(terms[1], bound)
            if second is not None:
                self._edge(name, first, second, delete)

    def _state(self, node: int, name: str, delete: bool) -> None:
        (self.removed if delete else self.added).add(("state", node, name))
        if not delete:
            self.removed.update(("state", node, other) for other in self.reading.knowledge.excludes(name))

    def _edge(self, relation: str, first: int, second: int, delete: bool) -> None:
        into = self.removed if delete else self.added
        into.add((relation, first, second))
        if relation == "CLOSE":
            into.add((relation, second, first))


class _Reading:
    """One action's literals read in one world."""

    def __init__(
        self, knowledge: Knowledge, view: View, action: Action | None, options: frozenset[str] = frozenset()
    ) -> None:
        self.knowledge = knowledge
        self.view = view
        self.action = action
        self.options = options

    def thing(self, term: Term, bound: Mapping[str, int]) -> int | None:
        """The node a term means, or None."""
        node = bound[term.name]
        if not term.function:
            return node
        if term.function == "room":
            return self.view.room(node)
        memory = self.view.origin(node) if term.function == "origin" else self.view.place(node)
        return memory[1] if memory else None

    def solutions(self, effect: Effect, bound: dict[str, int]) -> Iterator[dict[str, int]]:
        """The bindings under which an effect takes place."""
        conjuncts = effect.condition.parts if isinstance(effect.condition, And) else (effect.condition,)
        subject = effect.literal.atom if effect.literal.negated else None
        yield from self._extend(list(effect.variables), list(_flat(conjuncts)), subject, bound)

    def _extend(
        self, variables: list[str], conjuncts: list[Formula], deleted: Literal[Term] | None, bound: dict[str, int]
    ) -> Iterator[dict[str, int]]:
        """Bind the variables one after the other, checking each conjunct as soon as all it mentions is bound."""
        waiting = [part for part in conjuncts if free(part) - bound.keys()]
        if not all(self.holds(part, bound) for part in conjuncts if part not in waiting):
            return
        if not variables:
            yield dict(bound)
            return
        variable, *rest = variables
        helpful = [*waiting, deleted] if deleted else waiting  # deleting what is not there changes nothing
        for node in self._candidates(variable, helpful, bound):
            yield from self._extend(rest, waiting, deleted, {**bound, variable: node})

    def holds(self, formula: Formula, bound: Mapping[str, int]) -> bool:
        """Return whether a formula holds under a binding of its variables."""
        if isinstance(formula, Literal):
            return self._atom(formula, bound) != formula.negated
        if isinstance(formula, Not):
            return not self.holds(formula.part, bound)
        if isinstance(formula, And):
            return all(self.holds(part, bound) for part in formula.parts)
        if isinstance(formula, Or):
            return any(self.holds(part, bound) for part in formula.parts)
        nodes = self._candidates(formula.variable, _flat((formula.part,)), bound)
        hits = (node for node in nodes if self.holds(formula.part, {**bound, formula.variable: node}))
        if isinstance(formula, Some):
            return next(hits, None) is not None
        return sum(1 for _ in hits) < self._limit(formula, bound)

    def _limit(self, formula: Count, bound: Mapping[str, int]) -> int:
        name = self.view.class_name(bound[formula.limit.name])
        return (
            self.knowledge.seat_limit(name)
            if formula.limit.function == "seat_limit"
            else self.knowledge.bed_limit(name)
        )

    def _candidates(self, variable: str, conjuncts: Iterable[Formula], bound: Mapping[str, int]) -> Iterable[int]:
        """The nodes worth trying for a variable: those an edge leads to, or all."""
        for part in conjuncts:
            if not isinstance(part, Literal) or part.negated or part.name not in _EDGES:
                continue
            first, second = part.terms
            if second.name == variable and not second.function and first.name in bound:
                source = self.thing(first, bound)
                return () if source is None else tuple(self.view.targets(part.name, source))
            if first.name == variable and not first.function and second.name in bound:
                target = self.thing(second, bound)
                return () if target is None else tuple(self.view.sources(part.name, target))
        return self.view.nodes()

    def _atom(self, atom: Literal[Term], bound: Mapping[str, int]) -> bool:
        if atom.name in _EDGES:
            first, second = (self.thing(term, bound) for term in atom.terms)
            return first is not None and second is not None and second in self.view.targets(atom.name, first)
        if atom.name in _BUILT_IN:
            return _BUILT_IN[atom.name](self, atom, bound)
        head, body = self.knowledge.derived[atom.name]
        inner: dict[str, int] = {}
        for variable, term in zip(head.terms, atom.terms, strict=True):
            node = self.thing(term, bound)
            if node is None:
                return False
            inner[variable.name] = node
        return self.holds(body, inner)

    def about(self, atom: Literal[Term], bound: Mapping[str, int]) -> tuple[int | None, str]:
        """The thing and the name an atom such as `state(o, OPEN)` is about."""
        return self.thing(atom.terms[0], bound), atom.terms[1].name if len(atom.terms) > 1 else ""


def _state(reading: _Reading, atom: Literal[Term], bound: Mapping[str, int]) -> bool:
    node, name = reading.about(atom, bound)
    return node is not None and reading.view.has_state(node, name)


def _property(reading: _Reading, atom: Literal[Term], bound: Mapping[str, int]) -> bool:
    node, name = reading.about(atom, bound)
    return node is not None and name in reading.view.properties(node)


def _class(reading: _Reading, atom: Literal[Term], bound: Mapping[str, int]) -> bool:
    node, name = reading.about(atom, bound)
    return node is not None and reading.view.class_name(node) == name


def _class_contains(reading: _Reading, atom: Literal[Term], bound: Mapping[str, int]) -> bool:
    node, name = reading.about(atom, bound)
    return node is not None and name in reading.view.class_name(node)


def _is_room(reading: _Reading, atom: Literal[Term], bound: Mapping[str, int]) -> bool:
    node, _ = reading.about(atom, bound)
    return node is not None and reading.view.is_room(node)


def _option(reading: _Reading, atom: Literal[Term], bound: Mapping[str, int]) -> bool:
    return atom.terms[0].name in reading.options


def _same(reading: _Reading, atom: Literal[Term], bound: Mapping[str, int]) -> bool:
    first, second = (reading.thing(term, bound) for term in atom.terms)
    return first is not None and first == second


def _affords(reading: _Reading, atom: Literal[Term], bound: Mapping[str, int]) -> bool:
    node, _ = reading.about(atom, bound)
    if reading.action is None or node is None:
        return False
    need = reading.action.needs["os".index(atom.terms[0].name)]
    view = reading.view
    return need.accepts(view.properties(node), view.class_name(node), view.is_room(node))


def _remembers(reading: _Reading, atom: Literal[Term], bound: Mapping[str, int]) -> bool:
    node, _ = reading.about(atom, bound)
    memory = reading.view.origin(node) if node is not None else None
    return memory is not None and memory[1] == reading.thing(atom.terms[1], bound)


def _came_from(reading: _Reading, atom: Literal[Term], bound: Mapping[str, int]) -> bool:
    node, name = reading.about(atom, bound)
    memory = reading.view.origin(node) if node is not None else None
    return memory is not None and memory[0] == name


_EDGES = frozenset(RELATIONS)

_BUILT_IN: dict[str, Callable[[_Reading, Literal[Term], Mapping[str, int]], bool]] = {
    "affords": _affords,
    "came_from": _came_from,
    "class": _class,
    "class_contains": _class_contains,
    "is_room": _is_room,
    "option": _option,
    "property": _property,
    "REMEMBERS": _remembers,
    "same": _same,
    "state": _state,
}


def _flat(parts: Iterable[Formula]) -> Iterator[Formula]:
    """Conjuncts, nested ones too."""
    for part in parts:
        if isinstance(part, And):
            yield from _flat(part.parts)
        else:
            yield part
