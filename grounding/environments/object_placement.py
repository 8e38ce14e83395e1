"""Choosing a node for each object of a program: one the home has, where the conditions want it, or a new one there."""

from collections.abc import Sequence
from functools import reduce
from operator import and_

from hearth.grounding.environments.environment_draft import PartialEnvironment
from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.kb.knowledge import Knowledge
from hearth.schemas.literals import CHARACTER, Key
from hearth.schemas.program import Program
from hearth.simulation.actions.origins import remembered
from hearth.simulation.rules import DEFAULT
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home

USUAL_PLACE = 4
"""The weight of a placement that is usual; rarer ones are for homes that differ: milk in a trashcan."""

_LINKS = {"in": "ON", "inside": "INSIDE", "atreach": "CLOSE", "together": "", "facing": "FACING"}


class Requirements:
    """The requirements of a program and its conditions on each of its objects; made once for many environments.

    Attributes:
        keys: the objects, each after those it is placed by.
        uses: for each object, the (action, position) pairs it must afford.
        locations: the room each must be in, as a key.
        links: for each object, the conditions that place it by another.
    """

    def __init__(self, program: Program, conditions: Preconditions, knowledge: Knowledge) -> None:
        self.uses: dict[Key, list[tuple[str, int]]] = {}
        for step in program.steps:
            for position, ref in enumerate(step.objects):
                self.uses.setdefault(ref.key, []).append((step.action, position))
        named = (*self.uses, *(key for condition in conditions for key in condition.objects))
        self.rooms = tuple(key for key in dict.fromkeys(named) if knowledge.is_room(key[0]))
        self.locations: dict[Key, Key] = {}
        self.links: dict[Key, list[Condition]] = {}
        for condition in conditions:
            if condition.name == "location":
                self.locations.setdefault(*condition.objects)
            elif condition.name in _LINKS and CHARACTER not in condition.objects:
                self.links.setdefault(_follower(condition), []).append(condition)
        self.keys = self._ordered()

    def _holders(self, key: Key) -> list[Key]:
        """Return the support or container of an object, which is placed before it."""
        return [_anchor(c) for c in self.links.get(key, ()) if c.name in ("in", "inside")]

    def _ordered(self) -> tuple[Key, ...]:
        order: dict[Key, None] = {}

        def visit(key: Key, path: tuple[Key, ...]) -> None:
            if key in order or key in path or any(anchor in path for anchor in self._holders(key)):
                return
            for condition in self.links.get(key, ()):
                visit(_anchor(condition), (*path, key))
            order[key] = None

        for key in self.uses:
            if key not in self.rooms:
                visit(key, ())
        return tuple(order)


_LAST: list[tuple[Program, Preconditions, Requirements]] = []


def requirements_of(program: Program, conditions: Preconditions, knowledge: Knowledge) -> Requirements:
    """Return the requirements, kept for the next draw: one program is sampled in many homes in turn."""
    if _LAST and _LAST[0][0] is program and _LAST[0][1] is conditions:
        return _LAST[0][2]
    requirements = Requirements(program, conditions, knowledge)
    _LAST[:] = [(program, conditions, requirements)]
    return requirements


def _follower(condition: Condition) -> Key:
    """Return the object by which the other one of a condition is placed.

    A seat is the anchor of the object that it faces.
    """
    return condition.objects[1] if condition.name == "facing" else condition.objects[0]


def _anchor(condition: Condition) -> Key:
    return condition.objects[0] if condition.name == "facing" else condition.objects[1]


def bind(partial: PartialEnvironment, requirements: Requirements) -> None:
    """Give every object of the program a node, the rooms first."""
    for key in requirements.rooms:
        rooms = partial.base.rooms(key[0])
        partial.binding[key] = partial.base.home.ids[partial.rng.choice(rooms)]
    for key in requirements.keys:
        node_id = _chosen(partial, requirements, key)
        partial.binding[key] = node_id
        partial.taken.add(node_id)


def _chosen(partial: PartialEnvironment, requirements: Requirements, key: Key) -> int:
    links = [c for c in requirements.links.get(key, ()) if _anchor(c) in partial.binding]
    room = _wanted_room(partial, requirements, key, links)
    placing = next((c for c in links if c.name in ("in", "inside")), None)
    candidates = _candidates(partial, requirements, key, room, in_sight=placing is None)
    fitting = [i for i in candidates if all(_linked(partial, i, c) for c in links)]
    home = partial.base.home
    if fitting:
        return home.ids[partial.rng.choice(fitting)]
    if candidates and placing is None:
        # Being at reach, facing or in one room can be arranged without moving anything.
        return home.ids[partial.rng.choice(candidates)]
    movable = _movable(home, candidates)
    if not movable and partial.sparing:
        movable = _movable(home, _candidates(partial, requirements, key, -1, in_sight=False))
    if movable:
        node_id = home.ids[partial.rng.choice(movable)]
        settled = room if room >= 0 else partial.room_of(node_id)
        partial.lift(node_id)
        partial.settle(node_id, settled)
    else:
        node_id = partial.add(key[0], room if room >= 0 else _any_room(partial, key))
    if placing is not None:
        partial.put(node_id, _LINKS[placing.name], partial.binding[_anchor(placing)])
    elif node_id in partial.new or node_id in partial.room:
        put_where_it_belongs(partial, key[0], node_id, room, must=_put_back(requirements, key))
    return node_id


