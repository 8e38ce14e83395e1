"""The knowledge as one value: loaded once, checked, then only dictionary look-ups."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

from hearth.kb import loading
from hearth.kb.formula import Atom, Effect, Formula
from hearth.kb.reading import Entry, Faults
from hearth.kb.records import Action, ObjectClass, Placement, StateGroup
from hearth.schemas.errors import HearthError
from hearth.schemas.failures import Code

EXECUTED_FILES = ("actions.yaml",)
WRITTEN_FILES = ("actions_written.yaml",)
OBJECT_FILES = (
    "objects_clothes.csv",
    "objects_devices.csv",
    "objects_food.csv",
    "objects_furniture.csv",
    "objects_house.csv",
    "objects_hygiene.csv",
    "objects_kitchenware.csv",
    "objects_paper.csv",
    "objects_people.csv",
    "objects_things.csv",
)
FILES = frozenset(
    {*EXECUTED_FILES, *WRITTEN_FILES, *OBJECT_FILES}
    | {"affordances.yaml", "aliases.csv", "corrections.yaml", "derived.yaml", "kinds.csv", "limits.yaml"}
    | {"placements.csv", "repairs.yaml", "rooms.yaml", "stand_ins.csv", "states.yaml", "tables.yaml"}
)
"""Every file the knowledge is read from; another YAML or CSV file in a directory of it is a mistake."""

_DROPPED = {ord(letter): None for letter in " _-"}


def key_of(name: str) -> str:
    """A name for comparison: case, spaces, hyphens and underscores left out."""
    return name.lower().translate(_DROPPED)


@dataclass(frozen=True, eq=False)
class Knowledge:
    """All that is known. Immutable; every method is a pure look-up.

    Attributes:
        actions: the 84 actions by canonical name, in the order of their ids.
        objects: the classes by canonical name, in the order of their ids; rooms are classes too.
        rooms: the eight rooms a program may name, sorted.
        room_standins: room -> the room that serves where a home lacks it.
        state_groups: groups of states by name.
        table_like: classes on which rule 9 of the preconditions expects things (semantics).
        defaults: class or property -> the states a home is prepared with (thesis 5.5.2).
        derived: definitions of derived predicates.
    """

    actions: Mapping[str, Action]
    objects: Mapping[str, ObjectClass]
    rooms: tuple[str, ...]
    room_standins: Mapping[str, str]
    state_groups: Mapping[str, StateGroup]
    table_like: frozenset[str]
    defaults: Mapping[str, Mapping[str, tuple[str, ...]]]
    derived: Mapping[str, tuple[Atom, Formula]]
    _action_names: Mapping[str, Action] = field(repr=False)
    _object_names: Mapping[str, ObjectClass] = field(repr=False)
    _aliases: Mapping[str, tuple[str, ...]] = field(repr=False)
    _stand_ins: Mapping[str, tuple[str, ...]] = field(repr=False)
    _placements: Mapping[str, tuple[Placement, ...]] = field(repr=False)
    _held: Mapping[str, tuple[Placement, ...]] = field(repr=False)
    _limits: Mapping[str, Mapping[str, int]] = field(repr=False)

    # Actions

    def action(self, text: str) -> Action | None:
        """The action of that name or alias, in any case, with or without spaces; None when there is none."""
        return self._action_names.get(text) or self._action_names.get(key_of(text))

    def affords(self, action: str, position: int, class_name: str) -> bool:
        """Whether the grammar lets a thing of that class be the argument at `position` (from 0) of the action.

        Unknown actions, classes and positions are not afforded.
        """
        found, thing = self.action(action), self.object_class(class_name)
        if found is None or thing is None or not 0 <= position < found.arity:
            return False
        return found.grammar[position].accepts(thing.properties, thing.name, thing.category == "Rooms")

    def achievers(self, predicate: str) -> tuple[tuple[Action, Effect], ...]:
        """Which actions make a predicate true, and by which effect: `ON`, `HOLDS_RH`, `CLOSE`, or a state's name."""
        return self._achievers.get(predicate, ())

    @cached_property
    def _achievers(self) -> Mapping[str, tuple[tuple[Action, Effect], ...]]:
        found: dict[str, list[tuple[Action, Effect]]] = {}
        for action in self.actions.values():
            for effect in action.effects:
                if not effect.delete:
                    atom = effect.atom
                    name = atom.terms[1].name if atom.name == "state" else atom.name
                    found.setdefault(name, []).append((action, effect))
        return {name: tuple(pairs) for name, pairs in found.items()}

    # Objects

    def object_class(self, name: str) -> ObjectClass | None:
        """The class of that name or synonym, in any case, with or without spaces; None when there is none."""
        return self.objects.get(name) or self._object_names.get(key_of(name))

    def same_class(self, name: str) -> tuple[str, ...]:
        """All names by which an instance of it may appear in a graph, best first; `(name,)` for an unknown name."""
        found = self.object_class(name)
        return (name,) if found is None else self._same_class(found.name)

    @cached_property
    def _twins(self) -> Mapping[str, tuple[str, ...]]:
        """Original -> the classes that are other names of it."""
        found: dict[str, list[str]] = {}
        for thing in self.objects.values():
            if thing.same_as:
                found.setdefault(thing.same_as, []).append(thing.name)
        return {name: tuple(twins) for name, twins in found.items()}

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
        """A class's own name, its twins' and the aliases of them all."""
        thing = self.objects.get(name)
        if thing is None:
            return (name,)
        root = thing.same_as or name
        family = dict.fromkeys((name, root, *self._twins.get(root, ())))
        return (*family, *(alias for one in family for alias in self._aliases.get(one, ())))

    def is_room(self, name: str) -> bool:
        """Whether that is a kind of room."""
        thing = self.object_class(name)
        return thing is not None and thing.category == "Rooms"

    def is_seat(self, name: str) -> bool:
        """Whether one can sit on it."""
        return self._has(name, "SITTABLE")

    def is_bed(self, name: str) -> bool:
        """Whether one can lie on it."""
        return self._has(name, "LIEABLE")

    def _has(self, name: str, prop: str) -> bool:
        thing = self.object_class(name)
        return thing is not None and prop in thing.properties

    def seat_limit(self, name: str) -> int:
        """How many things may be ON it before one may no longer sit down."""
        limits = self._limits["sit"]
        return limits.get(name) or limits["default"]

    def bed_limit(self, name: str) -> int:
        """How many things may be ON it before one may no longer lie down."""
        limits = self._limits["lie"]
        return limits.get(name) or limits["default"]

    def default_states(self, name: str) -> tuple[str, ...]:
        """The simulated states in which a home's thing of that class starts (thesis 5.5.2)."""
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
        """The group a state belongs to, or ''."""
        return self._group_names.get(state, "")

    @cached_property
    def _group_names(self) -> Mapping[str, str]:
        return {state: group.name for group in self.state_groups.values() for state in group.states}

    def excludes(self, state: str) -> tuple[str, ...]:
        """The states that cannot hold together with this one."""
        group = self.state_groups.get(self.group_of(state))
        return tuple(other for other in group.states if other != state) if group and group.exclusive else ()

    # Places

    def placements(self, name: str) -> tuple[Placement, ...]:
        """Where a thing of that class may be, most usual first."""
        return self._of(self._placements, name)

    def holds(self, name: str) -> tuple[Placement, ...]:
        """What may be on, in or near a thing of that class, most usual first."""
        return self._of(self._held, name)

    def _of(self, table: Mapping[str, tuple[Placement, ...]], name: str) -> tuple[Placement, ...]:
        found = table.get(name)
        if found is None:
            thing = self.object_class(name)
            found = table.get(thing.same_as or thing.name, ()) if thing else ()
        return found

    # Names

    def suggest(self, name: str, kind: str = "object") -> tuple[str, ...]:
        """The known names nearest to one that is not known, best first; `kind` is `object` or `action`."""
        from rapidfuzz import process, utils

        names = self._action_spellings if kind == "action" else self._object_spellings
        close = process.extract(key_of(name), names, processor=utils.default_process, limit=5, score_cutoff=65)
        return tuple(dict.fromkeys(names[key] for _, _, key in close))[:3]

    @cached_property
    def _action_spellings(self) -> dict[str, str]:
        return {key: action.name for key, action in self._action_names.items()}

    @cached_property
    def _object_spellings(self) -> dict[str, str]:
        return {key: thing.name for key, thing in self._object_names.items()}


