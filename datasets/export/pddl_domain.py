"""The executed actions as a PDDL domain that planners without axioms can read.

`kb.tools.pddl.domain` writes derived predicates as axioms, which few planners support. Here they are expanded where
they are used, and the character is an object of type `agent`. Every thing of a problem has an INSIDE edge to its room
from the start; all actions keep it so, and a room is found without following containers. Three parts are left out: two
actions (the group `unplanned`, which Walk, PutBack and PutIn replace), the place that Grab remembers for one of them,
and the optional precondition that a watched thing is on.

Closed doors stop a walk as in the engine (`Rules.doors`): a problem says by `blocks` which doors part which rooms. To a
door that is closed between the character and the door's own room it walks on its own side (`this-side`: from where, the
room); that is an action of its own here, `WalkToDoor`.
"""

from collections.abc import Iterable, Iterator
from itertools import count

from hearth.kb.formula import Effect, Term
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action
from hearth.kb.tools.pddl import Names, Writer, dashed, option_predicate, options, unary_predicates, waiting
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import PROPERTIES, RELATIONS
from hearth.simulation.actions.registry import ACTIONS, EVERY

TO_DOOR = "WalkToDoor"
"""A Walk in our programs."""


def planning_domain(knowledge: Knowledge, actions: Iterable[str] = (), loose: bool = True) -> str:
    """Return the domain as text.

    Args:
        knowledge: of which the executed actions are written.
        actions: only these, and these waits (`kb.tools.pddl.waiting`); all if none.
        loose: whether the character is also close to things next to or on a CLOSE one (semantics: the loose rule).
            Without it there are fewer ways to satisfy a precondition and planners are faster; their plans
            are plans with it, too.
    """
    actions = tuple(actions)
    executed = {name for name, action in knowledge.actions.items() if action.executed} - knowledge.group("unplanned")
    executed -= EVERY.keys() - ACTIONS.keys()  # moves by metres, of which no literal says where they lead
    wanted = executed & {*actions} or executed
    writer = _Writer(knowledge, loose)
    written = [line for name in sorted(wanted) for line in writer.action(knowledge.actions[name])]
    waits = waiting(knowledge)
    waits = {name: waits[name] for name in actions if name in waits} if actions else waits
    written += [line for name, process in waits.items() for line in writer.wait(name, process)]
    written += writer.to_door(knowledge.actions["Walk"]) if "Walk" in wanted else []
    lines = [
        "(define (domain hearth)",
        "  (:requirements :adl)",
        "  (:types agent - object)",
        "  (:predicates",
        *(f"    ({option_predicate(name)})" for name in options(knowledge)),
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
"""A closed door separates the character from the object's room."""

_STOPPED_BY_ITSELF = """(exists (?r - object ?q - object)\
 (and (inside ?a ?r) (inside ?o ?q) (is-closed ?o) (blocks ?o ?r ?q)\
 (not (exists (?d - object) (and (is-closed ?d) (blocks ?d ?r ?q) (not (= ?d ?o)))))))"""
"""The object is the only closed door that separates the character from its room."""


class _Writer(Writer):
    """Expands derived predicates; every bound variable gets a unique name."""

    agent, typed = " - agent", " - object"

    def __init__(self, knowledge: Knowledge, loose: bool) -> None:
        super().__init__(knowledge)
        self._loose = loose
        self._on_own_side = False
        self._numbers = count(1)

    def action(self, action: Action, name: str = "", more: Iterable[str] = ()) -> Iterator[str]:
        """Yield the lines of one action; closed doors block a walk."""
        self._numbers = count(1)
        stopped = [f"(not {_STOPPED})"] if action.name in self.knowledge.group("walks") else []
        return super().action(action, name, more or stopped)

    def to_door(self, walk: Action) -> list[str]:
        """Return a walk to the only closed door before its room: it ends in the room on this side."""
        self._on_own_side = True
        lines = list(self.action(walk, TO_DOOR, [_STOPPED_BY_ITSELF]))
        self._on_own_side = False
        return lines

    def fresh(self, name: str, number: object = "") -> str:
        """Return a variable that a formula binds."""
        return f"?{name}{next(self._numbers)}"

    def relation(self, name: str) -> str:
        """Return the name of a relation, as `relation_predicate` does."""
        return relation_predicate(name)

    def derived(self, literal: Literal[Term], names: Names) -> str:
        """Return the definition of a derived predicate."""
        if literal.name == "close" and not self._loose:
            return self.plain(literal._replace(name="CLOSE"), names)
        head, body = self.knowledge.derived[literal.name]
        return self.formula(
            body, {term.name: names[given.name] for term, given in zip(head.terms, literal.terms, strict=True)}
        )

    def found(self, term: Term, names: Names, variable: str) -> str:
        """Return the condition under which a variable is the thing that a function finds."""
        thing = names[term.name]
        if self._on_own_side and term.name == "o":
            start = self.fresh("from")
            return self.some([start], f"(and (inside ?a {start}) (this-side {thing} {start} {variable}))")
        return f"(and (is-room {variable}) (or (= {thing} {variable}) (inside {thing} {variable})))"

    def changes(self, effect: Effect) -> Iterator[Effect]:
        """Yield an effect as one or more effects, without those on remembered places."""
        literal = effect.literal
        if literal.name == "REMEMBERS" or any(term.function == "place" for term in literal.terms):
            return iter(())
        return super().changes(effect)
