"""Groups of actions: those that follow from an action's needs and changes, and those that an entry names itself."""

from collections.abc import Callable, Iterable, Mapping

from hearth.kb.formula import TRUE, And, Effect, Some
from hearth.kb.knowledge_records import Action
from hearth.schemas.failures import Code
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import OPPOSITE

DECLARED: dict[str, str] = {
    "animated": "what the thesis animates and programs contain (table 2.2; 4.4, footnote 1)",
    "gets_up": "ends rest, whether it changes the posture or not",
    "goes": "afterwards the character is at its object",
    "handling": "a means to something else: no object is made for it",
    "hand": "done with a hand that is free, else with the right one",
    "idle": "moves or looks, and does nothing",
    "looks": "turns the eyes to its object",
    "lies": "done in bed rather than on a seat",
    "played": "what agents of a challenge may try (thesis 6.3, 7.3)",
    "preparation": "what it is for is another step, in any activity",
    "unplanned": "its effects depend on facts that planning problems omit: nearby objects, former places",
    "unsaid": "goes without saying among people (thesis 3.4.1)",
    "variant": "changes what a plainer action changes, too",
}
"""The groups that entries of actions.yaml may name, and their meanings."""


def _adds(action: Action) -> frozenset[str]:
    """Return the effects that hold in every case."""
    return frozenset(str(e.literal) for e in action.effects if not e.literal.negated and _always(e))


def _may_add(action: Action) -> frozenset[str]:
    return frozenset(str(effect.literal) for effect in action.effects if not effect.literal.negated)


def _deletes(action: Action) -> frozenset[str]:
    return frozenset(str(e.literal.atom) for e in action.effects if e.literal.negated and _always(e))


def _always(effect: Effect) -> bool:
    return effect.condition == TRUE and not effect.variables


def _checks(action: Action, code: Code) -> bool:
    return any(check.code is code for check in action.preconditions)


def _takes(action: Action) -> bool:
    return "HOLDS_RH(a, o)" in _may_add(action)


def _frees_hand(action: Action) -> bool:
    return "HOLDS_RH(a, o)" in _deletes(action)


def _rests(action: Action) -> bool:
    return not _adds(action).isdisjoint({"state(a, SITTING)", "state(a, LYING)"})


def _dresses(action: Action) -> bool:
    return "ON(o, a)" in _adds(action) | _deletes(action)


def _by_hand(action: Action) -> bool:
    return not _takes(action) and (_checks(action, Code.NO_FREE_HAND) or bool(state_of(action)) or _dresses(action))


DERIVED: dict[str, Callable[[Action], bool]] = {
    "dresses": _dresses,
    "forgets": lambda action: "REMEMBERS(o)" in _deletes(action),
    "frees_hand": _frees_hand,
    "goes": lambda action: "INSIDE(a, room(o))" in _may_add(action),
    "hand": _by_hand,
    "lets_go": lambda action: _frees_hand(action) and "INSIDE(o, room(a))" in _adds(action),
    "puts": lambda action: _frees_hand(action) and not _adds(action).isdisjoint({"ON(o, s)", "INSIDE(o, s)"}),
    "rests": _rests,
    "rises": lambda action: "state(a, SITTING)" in _deletes(action) and not _rests(action),
    "takes": _takes,
    "walks": lambda action: "INSIDE(a, room(o))" in _adds(action),
}
"""The groups that follow from an action's own literals: it dresses or undresses; it forgets where its object came from;
a hand holds one thing less; the character may, or must, change rooms; a hand takes part; the object stays where the
character is; it is put on or in another; the character sits or lies, gets up, takes its object."""


def state_of(action: Action) -> str:
    """Return the state that its object enters, or ''."""
    return next((text[len("state(o, ") : -1] for text in sorted(_adds(action)) if text.startswith("state(o, ")), "")


def relation_of(action: Action) -> str:
    """Return the relation into which it puts what is held with its second object (ON, INSIDE), or ''."""
    return next((name for name in ("ON", "INSIDE") if _frees_hand(action) and f"{name}(o, s)" in _adds(action)), "")


def tool_of(action: Action) -> str | None:
    """Part of the name of the thing in hand that it needs and does not name: '' for anything, None if it needs none."""
    needed = (c.formula for c in action.preconditions if c.code is Code.NOT_HOLDING and isinstance(c.formula, Some))
    for some in needed:
        parts = some.part.parts if isinstance(some.part, And) else (some.part,)
        named = (p.terms[1].name for p in parts if isinstance(p, Literal) and p.name == "class_contains")
        return next(named, "")
    return None


def groups(actions: Iterable[Action]) -> Mapping[str, frozenset[str]]:
    """Every group, and the names of its actions; `operates` are those whose change another action takes back."""
    known = tuple(actions)
    made = {state_of(action) for action in known} - {""}
    found = {name: {each.name for each in known if name in each.groups} for name in DECLARED}
    for name, belongs in DERIVED.items():
        found.setdefault(name, set()).update(each.name for each in known if belongs(each))
    found["operates"] = {each.name for each in known if OPPOSITE.get(state_of(each), "") in made}
    return {name: frozenset(names) for name, names in found.items()}