def load(directory: Path | None = None, overlay: Path | None = None) -> Knowledge:
    """Read the knowledge from `directory` (ours when None), with a user's own files laid over it.

    An entry of the overlay replaces ours of the same name; a placement of weight 0 takes ours away.

    Raises:
        HearthError: every duplicate key, unknown property, unknown object, circle of synonyms and other fault of all
            files, each with file and line.
    """
    layers = [directory or Path(__file__).parent, *([overlay] if overlay else [])]
    faults = Faults()
    for layer in layers:
        _check_layer(layer, faults)
    knowledge = None if faults else _assembled(layers, faults)
    if faults or knowledge is None:
        raise HearthError(faults)
    return knowledge


@lru_cache(maxsize=1)
def default() -> Knowledge:
    """Our own knowledge, loaded once."""
    return load()


def _check_layer(layer: Path, faults: Faults) -> None:
    if not layer.is_dir():
        faults.add(str(layer), 0, "is not a directory of knowledge files", code=Code.MISSING_FILE)
        return
    for path in sorted(layer.iterdir()):
        if path.suffix in (".yaml", ".yml", ".csv") and path.name not in FILES:
            faults.add(str(path), 0, "is not one of the knowledge's files", f"they are {', '.join(sorted(FILES))}")


def _assembled(layers: list[Path], faults: Faults) -> Knowledge | None:
    groups = loading.state_groups(loading.yaml_entries(layers, ("states.yaml",), faults), faults)
    objects = loading.objects(
        loading.csv_rows(layers, OBJECT_FILES, loading.OBJECT_COLUMNS, (1,), faults), groups, faults
    )
    aliases = loading.aliases(
        loading.csv_rows(layers, ("aliases.csv",), loading.ALIAS_COLUMNS, (0,), faults), objects, faults
    )
    stand_ins = loading.stand_ins(
        loading.csv_rows(layers, ("stand_ins.csv",), loading.STAND_IN_COLUMNS, (0, 2), faults),
        {**objects, **aliases},
        faults,
    )
    placements = loading.placements(
        loading.csv_rows(layers, ("placements.csv",), loading.PLACEMENT_COLUMNS, (0, 1, 2, 3), faults), objects, faults
    )
    actions = _actions(layers, faults)
    derived = loading.derived(loading.yaml_entries(layers, ("derived.yaml",), faults), faults)
    rooms = loading.yaml_entries(layers, ("rooms.yaml",), faults)
    limits = loading.yaml_entries(layers, ("limits.yaml",), faults)
    tables = loading.yaml_entries(layers, ("tables.yaml",), faults)
    object_names = _object_names(objects, aliases, faults)
    if faults:
        return None
    by_class: dict[str, list[str]] = {}
    for alias, name in aliases.items():
        by_class.setdefault(name, []).append(alias)
    return Knowledge(
        actions=actions,
        objects={name: _with_synonyms(thing, by_class) for name, thing in objects.items()},
        rooms=tuple(sorted(rooms)),
        room_standins={name: entry.value["stand_in"] for name, entry in rooms.items() if entry.value},
        state_groups=groups,
        table_like=frozenset(tables["table_like"].value),
        defaults=_default_states(tables["default_states"]),
        derived=derived,
        _action_names=_action_names(actions),
        _object_names={key: _with_synonyms(thing, by_class) for key, thing in object_names.items()},
        _aliases={name: tuple(names) for name, names in by_class.items()},
        _stand_ins=stand_ins,
        _placements=_grouped(placements, 0),
        _held=_grouped(placements, 2),
        _limits={kind: entry.value for kind, entry in limits.items()},
    )


