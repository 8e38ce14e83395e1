"""Building the records from the files: one function a subject. Faults are collected, never raised here."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path
from typing import Any, TypeVar

from hearth.kb.formula import TRUE, And, Atom, Effect, Formula, parse_atom, parse_effect, parse_formula
from hearth.kb.reading import Entry, Faults, merged, read_csv, read_yaml, strings
from hearth.kb.records import EDGES, Action, Condition, ObjectClass, Placement, Requirement, StateGroup
from hearth.schemas.errors import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.vocabulary import PROPERTIES

OBJECT_COLUMNS = (
    "id", "name", "category", "hypernym", "properties", "states", "rooms", "size", "gloss", "same_as", "source",
)  # fmt: skip
PLACEMENT_COLUMNS = ("object", "relation", "destination", "room", "weight", "evidence")
ALIAS_COLUMNS = ("name", "class", "source")
STAND_IN_COLUMNS = ("class", "rank", "stand_in", "source")

_KNOWN_PROPERTIES = frozenset(PROPERTIES)
_WEIGHTS = frozenset("012345")

Rows = Mapping[tuple[str, ...], tuple[tuple[str, ...], str, int]]
"""What `csv_rows` gives: identifying cells -> (cells, file, line)."""

T = TypeVar("T")


def yaml_entries(layers: Iterable[Path], names: Iterable[str], faults: Faults) -> dict[str, Entry]:
    """The entries of some YAML files over all layers; what a later layer says of a name replaces what an earlier said."""
    found: list[dict[str, Entry]] = []
    for layer in layers:
        own: dict[str, Entry] = {}
        for name in names:
            if (layer / name).exists():
                for key, entry in read_yaml(layer / name, faults).items():
                    if key in own:
                        faults.add(entry.file, entry.line, f"`{key}` stands in {Path(own[key].file).name} too")
                    own[key] = entry
        found.append(own)
    return merged(list(found))


def csv_rows(
    layers: Iterable[Path], names: Iterable[str], columns: tuple[str, ...], key: tuple[int, ...], faults: Faults
) -> dict[tuple[str, ...], tuple[tuple[str, ...], str, int]]:
    """Rows of some CSV files by the cells that identify them, as (cells, file, line); later layers replace rows."""
    result: dict[tuple[str, ...], tuple[tuple[str, ...], str, int]] = {}
    for layer in layers:
        own: dict[tuple[str, ...], tuple[tuple[str, ...], str, int]] = {}
        for name in names:
            path = layer / name
            if not path.exists():
                continue
            file = str(path)
            for cells, line in read_csv(path, columns, faults):
                mark = tuple([cells[column] for column in key])
                if mark in own:
                    faults.add(file, line, f"`{', '.join(mark)}` stands twice, first in {own[mark][1]}:{own[mark][2]}")
                own[mark] = (cells, file, line)
        result.update(own)
    return result


# Actions


def requirement(value: Any, entry: Entry, faults: Faults) -> Requirement:
    """Read `anything`, `object` or `{any, all, classes, contains, also, never}`."""
    if value == "anything":
        return Requirement(anything=True)
    if value == "object":
        return Requirement(anything=True, no_rooms=True)
    if not isinstance(value, dict):
        faults.add(entry.file, entry.line, f"`{value}` is no requirement", "anything, object, or a mapping")
        return Requirement()
    for key in value.keys() - {"any", "all", "classes", "contains", "also", "never"}:
        faults.add(entry.file, entry.line, f"`{key}` is not part of a requirement")
    for name in (*strings(value.get("any")), *strings(value.get("all"))):
        check_property(name, entry.file, entry.line, faults)
    return Requirement(
        any_of=frozenset(strings(value.get("any"))),
        all_of=frozenset(strings(value.get("all"))),
        classes=frozenset(strings(value.get("classes"))),
        contains=strings(value.get("contains")),
        also=frozenset(value.get("also") or ()),
        never=frozenset(value.get("never") or ()),
    )


def actions(
    entries: Mapping[str, Entry], executed: frozenset[str], grammar: Mapping[str, Entry], faults: Faults
) -> dict[str, Action]:
    """Every action by name, in the order of the ids."""
    result = {}
    for name, entry in entries.items():
        if not isinstance(entry.value, dict):
            faults.add(entry.file, entry.line, f"`{name}` is not a mapping")
            continue
        result[name] = _action(name, entry, name in executed, entries, grammar.get(name), faults)
    for name in grammar.keys() - result.keys():
        faults.add(grammar[name].file, grammar[name].line, f"`{name}` is no action", code=Code.UNKNOWN_ACTION)
    _check_ids({name: (action.id, entries[name].file, entries[name].line) for name, action in result.items()}, faults)
    return dict(sorted(result.items(), key=lambda item: item[1].id))


_ACTION_KEYS = frozenset({"id", "roles", "needs", "before", "effects", "say", "words", "aliases", "source"})


def _action(
    name: str, entry: Entry, executed: bool, entries: Mapping[str, Entry], grammar: Entry | None, faults: Faults
) -> Action:
    fields = entry.value
    for key in fields.keys() - _ACTION_KEYS:
        faults.add(entry.file, entry.line, f"`{key}` is not part of an action", ", ".join(sorted(_ACTION_KEYS)))
    roles = strings(fields.get("roles"))
    needs = tuple(requirement(value, entry, faults) for value in fields.get("needs") or ())
    accepts = tuple(requirement(value, grammar, faults) for value in grammar.value) if grammar else needs
    if not len(roles) == len(needs) == len(accepts):
        faults.add(
            entry.file, entry.line, f"{name} has {len(roles)} roles, {len(needs)} needs, {len(accepts)} in grammar"
        )
    return Action(
        name=name,
        id=fields["id"] if isinstance(fields.get("id"), int) else -1,
        executed=executed,
        roles=roles,
        needs=needs,
        grammar=accepts,
        preconditions=tuple(_conditions(fields.get("before") or (), entry, faults)),
        effects=tuple(_effects(fields.get("effects") or (), entry, entries, faults)),
        template=fields.get("say") or name,
        words=strings(fields.get("words")),
        aliases=strings(fields.get("aliases")),
        source=fields.get("source") or "release",
    )


def _conditions(rows: Iterable[Any], entry: Entry, faults: Faults) -> Iterable[Condition]:
    for row in rows:
        option = row.get("option", "") if isinstance(row, dict) else ""
        checks = [(k, v) for k, v in row.items() if k != "option"] if isinstance(row, dict) else []
        if len(checks) != 1 or checks[0][0] not in Code.__members__:
            faults.add(entry.file, entry.line, f"`{row}` is no check", "write `FAILURE_CODE: formula`")
            continue
        formula = parsed(parse_formula, checks[0][1], entry.file, entry.line, faults)
        if formula is not None:
            yield Condition(formula, Code[checks[0][0]], option)


def _effects(rows: Iterable[Any], entry: Entry, entries: Mapping[str, Entry], faults: Faults) -> Iterable[Effect]:
    for row in rows:
        if isinstance(row, str):
            effect = parsed(parse_effect, row, entry.file, entry.line, faults)
            if effect is not None:
                yield effect
        elif isinstance(row, dict) and row.get("like") in entries:
            when = parsed(parse_formula, row["when"], entry.file, entry.line, faults) if "when" in row else TRUE
            for effect in _effects(entries[row["like"]].value["effects"], entry, entries, faults):
                yield under(when or TRUE, effect)
        else:
            faults.add(entry.file, entry.line, f"`{row}` is no effect", "write a change, or `like: Action`")


def under(condition: Formula, effect: Effect) -> Effect:
    """The effect, made to depend on one more condition."""
    if condition == TRUE:
        return effect
    both = condition if effect.condition == TRUE else And((condition, effect.condition))
    return Effect(effect.atom, effect.delete, both, effect.variables)


def parsed(parser: Callable[[str], T], text: Any, file: str, line: int, faults: Faults) -> T | None:
    """What the parser makes of the text; None, and a fault with its place, when it cannot."""
    try:
        return parser(str(text))
    except HearthError as error:
        faults.extend(replace(fault, file=file, line=line) for fault in error.diagnostics)
        return None


def derived(entries: Mapping[str, Entry], faults: Faults) -> dict[str, tuple[Atom, Formula]]:
    """Definitions by predicate: `close` -> (close(a, x), its formula)."""
    result = {}
    for head, entry in entries.items():
        atom = parsed(parse_atom, head, entry.file, entry.line, faults)
        body = parsed(parse_formula, entry.value, entry.file, entry.line, faults)
        if atom is not None and body is not None:
            result[atom.name] = (atom, body)
    return result


# Objects


def objects(rows: Rows, groups: Mapping[str, StateGroup], faults: Faults) -> dict[str, ObjectClass]:
    """Every class by name, in the order of the ids; a class that is another's second name has that one's facts."""
    result: dict[str, ObjectClass] = {}
    for cells, file, line in rows.values():
        made = _object(cells, groups, file, line, faults)
        result[made.name] = made
    places = {cells[1]: (file, line) for cells, file, line in rows.values()}
    _check_ids({name: (made.id, *places[name]) for name, made in result.items()}, faults)
    for name in cycles({made.name: made.same_as for made in result.values() if made.same_as}):
        faults.add(*places[name], f"`{name}` is the same as itself in a circle", "let one of them have its own facts")
    for name, made in result.items():
        if made.same_as and made.same_as not in result:
            faults.add(*places[name], f"`{name}` is the same as `{made.same_as}`, which is unknown")
    if not faults:
        result = {name: _twin(made, result) for name, made in result.items()}
    return dict(sorted(result.items(), key=lambda item: item[1].id))


def _object(
    cells: tuple[str, ...], groups: Mapping[str, StateGroup], file: str, line: int, faults: Faults
) -> ObjectClass:
    number, name, category, hypernym, properties, states, rooms, size, gloss, same_as, source = cells
    owned = frozenset(properties.split())
    for unknown in owned - _KNOWN_PROPERTIES:
        check_property(unknown, file, line, faults)
    if not number.isdecimal():
        faults.add(file, line, f"`{number}` is no id", "a number that no other class has")
    return ObjectClass(
        name=name,
        id=int(number) if number.isdecimal() else -1,
        category=category,
        hypernym=hypernym,
        properties=owned,
        states=tuple(sorted(_states(owned, states.split(), groups, file, line, faults))),
        rooms=tuple(rooms.split()),
        size=_size(size, file, line, faults),
        gloss=gloss,
        same_as=same_as,
        source=source,
    )


def _states(
    owned: frozenset[str], named: list[str], groups: Mapping[str, StateGroup], file: str, line: int, faults: Faults
) -> set[str]:
    found = {state for group in groups.values() if group.given_by & owned for state in group.states}
    every = {state for group in groups.values() for state in group.states}
    for name in named:
        if name in groups:
            found.update(groups[name].states)
        elif name in every:
            found.add(name)
        else:
            faults.add(file, line, f"`{name}` is neither a state nor a group of states", "see states.yaml")
    return found


def _size(text: str, file: str, line: int, faults: Faults) -> tuple[float, float, float]:
    if not text:
        return (0.0, 0.0, 0.0)
    try:
        width, height, depth = (float(part) for part in text.split())
    except ValueError:
        faults.add(file, line, f"`{text}` is no size", "width height depth in metres, as `0.6 1.8 0.65`")
        return (0.0, 0.0, 0.0)
    return (width, height, depth)


def _twin(made: ObjectClass, all_classes: Mapping[str, ObjectClass]) -> ObjectClass:
    original = made
    while original.same_as:
        original = all_classes[original.same_as]
    if original is made:
        return made
    return replace(
        original,
        name=made.name,
        id=made.id,
        same_as=original.name,
        gloss=made.gloss or original.gloss,
        source=made.source,
    )


def placements(rows: Rows, known: Mapping[str, ObjectClass], faults: Faults) -> list[Placement]:
    """Every placement, in the order of the file. A row whose weight is 0 takes an earlier layer's away."""
    result = []
    for (name, relation, destination, room, weight, evidence), file, line in rows.values():
        for thing in (name, destination, room):
            if thing and thing not in known:
                faults.add(file, line, f"`{thing}` is no object", code=Code.UNKNOWN_OBJECT)
        if relation not in EDGES:
            faults.add(file, line, f"`{relation}` is no relation", "ON, IN or NEARBY")
        if weight not in _WEIGHTS:
            faults.add(file, line, f"`{weight}` is no weight", "1 (it happens) to 5 (its place); 0 removes")
        elif weight != "0":
            result.append(Placement(name, relation, destination, room, int(weight), evidence))
    return result


