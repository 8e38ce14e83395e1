"""Classes, kinds, synonyms, placements and states, built from their files."""

from collections.abc import Container, Iterable, Mapping
from dataclasses import replace

from hearth.kb.knowledge_records import EDGES, Association, Kind, ObjectClass, Placement, StateGroup
from hearth.kb.loading.entry_shapes import NAMES, parts
from hearth.kb.loading.layers import Layers, check_ids, check_properties, csv_rows, cycles, yaml_entries
from hearth.kb.loading.source_files import Entry, Faults, strings, whole_number
from hearth.schemas.failures import Code

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

_OBJECT_COLUMNS = (
    "id", "name", "category", "hypernym", "properties", "states", "rooms", "size", "gloss", "same_as", "source",
)  # fmt: skip
LONGEST = 1000
"""Metres that no thing has."""

_WEIGHTS = frozenset("012345")
_STATE_SHAPES = dict.fromkeys(("states", "table", "needs", "given_by", "harm"), NAMES)


def load_state_groups(layers: Layers, faults: Faults) -> dict[str, StateGroup]:
    """Return the groups of states, by name."""
    result = {}
    for name, entry in yaml_entries(layers, "states.yaml", faults).items():
        fields = parts(entry.value, _STATE_SHAPES, name, entry, faults)
        states = strings(fields.get("states"))
        result[name] = StateGroup(
            name=name,
            states=states,
            exclusive=fields.get("exclusive") is True,
            simulated=fields.get("simulated") is True,
            table=states if fields.get("table") is True else strings(fields.get("table")),
            needs=check_properties(strings(fields.get("needs")), entry, faults),
            given_by=check_properties(strings(fields.get("given_by")), entry, faults),
            harm=strings(fields.get("harm")),
        )
    return result


def load_kinds(layers: Layers, faults: Faults) -> dict[str, Kind]:
    """Return the kinds above the classes, by name; parents must be kinds and end at one that has none."""
    rows = csv_rows(layers, ("kinds.csv",), ("name", "parent", "gloss"), (0,), faults)
    kinds = {name: Kind(*entry.value) for (name,), entry in rows.items()}
    for name in cycles({name: kind.parent for name, kind in kinds.items() if kind.parent}):
        faults.at(rows[name,], f"`{name}` is a kind of itself in a circle")
    for name, kind in kinds.items():
        if kind.parent and kind.parent not in kinds:
            faults.at(rows[name,], f"`{kind.parent}` is not a known kind")
    return kinds


def load_objects(
    layers: Layers, faults: Faults
) -> tuple[dict[str, ObjectClass], dict[str, StateGroup], dict[str, Kind]]:
    """Every class by name, in the order of the ids, with the groups of states and the kinds they refer to.

    A class that is another's second name (`same_as`) has that one's facts.
    """
    groups, kinds = load_state_groups(layers, faults), load_kinds(layers, faults)
    rows = csv_rows(layers, OBJECT_FILES, _OBJECT_COLUMNS, (1,), faults)
    at = {name: entry for (name,), entry in rows.items()}
    made = {name: _object(entry, groups, faults) for name, entry in at.items()}
    check_ids({name: (thing.id, at[name]) for name, thing in made.items()}, faults)
    circular = set(cycles({name: thing.same_as for name, thing in made.items() if thing.same_as}))
    for name, thing in made.items():
        if name in circular:
            faults.at(at[name], f"`{name}` is a synonym of itself in a circle", "let one have its own facts")
        elif thing.same_as and thing.same_as not in made:
            faults.at(at[name], f"`{thing.same_as}` is not a known object", code=Code.UNKNOWN_OBJECT)
        elif not thing.same_as and thing.hypernym not in kinds and thing.hypernym not in made:
            faults.at(at[name], f"`{thing.hypernym}` is neither a kind nor a class", "see kinds.csv")
    result = made if faults else {name: _twin(thing, made) for name, thing in made.items()}
    return dict(sorted(result.items(), key=lambda item: item[1].id)), groups, kinds


def _object(at: Entry, groups: Mapping[str, StateGroup], faults: Faults) -> ObjectClass:
    number, name, category, hypernym, properties, states, rooms, size, gloss, same_as, source = at.value
    owned = check_properties(properties.split(), at, faults)
    return ObjectClass(
        name=name,
        id=whole_number(number),
        category=category,
        hypernym=hypernym,
        properties=owned,
        states=tuple(sorted(_states(owned, states.split(), groups, at, faults))),
        rooms=tuple(rooms.split()),
        size=_size(size, at, faults),
        gloss=gloss,
        same_as=same_as,
        source=source,
    )


def _states(
    owned: frozenset[str], named: Iterable[str], groups: Mapping[str, StateGroup], at: Entry, faults: Faults
) -> set[str]:
    found = {state for group in groups.values() if group.given_by & owned for state in group.states}
    every = {state for group in groups.values() for state in group.states}
    for name in named:
        if name in groups:
            found.update(groups[name].states)
        elif name in every:
            found.add(name)
        else:
            faults.at(at, f"`{name}` is neither a state nor a group of states", "see states.yaml")
    return found


