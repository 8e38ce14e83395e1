"""Making true what perturbing asks for: things elsewhere, shut away, in the way, or in the hands (thesis 5.5.4)."""

from __future__ import annotations

from collections.abc import Callable

from hearth.grounding.environments.default_state import Base
from hearth.grounding.environments.partial import Draft
from hearth.grounding.preconditions.conditions import Condition
from hearth.schemas.graph import Edge
from hearth.schemas.literals import HANDS, Key
from hearth.simulation.holds import PETS
from hearth.simulation.world.bits import indices

Target = tuple[int, str]
"""Index of a place, and ON or INSIDE it."""


def apart(draft: Draft, condition: Condition) -> None:
    """The first object is not at reach of who stands at the second."""
    key, anchor = condition.objects
    around = _around(draft, draft.binding[anchor])
    if not _beside(draft, draft.binding[key]) & around:
        return
    room = draft.room_of(draft.binding[key])

    def fits(spot: Target) -> bool:
        return not _bearing(draft, spot[0]) & around

    if not _moved(draft, key, lambda s: fits(s) and _room_of(draft, s) == room) and not _moved(draft, key, fits):
        _to_floor(draft, key, lambda other: other != room)


def elsewhere(draft: Draft, condition: Condition) -> None:
    """The first object is in another room than the second, which is a room."""
    key = condition.objects[0]
    room = draft.binding[condition.objects[1]]
    if draft.room_of(draft.binding[key]) == room and not _moved(
        draft, key, lambda s: _is_open(draft, s) and _room_of(draft, s) != room
    ):
        _to_floor(draft, key, lambda other: other != room)


def stowed(draft: Draft, condition: Condition) -> None:
    """The first object is in something closed where it belongs, other than the second; if possible in nothing that the
    program names.
    """
    key, now = condition.objects
    ids, here = draft.base.home.ids, draft.binding.get(now, -1)

    def fits(spot: Target) -> bool:
        return closes(draft.base, spot) and ids[spot[0]] != here

    if _moved(draft, key, fits) or _moved(draft, key, fits, named=True):
        draft.set_state(draft.where[draft.binding[key]][1], "CLOSED")


def closes(base: Base, spot: Target) -> bool:
    """Whether that is inside something that can be opened and is closed in the home's default state."""
    home = base.home
    return spot[1] == "INSIDE" and bool((home.able("Open") & home.states[0]) >> spot[0] & 1)


def averted(draft: Draft, condition: Condition) -> None:
    """The first object faces away from the second."""
    one, other = (draft.binding[key] for key in condition.objects)
    draft.added[:] = [edge for edge in draft.added if edge != Edge(one, "FACING", other)]
    if one in draft.base.home.index and other in draft.base.home.index:
        draft.removed.append(Edge(one, "FACING", other))


def full_hands(draft: Draft, condition: Condition) -> None:
    """The character's hands hold things of no concern to the program."""
    me = draft.base.character
    taken = {edge.relation for edge in draft.added if edge.source == me}
    fillers = draft.base.fillers.choices
    for hand in HANDS:
        if hand not in taken and fillers:
            node_id = draft.add(draft.rng.choice(fillers)[0], -1)
            draft.added.append(Edge(me, hand, node_id))
            draft.close(me, node_id)


def shut_in(draft: Draft, condition: Condition) -> None:
    """Every door of the room that the object is, or is in, is closed."""
    home = draft.base.home
    room = draft.room_of(draft.binding[condition.objects[0]])
    if room < 0:
        return
    index = home.index[room]
    for door in indices(home.doors & home.able("Close")):
        if home.between[door] >> index & 1:
            draft.set_state(home.ids[door], "CLOSED")


def pet(draft: Draft, condition: Condition) -> None:
    """A cat or a dog is on the seat."""
    seat = draft.binding[condition.objects[0]]
    node_id = draft.add(draft.rng.choice(PETS), draft.room_of(seat))
    draft.put(node_id, "ON", seat)


