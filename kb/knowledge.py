"""The knowledge as one value: loaded once, checked, then only dictionary look-ups."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TypeVar

from hearth.kb.action_groups import groups, relation_of, state_of, tool_of
from hearth.kb.action_sets import LATEST, USUAL, in_set
from hearth.kb.formula import TRUE, Effect, Formula, Term
from hearth.kb.knowledge_records import (
    Action,
    Association,
    Hazard,
    Kind,
    ObjectClass,
    Placement,
    Process,
    Repair,
    StateGroup,
)
from hearth.kb.spelling import key_of, near_names
from hearth.schemas.failures import Code
from hearth.schemas.literals import Literal
from hearth.schemas.short_repr import brief
from hearth.schemas.vocabulary import EVERY_STATE

K = TypeVar("K")
V = TypeVar("V")


def grouped(pairs: Iterable[tuple[K, V]]) -> dict[K, tuple[V, ...]]:
    """Return the values of each key, in the order given."""
    found: dict[K, list[V]] = {}
    for key, value in pairs:
        found.setdefault(key, []).append(value)
    return {key: tuple(values) for key, values in found.items()}


def _is_sure_state(effect: Effect) -> bool:
    """Return whether an effect brings the object or the character into a state in every case."""
    return effect.literal.name == "state" and effect.condition == TRUE and not effect.variables


@dataclass(frozen=True, eq=False)
class Knowledge:
    """All that is known. Immutable; every method is a pure look-up.

    Attributes:
        actions: the actions by canonical name, in the order of their ids.
        objects: the classes by canonical name, in the order of their ids; rooms are classes too.
        rooms: the eight rooms a program may name, sorted.
        state_groups: groups of states by name.
        table_like: classes on which rule 9 of the preconditions expects things (semantics).
        defaults: class or property -> the states a home is prepared with (thesis 5.5.2).
        derived: definitions of derived predicates.
        kinds: the kinds above the classes.
        associations: classes that are used together.
        repairs: what to do about a failure, by name; the first that fits is the one to try.
        processes: changes that come by themselves in action set 3, by name.
        hazards: dangers, harms and wastes that `hearth hazards` finds, by name.
        action_set: the number of the action set whose checks and effects the actions have: 2, or 3 (see `of_set`).
    """

    actions: Mapping[str, Action]
    objects: Mapping[str, ObjectClass]
    rooms: tuple[str, ...]
    state_groups: Mapping[str, StateGroup]
    table_like: frozenset[str]
    defaults: Mapping[str, Mapping[str, tuple[str, ...]]]
    derived: Mapping[str, tuple[Literal[Term], Formula]]
    kinds: Mapping[str, Kind]
    associations: tuple[Association, ...]
    repairs: Mapping[str, Repair]
    processes: Mapping[str, Process]
    hazards: Mapping[str, Hazard]
    _action_names: Mapping[str, Action] = field(repr=False)
    _object_names: Mapping[str, ObjectClass] = field(repr=False)
    _aliases: Mapping[str, tuple[str, ...]] = field(repr=False)
    _stand_ins: Mapping[str, tuple[str, ...]] = field(repr=False)
    _placements: Mapping[str, tuple[Placement, ...]] = field(repr=False)
    _held: Mapping[str, tuple[Placement, ...]] = field(repr=False)
    _limits: Mapping[str, Mapping[str, int]] = field(repr=False)
    action_set: int = USUAL

    __repr__ = brief

    def of_set(self, number: int) -> Knowledge:
        """Return the same knowledge with the actions of a set: those of set 3 have its checks and effects.

        Always the same value for a number, since tables are kept by knowledge.

        Raises:
            ValueError: the set is neither 2 nor 3.
        """
        if number not in (USUAL, LATEST):
            raise ValueError(f"no action set {number!r:.20}; there are {USUAL} and {LATEST}")
        if number == self.action_set:
            return self
        return self._of_latest if number == LATEST else self._of_usual

    @cached_property
    def _of_latest(self) -> Knowledge:
        actions = {name: in_set(action, LATEST, self.actions) for name, action in self.actions.items()}
        names = {spelling: actions[action.name] for spelling, action in self._action_names.items()}
        found = replace(self, actions=actions, _action_names=names, action_set=LATEST)
        found.__dict__["_of_usual"] = self
        return found

    @cached_property
    def _of_usual(self) -> Knowledge:
        raise ValueError("the knowledge of set 3 is made of that of set 2, by `of_set`")

    @cached_property
    def class_ids(self) -> Mapping[str, int]:
        """The number of each class, as in the table `vocabulary`."""
        return {thing.name: thing.id for thing in self.objects.values()}

    # Actions

    def action(self, text: str) -> Action | None:
        """Return the action of that name or alias, in any case, with or without spaces; None when there is none."""
        return self._action_names.get(text) or self._action_names.get(key_of(text))

    @cached_property
    def called(self) -> Mapping[str, tuple[str, ...]]:
        """The actions that a name in a program, as `key_of` gives it, may call."""
        return grouped((key_of(name), action.name) for action in self.actions.values() for name in action.calls)

    @cached_property
    def arity(self) -> Mapping[str, int]:
        """Return how many objects each action takes; asked by every step."""
        return {name: action.arity for name, action in self.actions.items()}

    def affords(self, action: str, position: int, class_name: str) -> bool:
        """Return whether the grammar lets a thing of that class be the argument at `position` (from 0) of the action.

        Unknown actions, classes and positions are not afforded.
        """
        found, thing = self.action(action), self.object_class(class_name)
        if found is None or thing is None or not 0 <= position < found.arity:
            return False
        return found.grammar[position].accepts(thing.properties, thing.name, thing.category == "Rooms")

    def achievers(self, predicate: str) -> tuple[tuple[Action, Effect], ...]:
        """Return the actions that make a predicate true, and by which effect.

        `ON`, `HOLDS_RH`, `CLOSE`, or a state's name.
        """
        return self._achievers.get(predicate, ())

    @cached_property
    def _achievers(self) -> Mapping[str, tuple[tuple[Action, Effect], ...]]:
        return grouped(
            (literal.terms[1].name if literal.name == "state" else literal.name, (action, effect))
            for action in self.actions.values()
            for effect in action.effects
            if not (literal := effect.literal).negated
        )

    def achieving(self, *states: str) -> frozenset[str]:
        """Return the names of the actions that bring their object, or the character, into one of these states."""
        return frozenset().union(*(self._achieving.get(state, ()) for state in states))

    def achiever(self, state: str) -> str:
        """Return the plainest action that brings something into a state, by name; '' when none does."""
        names = self._achieving.get(state, ())
        return min(names, key=lambda name: name in self.group("variant"), default="")

    @cached_property
    def _achieving(self) -> Mapping[str, tuple[str, ...]]:
        found = {state: self.achievers(state) for state in EVERY_STATE}
        return {
            state: tuple(action.name for action, effect in pairs if _is_sure_state(effect))
            for state, pairs in found.items()
        }

    def group(self, name: str) -> frozenset[str]:
        """Return the names of the actions of a group (see `kb.action_groups`).

        Raises:
            KeyError: the group does not exist.
        """
        return self._groups[name]

    @cached_property
    def _groups(self) -> Mapping[str, frozenset[str]]:
        found = groups(self.actions.values())
        if self.action_set == LATEST:  # one may wash twice, although what was washed may get dirty
            found = {**found, "operates": self._of_usual.group("operates")}
        return found

    def state_of(self, action: str) -> str:
        """Return the state that the object of an action enters, or ''."""
        return self._states_made.get(action, "")

    @cached_property
    def _states_made(self) -> Mapping[str, str]:
        return {name: state_of(action) for name, action in self.actions.items() if state_of(action)}

    def relation_of(self, action: str) -> str:
        """Return the relation into which an action puts what is held with its second object (ON, INSIDE), or ''."""
        return relation_of(self.actions[action]) if action in self.actions else ""

    def tool_of(self, action: str) -> str | None:
        """Return the object that an action needs in hand without naming it.

        Part of a name, '' for anything, None for nothing.
        """
        return tool_of(self.actions[action]) if action in self.actions else None

    def repairs_for(self, code: Code, action: str) -> tuple[Repair, ...]:
        """Return the possible repairs of an action that fails with that code, the first choice first."""
        return tuple(r for r in self._repairs.get(code, ()) if not r.actions or action in r.actions)

    @cached_property
    def _repairs(self) -> Mapping[Code, tuple[Repair, ...]]:
        return grouped((repair.code, repair) for repair in self.repairs.values())

    # Objects

    def object_class(self, name: str) -> ObjectClass | None:
        """Return the class of that name or synonym, in any case, with or without spaces; None when there is none."""
        return self.objects.get(name) or self._object_names.get(key_of(name))

    def same_class(self, name: str) -> tuple[str, ...]:
        """All names by which an instance of it may appear in a graph, best first; `(name,)` for an unknown name."""
        found = self.object_class(name)
        return (name,) if found is None else self._same_class(found.name)

    def found_as(self, name: str) -> tuple[str, ...]:
        """`same_class`, and after each name how VirtualHome 2.x writes it: `washing_machine`, `washingmachine`."""
        known = self._found_as.get(name)
        if known is None:
            pairs = ((each, each.replace("_", "")) for each in self.same_class(name))
            known = self._found_as[name] = tuple(dict.fromkeys(each for pair in pairs for each in pair))
        return known

    @cached_property
    def _found_as(self) -> dict[str, tuple[str, ...]]:
        return {}

    def stand_ins(self, name: str) -> tuple[str, ...]:
        """Return the classes whose things may take its place in a home, best first."""
        thing = self.object_class(name)
        return self._stand_ins.get(thing.name, ()) if thing else ()

    @cached_property
    def _twins(self) -> Mapping[str, tuple[str, ...]]:
        """Original -> the classes that are other names of it."""
        return grouped((thing.same_as, thing.name) for thing in self.objects.values() if thing.same_as)

    @cached_property
    def _same_classes(self) -> dict[str, tuple[str, ...]]:
        return {}

    def _same_class(self, name: str) -> tuple[str, ...]:
        known = self._same_classes.get(name)
        if known is None:
            own = self._names_of(name)
            others = [other for stand_in in self._stand_ins.get(name, ()) for other in self._names_of(stand_in)]
            known = self._same_classes[name] = tuple(dict.fromkeys((*own, *others)))
        return known

    def _names_of(self, name: str) -> tuple[str, ...]:
        """Return a class's own name, its twins' and the aliases of them all."""
        thing = self.objects.get(name)
        if thing is None:
            return (name,)
        root = thing.same_as or name
        family = dict.fromkeys((name, root, *self._twins.get(root, ())))
        return (*family, *(alias for one in family for alias in self._aliases.get(one, ())))

    def ancestors(self, name: str) -> tuple[str, ...]:
        """Return the hypernyms of a class, nearest first: `fridge` -> appliance, device, artefact, thing."""
        thing = self.object_class(name)
        above: list[str] = []
        step = thing.hypernym if thing else ""
        while step and step not in above:
            above.append(step)
            kind = self.kinds.get(step)
            step = kind.parent if kind else self.objects[step].hypernym if step in self.objects else ""
        return tuple(above)

    def is_room(self, name: str) -> bool:
        """Return whether that is a kind of room."""
        thing = self.object_class(name)
        return thing is not None and thing.category == "Rooms"

    def has(self, name: str, prop: str) -> bool:
        """Return whether things of a class have a property; those of an unknown class have none."""
        thing = self.object_class(name)
        return thing is not None and prop in thing.properties

    def seat_limit(self, name: str) -> int:
        """Return how many things may be ON it before one may no longer sit down."""
        return self._limit("sit", name)

    def bed_limit(self, name: str) -> int:
        """Return how many things may be ON it before one may no longer lie down."""
        return self._limit("lie", name)

    def _limit(self, kind: str, name: str) -> int:
        limits, thing = self._limits[kind], self.object_class(name)
        return limits.get(name) or limits.get(thing.name if thing else name) or limits["default"]

    def default_states(self, name: str) -> tuple[str, ...]:
        """Return the simulated states in which a home's thing of that class starts (thesis 5.5.2)."""
        known = self._default_states.get(name)
        if known is None:
            known = self._default_states[name] = self._defaults_of(name)
        return known

    @cached_property
    def _default_states(self) -> dict[str, tuple[str, ...]]:
        return {}

    def _defaults_of(self, name: str) -> tuple[str, ...]:
        thing = self.object_class(name)
        if thing is None:
            return ()
        special = self.defaults["classes"].get(thing.same_as or thing.name)
        replaced = {self.group_of(state) for state in special or ()}
        usual = [
            state
            for prop, states in self.defaults["properties"].items()
            if prop in thing.properties
            for state in states
            if self.group_of(state) not in replaced
        ]
        return tuple(sorted((*usual, *(special or ()), *self._always(replaced))))

    def _always(self, replaced: set[str]) -> tuple[str, ...]:
        return tuple(s for s in self.defaults["always"].get("states", ()) if self.group_of(s) not in replaced)

    def group_of(self, state: str) -> str:
        """Return the group a state belongs to, or ''."""
        return self._group_names.get(state, "")

    @cached_property
    def _group_names(self) -> Mapping[str, str]:
        return {state: group.name for group in self.state_groups.values() for state in group.states}

    def excludes(self, state: str) -> tuple[str, ...]:
        """Return the states that cannot hold together with this one."""
        group = self.state_groups.get(self.group_of(state))
        return tuple(other for other in group.states if other != state) if group and group.exclusive else ()

    # Places

    def placements(self, name: str) -> tuple[Placement, ...]:
        """Return where a thing of that class may be, most usual first."""
        return self._of(self._placements, name)

    def holds(self, name: str) -> tuple[Placement, ...]:
        """Return the classes that may be on, in or near a thing of that class, most usual first."""
        return self._of(self._held, name)

    def _of(self, table: Mapping[str, tuple[Placement, ...]], name: str) -> tuple[Placement, ...]:
        found = table.get(name)
        if found is None:
            thing = self.object_class(name)
            found = table.get(thing.same_as or thing.name, ()) if thing else ()
        return found

    # Names

    def suggest(self, name: str, kind: str = "object") -> tuple[str, ...]:
        """Return the known names nearest to one that is not known, best first; `kind` is `object` or `action`."""
        return near_names(name, self.action_spellings if kind == "action" else self.object_spellings)

    @cached_property
    def action_spellings(self) -> dict[str, str]:
        """Every spelling of an action, as `key_of` gives it -> the action's name."""
        return {key: action.name for key, action in self._action_names.items()}

    @cached_property
    def object_spellings(self) -> dict[str, str]:
        """Every spelling of an object, as `key_of` gives it -> its class."""
        return {key: thing.name for key, thing in self._object_names.items()}
