"""Layout -> scene graph: nodes with stable ids, classes, properties and default states, and their edges."""

from collections.abc import Iterable, Mapping
from operator import attrgetter

from hearth.homes.plans.home_shell import Thing
from hearth.homes.plans.layout import Layout
from hearth.homes.relations import edges
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph, Node
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, FIRST_ADDED_ID, PROPERTY_ID, ROOM_CATEGORY, STATE_ID


def scene(layout: Layout, knowledge: Knowledge) -> EnvironmentGraph:
    """Return the home's graph, nodes in the order of their ids, in its default states (semantics.

    Preparing an environment).

    Raises:
        HearthError: more things than ids below `FIRST_ADDED_ID`.
    """
    things = every_thing(layout)
    ids = node_ids((thing.name for thing in things), layout.plan.ids, layout.plan.file)
    lookable = frozenset(name for name, known in knowledge.objects.items() if "LOOKABLE" in known.properties)
    kinds = {name: _kind(name, knowledge) for name in {thing.class_name for thing in things}}
    nodes = sorted((_node(thing, ids[thing.name], kinds[thing.class_name]) for thing in things), key=attrgetter("id"))
    return EnvironmentGraph(tuple(nodes), edges(things, ids, lookable))


def every_thing(layout: Layout) -> list[Thing]:
    """Rooms each with all that is in it, then the character: the order in which new ids are given."""
    found: list[Thing] = []
    for room in layout.rooms():
        found.append(room)
        found.extend(thing for thing in layout.things if thing.room == room.room)
    found.append(layout.character)
    return found


def node_ids(names: Iterable[str], fixed: Mapping[str, int], file: str = "") -> dict[str, int]:
    """Node ids by name: the fixed ones; then, for names that have none, the numbers after all fixed ones.

    Raises:
        HearthError: an id reaches `FIRST_ADDED_ID`.
    """
    ids: dict[str, int] = {}
    following = max(fixed.values(), default=0) + 1
    for name in names:
        if name in fixed:
            ids[name] = fixed[name]
        else:
            ids[name] = following
            following += 1
    if following > FIRST_ADDED_ID:
        message = f"{len(ids):,} things, but a home's own ids end at {FIRST_ADDED_ID - 1}"
        raise HearthError.of(Code.NO_PLACE, message, file=file, suggestion="plan fewer things")
    return ids


Kind = tuple[str, tuple[str, ...], tuple[str, ...]]
"""A class's category, properties and default states."""


def _kind(class_name: str, knowledge: Knowledge) -> Kind:
    known = knowledge.objects[class_name]
    plain = known.category in (ROOM_CATEGORY, CHARACTER_CATEGORY)
    states = () if plain else knowledge.default_states(class_name)
    return (
        known.category,
        tuple(sorted(known.properties, key=PROPERTY_ID.__getitem__)),
        tuple(sorted(states, key=STATE_ID.__getitem__)),
    )


def _node(thing: Thing, node_id: int, kind: Kind) -> Node:
    category, properties, states = kind
    return Node(node_id, thing.class_name, category, properties, states, box=thing.box, yaw=thing.yaw)