def aliases(rows: Rows, known: Mapping[str, ObjectClass], faults: Faults) -> dict[str, str]:
    """Other name -> class. An alias may be of an alias; circles, unknown classes and names of classes are faults."""
    direct = {cells[0]: cells[1] for cells, _, _ in rows.values()}
    places = {cells[0]: (file, line) for cells, file, line in rows.values()}
    circular = set(cycles(direct))
    result = {}
    for name, target in direct.items():
        while target in direct and name not in circular:
            target = direct[target]
        if name in circular:
            faults.add(*places[name], f"`{name}` is a synonym of itself in a circle", "point one of them at a class")
        elif target not in known:
            faults.add(
                *places[name], f"`{name}` is said to be `{target}`, which is no object", code=Code.UNKNOWN_OBJECT
            )
        elif name in known:
            faults.add(*places[name], f"`{name}` is a class of its own and cannot also be `{target}`")
        else:
            result[name] = target
    return result


def cycles(links: Mapping[str, str]) -> list[str]:
    """The names from which following the links never ends."""
    endless = []
    for name in links:
        seen = {name}
        target = links[name]
        while target in links and target not in seen:
            seen.add(target)
            target = links[target]
        if target in seen:
            endless.append(name)
    return endless


def stand_ins(rows: Rows, known: Mapping[str, Any], faults: Faults) -> dict[str, tuple[str, ...]]:
    """Class -> what may take its place in a home, best first."""
    found: dict[str, list[tuple[int, str]]] = {}
    for (name, rank, stand_in, _), file, line in rows.values():
        for thing in (name, stand_in):
            if thing not in known:
                faults.add(file, line, f"`{thing}` is no object", code=Code.UNKNOWN_OBJECT)
        found.setdefault(name, []).append((int(rank) if rank.isdecimal() else 0, stand_in))
    return {name: tuple(thing for _, thing in sorted(ranked)) for name, ranked in found.items()}


