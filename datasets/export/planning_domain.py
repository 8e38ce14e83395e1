"""The executed actions as a PDDL domain that planners without axioms can read.

`kb.tools.pddl.domain` writes derived predicates as axioms, which few planners take. Here they are written out where
they are used, and the character is an object of type `agent`. Every thing of a problem has an INSIDE edge to its room
from the start; all actions keep it so, and a room is found without following containers. Left out are two actions
(`OMITTED`), the place that Grab remembers for one of them, and that what is watched must be on, which is an option.

Closed doors stop a walk as in the engine (`Rules.doors`): a problem says by `blocks` which doors part which rooms. To a
door that is closed between the character and the door's own room it walks on its own side (`this-side`: from where, the
room); that is an action of its own here, `WalkToDoor`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import count

from hearth.kb.formula import Effect, Term
from hearth.kb.knowledge import Knowledge
from hearth.kb.records import Action
from hearth.kb.tools.pddl import Names, Writer, dashed, unary_predicates
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import PROPERTIES, RELATIONS

OMITTED = frozenset({"Find", "PutObjBack"})
"""What they do depends on things that problems leave out: what else is near, and where a thing stood. Walk, PutBack and
PutIn do the same."""

TO_DOOR = "WalkToDoor"
"""A Walk in our words."""


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
        *(f"    ({name} ?x - object)" for name in unary_predicates(knowledge, PROPERTIES)),
        *(f"    ({relation_predicate(name)} ?x - object ?y - object)" for name in RELATIONS),
        "    (blocks ?d - object ?r - object ?q - object)",
        "    (this-side ?d - object ?r - object ?q - object)",
        "  )",
        *written,
        ")",
    ]
    return "\n".join(lines) + "\n"


def relation_predicate(name: str) -> str:
    """`HOLDS_RH` -> `holds-rh`; CLOSE -> `close-to`, for there is an action Close, and PDDL does not see capitals."""
    return "close-to" if name == "CLOSE" else dashed(name)


_STOPPED = """(exists (?d - object ?r - object ?q - object)\
 (and (is-closed ?d) (blocks ?d ?r ?q) (inside ?a ?r) (or (= ?o ?q) (inside ?o ?q))))"""
"""A closed door parts the character from the object's room."""

_STOPPED_BY_ITSELF = """(exists (?r - object ?q - object)\
 (and (inside ?a ?r) (inside ?o ?q) (is-closed ?o) (blocks ?o ?r ?q)\
 (not (exists (?d - object) (and (is-closed ?d) (blocks ?d ?r ?q) (not (= ?d ?o)))))))"""
"""The object is a closed door that parts the character from its room, and no other closed one does."""


class _Writer(Writer):
    """Derived predicates are written out; every bound variable gets a name of its own."""

    agent, typed = " - agent", " - object"

    def __init__(self, knowledge: Knowledge, loose: bool) -> None:
        super().__init__(knowledge)
        self._loose = loose
        self._on_own_side = False
        self._numbers = count(1)

    def action(self, action: Action, name: str = "", more: Iterable[str] = ()) -> Iterator[str]:
        """The lines of one action; closed doors stop a walk."""
        self._numbers = count(1)
        stopped = [f"(not {_STOPPED})"] if action.name in self.knowledge.group("walks") else []
        return super().action(action, name, more or stopped)

    def to_door(self, walk: Action) -> list[str]:
        """A walk to a closed door with its room behind it, no other in between: it ends in the room on this side."""
        self._on_own_side = True
        lines = list(self.action(walk, TO_DOOR, [_STOPPED_BY_ITSELF]))
        self._on_own_side = False
        return lines

    def fresh(self, name: str, number: object = "") -> str:
        """A variable that a formula binds."""
        return f"?{name}{next(self._numbers)}"

    def relation(self, name: str) -> str:
        """As `relation_predicate`."""
        return relation_predicate(name)

    def derived(self, literal: Literal[Term], names: Names) -> str:
        """What a derived predicate means."""
        if literal.name == "close" and not self._loose:
            return self.plain(literal._replace(name="CLOSE"), names)
        head, body = self.knowledge.derived[literal.name]
        return self.formula(
            body, {term.name: names[given.name] for term, given in zip(head.terms, literal.terms, strict=True)}
        )

    def found(self, term: Term, names: Names, variable: str) -> str:
        """The condition under which a variable is the thing that a function finds."""
        thing = names[term.name]
        if self._on_own_side and term.name == "o":
            start = self.fresh("from")
            return self.some([start], f"(and (inside ?a {start}) (this-side {thing} {start} {variable}))")
        return f"(and (is-room {variable}) (or (= {thing} {variable}) (inside {thing} {variable})))"

    def changes(self, effect: Effect) -> Iterator[Effect]:
        """An effect as one or more; those of places are left out."""
        literal = effect.literal
        if literal.name == "REMEMBERS" or any(term.function == "place" for term in literal.terms):
            return iter(())
        return super().changes(effect)