def _around(draft: Draft, node_id: int) -> set[int]:
    """What a walk to a node makes the character close to itself: the node, what is on it and what it is in."""
    home = draft.base.home
    found = {node_id, *draft.places(node_id)}
    found.update(other for other, (relation, place) in draft.where.items() if place == node_id and relation == "ON")
    index = home.index.get(node_id)
    if index is not None:
        found.update(home.ids[i] for i in indices(home.bears[index]))
    return found


def _beside(draft: Draft, node_id: int) -> set[int]:
    """The node, what it is CLOSE to and what it is on: whoever is close to one of them is close to it."""
    home = draft.base.home
    found = {node_id, *draft.places(node_id)}
    for edge in draft.added:
        if edge.relation == "CLOSE" and node_id in (edge.source, edge.target):
            found.update((edge.source, edge.target))
    index = home.index.get(node_id)
    if index is not None and node_id not in draft.room:
        found.update(home.ids[i] for i in indices(home.close[index] & ~home.characters))
    return found


def _bearing(draft: Draft, place: int) -> set[int]:
    """A place and all that stands on or in it: what a thing put there is CLOSE to."""
    home = draft.base.home
    found = {home.ids[i] for i in indices(1 << place | home.bears[place] | home.contents[place])}
    found.update(other for other, (_, where) in draft.where.items() if where == home.ids[place])
    return found


def _room_of(draft: Draft, spot: Target) -> int:
    room = draft.base.room[spot[0]]
    return draft.base.home.ids[room] if room >= 0 else -1


def _is_open(draft: Draft, spot: Target) -> bool:
    return spot[1] == "ON" or not draft.base.home.states[0] >> spot[0] & 1


def _moved(draft: Draft, key: Key, fits: Callable[[Target], bool], named: bool = False) -> bool:
    """Put an object where one of its class belongs and which fits; whether there is such a place.

    Args:
        draft, key: the object.
        fits: which places are wanted.
        named: take what the program names too.
    """
    home = draft.base.home
    shunned = {draft.binding[key]} if named else draft.taken
    good = [
        (i, relation)
        for _, i, relation in draft.base.spots(key[0]).choices
        if home.ids[i] not in shunned and not home.properties["SITTABLE"] >> i & 1 and fits((i, relation))
    ]
    if not good:
        return False
    i, relation = draft.rng.choice(good)
    room = draft.base.room[i]
    node_id = _loose(draft, key, home.ids[room] if room >= 0 else -1)
    draft.put(node_id, relation, home.ids[i])
    return True


def _to_floor(draft: Draft, key: Key, fits: Callable[[int], bool]) -> None:
    """Put an object into another room, on nothing."""
    home = draft.base.home
    rooms = [home.ids[i] for i in indices(home.rooms)]
    good = [room for room in rooms if fits(room)]
    if good:
        _loose(draft, key, draft.rng.choice(good))


def _loose(draft: Draft, key: Key, room: int) -> int:
    """The object's node, taken out of where it is and now in a room; another node where it can't be taken."""
    node_id = draft.binding[key]
    if not _is_loose(draft, node_id):
        node_id = draft.add(key[0], room)
        draft.binding[key] = node_id
        draft.taken.add(node_id)
        return node_id
    if node_id in draft.where:
        draft.load[draft.where.pop(node_id)[1]] -= 1
    draft.added[:] = [edge for edge in draft.added if node_id not in (edge.source, edge.target)]
    if node_id not in draft.new and node_id not in draft.room:
        draft.lift(node_id)
    draft.settle(node_id, room)
    return node_id


def _is_loose(draft: Draft, node_id: int) -> bool:
    """Whether a node can be put elsewhere: new or graspable, with nothing on or in it."""
    home = draft.base.home
    if draft.load.get(node_id, 0):
        return False
    if node_id in draft.new:
        return True
    i = home.index[node_id]
    return bool(home.properties["GRABBABLE"] >> i & 1) and not home.bears[i] and not home.contents[i]