def _movable(home: Home, candidates: Sequence[int]) -> list[int]:
    """Return the things that can be taken elsewhere, with nothing on or in them."""
    return [i for i in candidates if home.properties["GRABBABLE"] >> i & 1 and not home.bears[i] | home.contents[i]]


def _wanted_room(partial: PartialEnvironment, requirements: Requirements, key: Key, links: Sequence[Condition]) -> int:
    """Return the id of the room an object has to be in, or -1: that of its anchor, else the one its location names."""
    for condition in links:
        room = partial.room_of(partial.binding[_anchor(condition)])
        if room >= 0:
            return room
    location = requirements.locations.get(key)
    if location is not None and location in partial.binding:
        return partial.binding[location]
    for follower, conditions in requirements.links.items():
        if any(_anchor(c) == key for c in conditions) and follower in requirements.locations:
            return partial.binding.get(requirements.locations[follower], -1)
    return -1


def _candidates(
    partial: PartialEnvironment, requirements: Requirements, key: Key, room: int, in_sight: bool
) -> list[int]:
    """Return indices of the home's own things that could be the object: unused, affording its uses, in the room."""
    home = partial.base.home
    able = reduce(
        and_, (home.able(action, position) for action, position in requirements.uses.get(key, ())), home.everything
    )
    ids, rooms, start = home.ids, partial.base.room, partial.base.start
    closed = home.states[0] & ~home.rooms
    put_back = _put_back(requirements, key)
    return [
        i
        for i in partial.base.instances(key[0])
        if able >> i & 1
        and ids[i] not in partial.taken
        and (room < 0 or (rooms[i] >= 0 and ids[rooms[i]] == room))
        and not (in_sight and home.inside[i] & closed)
        and not (put_back and remembered(start, start.agents[0], i, DEFAULT)[0] < 0)
    ]


def _put_back(requirements: Requirements, key: Key) -> bool:
    """Return whether the program puts an object back where it came from, and so needs it to come from somewhere."""
    return any(action == "PutObjBack" for action, _ in requirements.uses.get(key, ()))


def _linked(partial: PartialEnvironment, i: int, condition: Condition) -> bool:
    """Return whether the home's own edges already meet a condition."""
    home = partial.base.home
    anchor = home.index.get(partial.binding[_anchor(condition)])
    if anchor is None or home.ids[anchor] in partial.room:
        return False
    if condition.name == "in":
        return bool(home.on[i] >> anchor & 1)
    if condition.name == "inside":
        return bool(home.inside[i] >> anchor & 1)
    if condition.name == "atreach":
        return bool(home.close[i] >> anchor & 1)
    if condition.name == "facing":
        return bool(home.facing[anchor] >> i & 1)
    return True


def _any_room(partial: PartialEnvironment, key: Key) -> int:
    """Return a room where things of the class belong, else any."""
    home = partial.base.home
    thing = partial.base.knowledge.object_class(key[0])
    usual = [i for name in (thing.rooms if thing else ()) for i in indices(home.by_class.get(name, 0) & home.rooms)]
    return home.ids[partial.rng.choice(usual or list(indices(home.rooms)))]


def put_where_it_belongs(partial: PartialEnvironment, name: str, node_id: int, room: int, must: bool) -> None:
    """On or in something open, in the room if one is wanted. Where nothing suits it stays in its room, or, if it must
    stand somewhere, on any piece of furniture there.
    """
    home, base = partial.base.home, partial.base
    spots = base.spots(name)
    closed = home.states[0]
    good = [
        (i, relation, weight)
        for (_, i, relation), weight in zip(spots.choices, spots.each, strict=True)
        if (room < 0 or (base.room[i] >= 0 and home.ids[base.room[i]] == room))
        and home.ids[i] not in partial.taken
        and not (relation == "INSIDE" and closed >> i & 1)
        and not home.properties["SITTABLE"] >> i & 1
    ]
    if not good and must:
        surfaces = home.properties["SURFACES"] & home.furniture
        good = [
            (i, "ON", 1)
            for i in indices(surfaces)
            if room < 0 or (base.room[i] >= 0 and home.ids[base.room[i]] == room)
        ]
    if partial.sparing:
        usual = min(USUAL_PLACE, max((weight for _, _, weight in good), default=0))
        good = [each for each in good if each[2] >= usual]
    if good:
        ((i, relation, _),) = partial.rng.choices(good, [weight for _, _, weight in good])
        if room < 0 and base.room[i] >= 0:
            partial.added.remove(next(e for e in partial.added if e.source == node_id and e.relation == "INSIDE"))
            partial.settle(node_id, home.ids[base.room[i]])
        partial.put(node_id, relation, home.ids[i])
