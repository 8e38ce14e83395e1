"""Choosing a node for each object of a program: one the home has, where the conditions want it, or a new one there."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from operator import and_

from hearth.grounding.environments.partial import Draft
from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.kb.knowledge import Knowledge
from hearth.schemas.literals import CHARACTER, Key
from hearth.schemas.program import Program
from hearth.simulation.world.bits import indices

_LINKS = {"in": "ON", "inside": "INSIDE", "atreach": "CLOSE", "together": "", "facing": "FACING"}


class Wishes:
    """What a program and its conditions ask of each of its objects; made once for many environments.

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
        self.rooms = tuple(key for key in self.uses if knowledge.is_room(key[0]))
        self.locations: dict[Key, Key] = {}
        self.links: dict[Key, list[Condition]] = {}
        for condition in conditions:
            if condition.name == "location":
                self.locations.setdefault(*condition.objects)
            elif condition.name in _LINKS and CHARACTER not in condition.objects:
                self.links.setdefault(_follower(condition), []).append(condition)
        self.keys = self._ordered()

    def _holders(self, key: Key) -> list[Key]:
        """What an object must be in or on: that has to be placed before it."""
        return [_leader(c) for c in self.links.get(key, ()) if c.name in ("in", "inside")]

    def _ordered(self) -> tuple[Key, ...]:
        order: dict[Key, None] = {}

        def visit(key: Key, path: tuple[Key, ...]) -> None:
            if key in order or key in path or any(leader in path for leader in self._holders(key)):
                return
            for condition in self.links.get(key, ()):
                visit(_leader(condition), (*path, key))
            order[key] = None

        for key in self.uses:
            if key not in self.rooms:
                visit(key, ())
        return tuple(order)


_LAST: list[tuple[Program, Preconditions, Wishes]] = []


def wishes_of(program: Program, conditions: Preconditions, knowledge: Knowledge) -> Wishes:
    """The wishes, kept for the next draw: one program is sampled in many homes in turn."""
    if _LAST and _LAST[0][0] is program and _LAST[0][1] is conditions:
        return _LAST[0][2]
    wishes = Wishes(program, conditions, knowledge)
    _LAST[:] = [(program, conditions, wishes)]
    return wishes


def _follower(condition: Condition) -> Key:
    """Which of the two objects is placed by the other: a seat leads what it faces."""
    return condition.objects[1] if condition.name == "facing" else condition.objects[0]


def _leader(condition: Condition) -> Key:
    return condition.objects[0] if condition.name == "facing" else condition.objects[1]


def bind(draft: Draft, wishes: Wishes) -> None:
    """Give every object of the program a node, the rooms first."""
    for key in wishes.rooms:
        rooms = draft.base.rooms(key[0])
        draft.binding[key] = draft.base.home.ids[draft.rng.choice(rooms)]
    for key in wishes.keys:
        node_id = _chosen(draft, wishes, key)
        draft.binding[key] = node_id
        draft.taken.add(node_id)


def _chosen(draft: Draft, wishes: Wishes, key: Key) -> int:
    links = [c for c in wishes.links.get(key, ()) if _leader(c) in draft.binding]
    room = _wanted_room(draft, wishes, key, links)
    placing = next((c for c in links if c.name in ("in", "inside")), None)
    candidates = _candidates(draft, wishes, key, room, in_sight=placing is None)
    fitting = [i for i in candidates if all(_linked(draft, i, c) for c in links)]
    home = draft.base.home
    if fitting:
        return home.ids[draft.rng.choice(fitting)]
    if candidates and placing is None:
        # Being at reach, facing or in one room can be arranged without moving anything.
        return home.ids[draft.rng.choice(candidates)]
    loose = [
        i for i in candidates if home.properties["GRABBABLE"] >> i & 1 and not home.bears[i] and not home.contents[i]
    ]
    if loose:
        node_id = home.ids[draft.rng.choice(loose)]
        draft.lift(node_id)
        draft.settle(node_id, room if room >= 0 else draft.room_of(node_id))
    else:
        node_id = draft.add(key[0], room if room >= 0 else _any_room(draft, key))
    if placing is not None:
        draft.put(node_id, _LINKS[placing.name], draft.binding[_leader(placing)])
    elif node_id in draft.new:
        put_back = any(action == "PutObjBack" for action, _ in wishes.uses[key])
        put_where_it_belongs(draft, key[0], node_id, room, must=put_back)
    return node_id