def state_groups(entries: Mapping[str, Entry], faults: Faults) -> dict[str, StateGroup]:
    """The groups of states, by name."""
    result = {}
    for name, entry in entries.items():
        fields = entry.value
        states = strings(fields.get("states"))
        for prop in (*strings(fields.get("needs")), *strings(fields.get("given_by"))):
            check_property(prop, entry.file, entry.line, faults)
        result[name] = StateGroup(
            name=name,
            states=states,
            exclusive=fields.get("exclusive") is True,
            simulated=fields.get("simulated") is True,
            table=states if fields.get("table") is True else strings(fields.get("table")),
            needs=frozenset(strings(fields.get("needs"))),
            given_by=frozenset(strings(fields.get("given_by"))),
        )
    return result


# Shared


def check_property(name: str, file: str, line: int, faults: Faults) -> None:
    """Note a property that the vocabulary does not have, with the nearest that it has."""
    if name not in _KNOWN_PROPERTIES:
        near = get_close_matches(name.upper(), PROPERTIES, 1, 0.5)
        faults.add(file, line, f"`{name}` is no property", f"did you mean `{near[0]}`?" if near else "")


def _check_ids(owners: Mapping[str, tuple[int, str, int]], faults: Faults) -> None:
    """Ids are whole numbers and never shared: they are published."""
    taken: dict[int, str] = {}
    for name, (number, file, line) in owners.items():
        if number < 0:
            faults.add(file, line, f"`{name}` has no id")
        elif number in taken:
            faults.add(
                file, line, f"`{name}` has the id {number}, as `{taken[number]}` has", "take a number not in use"
            )
        taken.setdefault(number, name)