def _size(text: str, at: Entry, faults: Faults) -> tuple[float, float, float]:
    if not text:
        return (0.0, 0.0, 0.0)
    try:
        width, height, depth = (float(part) for part in text.split())
    except ValueError:
        faults.at(at, f"`{text}` is not a size", "width, height and depth in metres: `0.6 1.8 0.65`")
        return (0.0, 0.0, 0.0)
    if not all(0 <= side < LONGEST for side in (width, height, depth)):  # NaN is not, either
        faults.at(at, f"`{text}` is not a size", f"metres from 0 to {LONGEST}")
    return (width, height, depth)


def _twin(thing: ObjectClass, known: Mapping[str, ObjectClass]) -> ObjectClass:
    """Return a second name with the facts of the class it names; other classes as they are."""
    original = thing
    while original.same_as:
        original = known[original.same_as]
    if original is thing:
        return thing
    gloss = thing.gloss or original.gloss
    return replace(original, name=thing.name, id=thing.id, same_as=original.name, gloss=gloss, source=thing.source)


def load_placements(layers: Layers, known: Container[str], faults: Faults) -> list[Placement]:
    """Every placement, in the order of the file. A row whose weight is 0 takes an earlier layer's away."""
    columns = ("object", "relation", "destination", "room", "weight", "evidence")
    result = []
    for entry in csv_rows(layers, ("placements.csv",), columns, (0, 1, 2, 3), faults).values():
        thing, relation, destination, room, weight, evidence = entry.value
        for name in (thing, destination, *([room] if room else [])):
            if name not in known:
                faults.at(entry, f"`{name}` is not a known object", code=Code.UNKNOWN_OBJECT)
        if relation not in EDGES:
            faults.at(entry, f"`{relation}` is not a known relation", "ON, IN or NEARBY")
        if weight not in _WEIGHTS:
            faults.at(entry, f"`{weight}` is not a weight", "1 (it happens) to 5 (its place); 0 removes")
        elif weight != "0":
            result.append(Placement(thing, relation, destination, room, int(weight), evidence))
    return result


def load_associations(
    layers: Layers, objects: Container[str], actions: Container[str], faults: Faults
) -> tuple[Association, ...]:
    """Classes that are used together, and classes that serve an action.

    A row whose weight is 0 removes an earlier layer's.
    """
    columns = ("name", "relation", "other", "weight", "evidence")
    result = []
    for entry in csv_rows(layers, ("associations.csv",), columns, (0, 1, 2), faults).values():
        name, relation, other, weight, evidence = entry.value
        others = {"goes_with": objects, "serves": actions}.get(relation)
        if name not in objects:
            faults.at(entry, f"`{name}` is not a known object", code=Code.UNKNOWN_OBJECT)
        if others is None:
            faults.at(entry, f"`{relation}` is not a known association", "goes_with or serves")
        elif other not in others:
            faults.at(entry, f"`{other}` is not a known {'object' if relation == 'goes_with' else 'action'}")
        if weight not in _WEIGHTS:
            faults.at(entry, f"`{weight}` is not a weight", "1 to 5; 0 removes")
        elif weight != "0":
            result.append(Association(name, relation, other, int(weight), evidence))
    return tuple(result)


def load_aliases(layers: Layers, known: Container[str], faults: Faults) -> dict[str, str]:
    """Other name -> class. An alias may be of an alias; circles, unknown classes and names of classes are faults."""
    rows = csv_rows(layers, ("aliases.csv",), ("name", "class", "source"), (0,), faults)
    direct = {name: entry.value[1] for (name,), entry in rows.items()}
    circular = set(cycles(direct))
    result = {}
    for name, entry in ((name, entry) for (name,), entry in rows.items()):
        if name in circular:
            faults.at(entry, f"`{name}` is a synonym of itself in a circle", "let one of them mean a class")
            continue
        target = direct[name]
        while target in direct:
            target = direct[target]
        if target not in known:
            faults.at(entry, f"`{target}` is not a known object", code=Code.UNKNOWN_OBJECT)
        elif name in known:
            faults.at(entry, f"`{name}` is a class of its own", f"it cannot also mean `{target}`")
        else:
            result[name] = target
    return result


def load_stand_ins(layers: Layers, known: Container[str], faults: Faults) -> dict[str, tuple[str, ...]]:
    """Class -> what may take its place in a home, best first."""
    columns = ("class", "rank", "stand_in", "source")
    found: dict[str, list[tuple[int, str]]] = {}
    for entry in csv_rows(layers, ("stand_ins.csv",), columns, (0, 2), faults).values():
        name, rank, stand_in, _ = entry.value
        for thing in (name, stand_in):
            if thing not in known:
                faults.at(entry, f"`{thing}` is not a known object", code=Code.UNKNOWN_OBJECT)
        if whole_number(rank) < 0:
            faults.at(entry, f"`{rank}` is not a rank", "1 for the best, then 2, ...")
            continue
        found.setdefault(name, []).append((int(rank), stand_in))
    return {name: tuple(thing for _, thing in sorted(ranked)) for name, ranked in found.items()}