def _wanted_room(draft: Draft, wishes: Wishes, key: Key, links: Sequence[Condition]) -> int:
    """Id of the room an object has to be in, or -1: that of what it is placed by, else the one its location names."""
    for condition in links:
        room = draft.room_of(draft.binding[_leader(condition)])
        if room >= 0:
            return room
    location = wishes.locations.get(key)
    if location is not None and location in draft.binding:
        return draft.binding[location]
    for follower, conditions in wishes.links.items():
        if any(_leader(c) == key for c in conditions) and follower in wishes.locations:
            return draft.binding.get(wishes.locations[follower], -1)
    return -1


def _candidates(draft: Draft, wishes: Wishes, key: Key, room: int, in_sight: bool) -> list[int]:
    """Indices of the home's own things that could be the object: unused, affording its uses, in the room."""
    home = draft.base.home
    able = reduce(and_, (home.able(action, position) for action, position in wishes.uses[key]), home.everything)
    ids, rooms = home.ids, draft.base.room
    closed = home.states[0] & ~home.rooms
    return [
        i
        for i in draft.base.instances(key[0])
        if able >> i & 1
        and ids[i] not in draft.taken
        and (room < 0 or (rooms[i] >= 0 and ids[rooms[i]] == room))
        and not (in_sight and home.inside[i] & closed)
    ]


def _linked(draft: Draft, i: int, condition: Condition) -> bool:
    """Whether the home's own edges already meet a condition."""
    home = draft.base.home
    leader = home.index.get(draft.binding[_leader(condition)])
    if leader is None or home.ids[leader] in draft.room:
        return False
    if condition.name == "in":
        return bool(home.on[i] >> leader & 1)
    if condition.name == "inside":
        return bool(home.inside[i] >> leader & 1)
    if condition.name == "atreach":
        return bool(home.close[i] >> leader & 1)
    if condition.name == "facing":
        return bool(home.facing[leader] >> i & 1)
    return True


def _any_room(draft: Draft, key: Key) -> int:
    """A room where things of the class belong, else any."""
    home = draft.base.home
    thing = draft.base.knowledge.object_class(key[0])
    usual = [i for name in (thing.rooms if thing else ()) for i in indices(home.by_class.get(name, 0) & home.rooms)]
    return home.ids[draft.rng.choice(usual or list(indices(home.rooms)))]


def put_where_it_belongs(draft: Draft, name: str, node_id: int, room: int, must: bool) -> None:
    """On or in something open, in the room if one is wanted. Where nothing suits it stays in its room, or, if it must
    stand somewhere, on any piece of furniture there.
    """
    home, base = draft.base.home, draft.base
    spots = base.spots(name)
    closed = home.states[0]
    good = [
        (i, relation, weight)
        for (_, i, relation), weight in zip(spots.choices, spots.each, strict=True)
        if (room < 0 or (base.room[i] >= 0 and home.ids[base.room[i]] == room))
        and home.ids[i] not in draft.taken
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
    if good:
        ((i, relation, _),) = draft.rng.choices(good, [weight for _, _, weight in good])
        if room < 0 and base.room[i] >= 0:
            draft.added.remove(next(e for e in draft.added if e.source == node_id and e.relation == "INSIDE"))
            draft.settle(node_id, home.ids[base.room[i]])
        draft.put(node_id, relation, home.ids[i])