def _actions(layers: list[Path], faults: Faults) -> dict[str, Action]:
    executed = loading.yaml_entries(layers, EXECUTED_FILES, faults)
    written = loading.yaml_entries(layers, WRITTEN_FILES, faults)
    for name in executed.keys() & written.keys():
        faults.add(written[name].file, written[name].line, f"`{name}` is executed; it stands in actions.yaml too")
    grammar = loading.yaml_entries(layers, ("affordances.yaml",), faults)
    return loading.actions({**written, **executed}, frozenset(executed), grammar, faults)


def _action_names(actions: Mapping[str, Action]) -> dict[str, Action]:
    names = {key_of(alias): action for action in actions.values() for alias in action.aliases}
    names.update({key_of(name): action for name, action in actions.items()})
    return {**names, **actions, **{name.upper(): action for name, action in actions.items()}}


def _object_names(
    objects: Mapping[str, ObjectClass], aliases: Mapping[str, str], faults: Faults
) -> dict[str, ObjectClass]:
    """Every spelling without its separators -> class; two classes that cannot be told apart are a fault."""
    names: dict[str, ObjectClass] = {}
    for name, thing in objects.items():
        other = names.setdefault(key_of(name), thing)
        if other is not thing:
            faults.add("", 0, f"`{name}` and `{other.name}` differ in case and separators only")
    for alias, target in aliases.items():
        thing = objects[target]
        other = names.setdefault(key_of(alias), thing)
        if (other.same_as or other.name) != (thing.same_as or thing.name):
            faults.add("", 0, f"`{alias}` may mean `{other.name}` or `{target}`", "let each name mean one class")
    return names


def _with_synonyms(thing: ObjectClass, aliases: Mapping[str, list[str]]) -> ObjectClass:
    from dataclasses import replace

    own = aliases.get(thing.name)
    return replace(thing, synonyms=tuple(own)) if own else thing


def _grouped(placements: list[Placement], column: int) -> dict[str, tuple[Placement, ...]]:
    found: dict[str, list[Placement]] = {}
    for placement in placements:
        found.setdefault(str(placement[column]), []).append(placement)
    return {name: tuple(sorted(rows, key=lambda row: -row.weight)) for name, rows in found.items()}


def _default_states(entry: Entry) -> dict[str, dict[str, tuple[str, ...]]]:
    return {part: _state_lists(value) for part, value in entry.value.items()}


def _state_lists(value: Any) -> dict[str, tuple[str, ...]]:
    return {name: tuple(states) for name, states in value.items()}
