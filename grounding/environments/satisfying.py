"""Making conditions true in a draft, one small function a condition."""

from __future__ import annotations

from collections.abc import Callable

from hearth.grounding.environments import violating
from hearth.grounding.environments.partial import Draft
from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.schemas.graph import Edge
from hearth.schemas.literals import CHARACTER, HANDS, STATE_OF, Key
from hearth.simulation.world.bits import indices

Fulfil = Callable[[Draft, Condition], None]


def fulfil(draft: Draft, conditions: Preconditions) -> None:
    """Make every condition true that placing has not made true already."""
    for condition in conditions:
        FULFIL[condition.name](draft, condition)


def _state(draft: Draft, condition: Condition) -> None:
    draft.set_state(_node(draft, condition.objects[0]), STATE_OF[condition.name])


def _node(draft: Draft, key: Key) -> int:
    return draft.base.character if key == CHARACTER else draft.binding[key]


def _at_reach(draft: Draft, condition: Condition) -> None:
    """Close to the other, and to what the other stands on or in."""
    one, other = (_node(draft, key) for key in condition.objects)
    draft.close(one, other)
    if other in draft.new and not draft.places(other):
        _set_down(draft, other)
    for place in draft.places(other):
        if place != one:
            draft.close(one, place)


def _set_down(draft: Draft, node_id: int) -> None:
    """Put something on a piece of furniture of its room: who takes it away stays near what was near it."""
    home, room = draft.base.home, draft.room_of(node_id)
    surfaces = home.properties["SURFACES"] & home.furniture & ~draft.base.seats
    good = [i for i in indices(surfaces) if draft.room_of(home.ids[i]) == room]
    if good:
        draft.put(node_id, "ON", home.ids[draft.rng.choice(good)])


def _facing(draft: Draft, condition: Condition) -> None:
    one, other = (_node(draft, key) for key in condition.objects)
    draft.added.append(Edge(one, "FACING", other))


def _nearby(draft: Draft, condition: Condition) -> None:
    draft.close(draft.base.character, _node(draft, condition.objects[0]))


def _holds(draft: Draft, condition: Condition) -> None:
    node_id = _node(draft, condition.objects[0])
    me = draft.base.character
    full = any(edge.source == me and edge.relation == HANDS[0] for edge in draft.added)
    draft.added.append(Edge(me, HANDS[full], node_id))
    draft.close(me, node_id)


def _stands(relation: str) -> Fulfil:
    def stand(draft: Draft, condition: Condition) -> None:
        one, other = (_node(draft, key) for key in condition.objects)
        if other not in draft.places(one):
            draft.added.append(Edge(one, relation, other))
            draft.close(one, other)

    return stand


def _free(draft: Draft, condition: Condition) -> None:
    """Move what is on the seat to the floor of its room, until one more fits."""
    _cleared(draft, _node(draft, condition.objects[0]), -1)


def _cleared(draft: Draft, seat: int, which: int) -> int:
    """Move those of these nodes that the home has on a seat to the floor of their room; how many."""
    home = draft.base.home
    i = home.index.get(seat)
    if i is None:
        return 0
    gone = 0
    for j in indices(home.bears[i] & which):
        node_id = home.ids[j]
        if node_id not in draft.taken and node_id not in draft.room:
            room = draft.room_of(node_id)
            draft.lift(node_id)
            draft.settle(node_id, room)
            gone += 1
    return gone


def _occupied(draft: Draft, condition: Condition) -> None:
    """Fill the seat to its limit with what belongs there and can be taken off it."""
    knowledge = draft.base.knowledge
    seat = _node(draft, condition.objects[0])
    name = condition.objects[0][0]
    fixed = _cleared(draft, seat, ~draft.base.home.able("Grab"))
    home, i = draft.base.home, draft.base.home.index.get(seat, -1)
    kind = home.classes[i] if i >= 0 else name
    limit = max(knowledge.seat_limit(kind), knowledge.bed_limit(kind))
    belongs = [p.object for p in knowledge.holds(name) if p.relation == "ON"] or ["book", "cat", "pillow"]
    small = [n for n in belongs if _graspable(draft, n)] or ["book"]
    for _ in range(limit - draft.crowd(seat) + fixed):
        node_id = draft.add(draft.rng.choice(small), draft.room_of(seat))
        draft.put(node_id, "ON", seat)


def _graspable(draft: Draft, name: str) -> bool:
    thing = draft.base.knowledge.object_class(name)
    return thing is not None and "GRABBABLE" in thing.properties


def _resting(draft: Draft, condition: Condition) -> None:
    """Sitting or lying on what is near at the start, else on any seat of the room, else where the character is."""
    me = draft.base.character
    draft.set_state(me, condition.name.upper())
    home = draft.base.home
    wanted = "SITTABLE" if condition.name == "sitting" else "LIEABLE"
    seats = [i for i in indices(home.properties[wanted]) if home.ids[i] not in draft.taken and not home.bears[i]]
    if seats:
        seat = home.ids[draft.rng.choice(seats)]
        draft.added.append(Edge(me, "ON", seat))
        draft.close(me, seat)
        draft.room[me] = draft.room_of(seat)


def _done(draft: Draft, condition: Condition) -> None:
    """Placing the objects has seen to it."""


FULFIL: dict[str, Fulfil] = {
    **dict.fromkeys(STATE_OF, _state),
    "in": _stands("ON"),
    "inside": _stands("INSIDE"),
    "location": _done,
    "together": _done,
    "atreach": _at_reach,
    "nearby": _nearby,
    "facing": _facing,
    "holds": _holds,
    "free": _free,
    "occupied": _occupied,
    "sitting": _resting,
    "lying": _resting,
    "apart": violating.apart,
    "elsewhere": violating.elsewhere,
    "stowed": violating.stowed,
    "averted": violating.averted,
    "full_hands": violating.full_hands,
    "shut_in": violating.shut_in,
    "pet": violating.pet,
}
