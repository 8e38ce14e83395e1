"""Satisfying violated conditions: things in other rooms, closed containers, on seats or in hands (thesis 5.5.4)."""

from collections.abc import Callable

from hearth.grounding.environments.default_state import Base
from hearth.grounding.environments.environment_draft import PartialEnvironment
from hearth.grounding.preconditions.conditions import Condition
from hearth.schemas.graph import Edge
from hearth.schemas.literals import HANDS, Key
from hearth.simulation.literal_truth import PETS
from hearth.simulation.world.bits import indices

Target = tuple[int, str]
"""Index of a place, and ON or INSIDE it."""


def not_near(partial: PartialEnvironment, condition: Condition) -> None:
    """Move the first object out of reach of a character at the second."""
    key, anchor = condition.objects
    around = _around(partial, partial.binding[anchor])
    if not _beside(partial, partial.binding[key]) & around:
        return
    room = partial.room_of(partial.binding[key])

    def fits(spot: Target) -> bool:
        return not _bearing(partial, spot[0]) & around

    if not _moved(partial, key, lambda s: fits(s) and _room_of(partial, s) == room) and not _moved(partial, key, fits):
        _to_floor(partial, key, lambda other: other != room)


def other_room(partial: PartialEnvironment, condition: Condition) -> None:
    """The first object is in another room than the second, which is a room."""
    key = condition.objects[0]
    room = partial.binding[condition.objects[1]]
    if partial.room_of(partial.binding[key]) == room and not _moved(
        partial, key, lambda s: _is_open(partial, s) and _room_of(partial, s) != room
    ):
        _to_floor(partial, key, lambda other: other != room)


def in_closed_container(partial: PartialEnvironment, condition: Condition) -> None:
    """The first object is in a closed container where it belongs, other than the second; if possible one not
    named by the program.
    """
    key, now = condition.objects
    ids, here = partial.base.home.ids, partial.binding.get(now, -1)

    def fits(spot: Target) -> bool:
        return closes(partial.base, spot) and ids[spot[0]] != here

    if _moved(partial, key, fits) or _moved(partial, key, fits, named=True):
        partial.set_state(partial.where[partial.binding[key]][1], "CLOSED")


def closes(base: Base, spot: Target) -> bool:
    """Return whether that is inside something that can be opened and is closed in the home's default state."""
    home = base.home
    return spot[1] == "INSIDE" and bool((home.able("Open") & home.states[0]) >> spot[0] & 1)


def facing_away(partial: PartialEnvironment, condition: Condition) -> None:
    """The first object faces away from the second."""
    one, other = (partial.binding[key] for key in condition.objects)
    partial.added[:] = [edge for edge in partial.added if edge != Edge(one, "FACING", other)]
    if one in partial.base.home.index and other in partial.base.home.index:
        partial.removed.append(Edge(one, "FACING", other))


def full_hands(partial: PartialEnvironment, condition: Condition) -> None:
    """The character's hands hold things that the program does not use."""
    me = partial.base.character
    taken = {edge.relation for edge in partial.added if edge.source == me}
    fillers = partial.base.fillers.choices
    for hand in HANDS:
        if hand not in taken and fillers:
            node_id = partial.add(partial.rng.choice(fillers)[0], -1)
            partial.added.append(Edge(me, hand, node_id))
            partial.close(me, node_id)


def doors_closed(partial: PartialEnvironment, condition: Condition) -> None:
    """Every door of the room that the object is, or is in, is closed."""
    home = partial.base.home
    room = partial.room_of(partial.binding[condition.objects[0]])
    if room < 0:
        return
    index = home.index[room]
    for door in indices(home.doors & home.able("Close")):
        if home.between[door] >> index & 1:
            partial.set_state(home.ids[door], "CLOSED")


def pet(partial: PartialEnvironment, condition: Condition) -> None:
    """A cat or a dog is on the seat."""
    seat = partial.binding[condition.objects[0]]
    node_id = partial.add(partial.rng.choice(PETS), partial.room_of(seat))
    partial.put(node_id, "ON", seat)


