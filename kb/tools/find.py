"""Classes by affordance, place, property, state and kind."""

from collections.abc import Callable
from dataclasses import dataclass

from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action, ObjectClass
from hearth.kb.spelling import key_of
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.short_repr import brief
from hearth.schemas.vocabulary import PROPERTIES


@dataclass(frozen=True, slots=True)
class Query:
    """A query; everything given must hold.

    Attributes:
        can: actions that take it as their first object.
        on, inside, near: things it may be on, in or near.
        room: a room it is found in.
        has: properties.
        may_be: states.
        kind: a kind or class it is one of.
        word: a word of its name, or of another name of it.
    """

    can: tuple[str, ...] = ()
    on: str = ""
    inside: str = ""
    near: str = ""
    room: str = ""
    has: tuple[str, ...] = ()
    may_be: tuple[str, ...] = ()
    kind: str = ""
    word: str = ""

    __repr__ = brief


def find(knowledge: Knowledge, query: Query) -> tuple[ObjectClass, ...]:
    """Return the classes that meet the query; those placed there first when a place is asked for, most usual first.

    Raises:
        HearthError: every name of the query that is unknown, with the nearest known ones.

    Examples:
        >>> [thing.name for thing in hearth.find(known, hearth.Query(can=("Drink",), inside="fridge"))][:3]
        ['juice', 'milk', 'beer']
    """
    faults = _faults(knowledge, query)
    if faults:
        raise HearthError(faults)
    weights = [_weights(knowledge, place, relation) for place, relation in _places(query) if place]
    tests = _tests(knowledge, query)
    found = [
        thing
        for name, thing in knowledge.objects.items()
        if all(name in weight for weight in weights) and all(test(thing) for test in tests)
    ]
    return tuple(sorted(found, key=lambda thing: (-sum(weight[thing.name] for weight in weights), thing.name)))


def _places(query: Query) -> tuple[tuple[str, str], ...]:
    return (query.on, "ON"), (query.inside, "IN"), (query.near, "NEARBY")


def _weights(knowledge: Knowledge, place: str, relation: str) -> dict[str, int]:
    """Return the classes that may stand in the relation to the place, and how usual that is.

    Second names as their first ones.
    """
    own: dict[str, int] = {}
    for placement in knowledge.holds(place):
        if placement.relation == relation:
            own[placement.object] = max(placement.weight, own.get(placement.object, 0))
    twins = {name: thing.same_as for name, thing in knowledge.objects.items() if thing.same_as in own}
    return {**own, **{name: own[original] for name, original in twins.items()}}


def _tests(knowledge: Knowledge, query: Query) -> list[Callable[[ObjectClass], bool]]:
    tests: list[Callable[[ObjectClass], bool]] = []
    for name in query.can:
        tests.append(lambda thing, name=name: knowledge.affords(name, 0, thing.name))  # type: ignore[misc]
    if query.room:
        room = knowledge.object_class(query.room)
        tests.append(lambda thing: room is not None and room.name in thing.rooms)
    if query.has:
        wanted = {name.upper() for name in query.has}
        tests.append(lambda thing: wanted <= thing.properties)
    if query.may_be:
        states = {name.upper() for name in query.may_be}
        tests.append(lambda thing: states.issubset(thing.states))
    if query.kind:
        tests.append(lambda thing: query.kind in knowledge.ancestors(thing.name))
    if query.word:
        named = frozenset(name for key, name in knowledge.object_spellings.items() if key_of(query.word) in key)
        tests.append(lambda thing: thing.name in named)
    return tests


def find_actions(knowledge: Knowledge, word: str) -> tuple[Action, ...]:
    """Return the actions with a word in their name, in another name of theirs, or in the words that mean them."""
    words = f" {' '.join(word.lower().split())} "
    spelt = {name for spelling, name in knowledge.action_spellings.items() if key_of(word) in spelling}
    phrases = ((action.name, f" {each} ") for action in knowledge.actions.values() for each in action.words)
    said = {name for name, phrase in phrases if words in phrase}
    return tuple(action for name, action in sorted(knowledge.actions.items()) if name in spelt | said)


def _faults(knowledge: Knowledge, query: Query) -> list[Diagnostic]:
    faults = []
    for name in query.can:
        if knowledge.action(name) is None:
            faults.append(unknown(knowledge, name, "action"))
    for name in filter(None, (query.on, query.inside, query.near, query.room)):
        if knowledge.object_class(name) is None:
            faults.append(unknown(knowledge, name, "object"))
    for name in query.has:
        if name.upper() not in PROPERTIES:
            faults.append(_bad(name, "property", PROPERTIES))
    states = tuple(state for group in knowledge.state_groups.values() for state in group.states)
    for name in query.may_be:
        if name.upper() not in states:
            faults.append(_bad(name, "state", states))
    if query.kind and query.kind not in knowledge.kinds and query.kind not in knowledge.objects:
        faults.append(_bad(query.kind, "kind", tuple(knowledge.kinds)))
    return faults


def unknown(knowledge: Knowledge, name: str, kind: str) -> Diagnostic:
    """Return the fault that nobody knows an action or object of that name, with the nearest names."""
    code = Code.UNKNOWN_ACTION if kind == "action" else Code.UNKNOWN_OBJECT
    near = knowledge.suggest(name, kind)
    suggestion = f"did you mean {' or '.join(f'`{other}`' for other in near)}?" if near else ""
    return Diagnostic(code, f"`{name}` is not a known {kind}", found=name, suggestion=suggestion)


def _bad(name: str, kind: str, known: tuple[str, ...]) -> Diagnostic:
    remedy = f"they are {', '.join(known)}"
    return Diagnostic(Code.BAD_TABLE, f"`{name}` is not a known {kind}", found=name, suggestion=remedy)