def _around(partial: PartialEnvironment, node_id: int) -> set[int]:
    """Return the nodes that a walk to a node brings near: the node, its contents and its containers."""
    home = partial.base.home
    found = {node_id, *partial.places(node_id)}
    found.update(other for other, (relation, place) in partial.where.items() if place == node_id and relation == "ON")
    index = home.index.get(node_id)
    if index is not None:
        found.update(home.ids[i] for i in indices(home.bears[index]))
    return found


def _beside(partial: PartialEnvironment, node_id: int) -> set[int]:
    """Return the node, its neighbors and supports: a character close to one of them is close to it."""
    home = partial.base.home
    found = {node_id, *partial.places(node_id)}
    for edge in partial.added:
        if edge.relation == "CLOSE" and node_id in (edge.source, edge.target):
            found.update((edge.source, edge.target))
    index = home.index.get(node_id)
    if index is not None and node_id not in partial.room:
        found.update(home.ids[i] for i in indices(home.close[index] & ~home.characters))
    return found


def _bearing(partial: PartialEnvironment, place: int) -> set[int]:
    """Return a place and all that stands on or in it: what a thing put there is CLOSE to."""
    home = partial.base.home
    found = {home.ids[i] for i in indices(1 << place | home.bears[place] | home.contents[place])}
    found.update(other for other, (_, where) in partial.where.items() if where == home.ids[place])
    return found


def _room_of(partial: PartialEnvironment, spot: Target) -> int:
    room = partial.base.room[spot[0]]
    return partial.base.home.ids[room] if room >= 0 else -1


def _is_open(partial: PartialEnvironment, spot: Target) -> bool:
    return spot[1] == "ON" or not partial.base.home.states[0] >> spot[0] & 1


def _moved(partial: PartialEnvironment, key: Key, fits: Callable[[Target], bool], named: bool = False) -> bool:
    """Put an object at a place of its class that fits; whether there is one.

    Args:
        partial, key: the object.
        fits: which places are wanted.
        named: take what the program names too.
    """
    home = partial.base.home
    shunned = {partial.binding[key]} if named else partial.taken
    good = [
        (i, relation)
        for _, i, relation in partial.base.spots(key[0]).choices
        if home.ids[i] not in shunned and not home.properties["SITTABLE"] >> i & 1 and fits((i, relation))
    ]
    if not good:
        return False
    i, relation = partial.rng.choice(good)
    room = partial.base.room[i]
    node_id = _movable(partial, key, home.ids[room] if room >= 0 else -1)
    partial.put(node_id, relation, home.ids[i])
    return True


def _to_floor(partial: PartialEnvironment, key: Key, fits: Callable[[int], bool]) -> None:
    """Put an object into another room, on nothing."""
    home = partial.base.home
    rooms = [home.ids[i] for i in indices(home.rooms)]
    good = [room for room in rooms if fits(room)]
    if good:
        _movable(partial, key, partial.rng.choice(good))


def _movable(partial: PartialEnvironment, key: Key, room: int) -> int:
    """Return the object's node, taken out of where it is and now in a room; another node where it can't be taken."""
    node_id = partial.binding[key]
    if not _is_movable(partial, node_id):
        node_id = partial.add(key[0], room)
        partial.binding[key] = node_id
        partial.taken.add(node_id)
        return node_id
    if node_id in partial.where:
        partial.load[partial.where.pop(node_id)[1]] -= 1
    partial.added[:] = [edge for edge in partial.added if node_id not in (edge.source, edge.target)]
    if node_id not in partial.new and node_id not in partial.room:
        partial.lift(node_id)
    partial.settle(node_id, room)
    return node_id


def _is_movable(partial: PartialEnvironment, node_id: int) -> bool:
    """Return whether a node can be moved: new or graspable, with nothing on or in it."""
    home = partial.base.home
    if partial.load.get(node_id, 0):
        return False
    if node_id in partial.new:
        return True
    i = home.index[node_id]
    return bool(home.properties["GRABBABLE"] >> i & 1) and not home.bears[i] and not home.contents[i]
