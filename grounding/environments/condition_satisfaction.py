"""Satisfying conditions in a partial environment, one small function a condition."""

from collections.abc import Callable

from hearth.grounding.environments import condition_violation
from hearth.grounding.environments.default_state import DRINK
from hearth.grounding.environments.environment_draft import PartialEnvironment
from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Placement
from hearth.schemas.graph import Edge
from hearth.schemas.literals import CHARACTER, HANDS, LACK_OF_SET_3, STATE_OF, STATE_OF_SET_3, Key
from hearth.simulation.world.affordance import is_of_kind
from hearth.simulation.world.bits import indices

Fulfil = Callable[[PartialEnvironment, Condition], None]


def fulfil(partial: PartialEnvironment, conditions: Preconditions) -> None:
    """Satisfy every condition that placing has not satisfied already."""
    of_states = [condition for condition in conditions if condition.name in _FURTHER]
    for condition in conditions:
        if condition.name not in _FURTHER:
            FULFIL[condition.name](partial, condition)
    for condition in of_states:  # last: what is full is not moved any more
        FULFIL[condition.name](partial, condition)


_FURTHER = frozenset((*STATE_OF_SET_3, *LACK_OF_SET_3))
"""Conditions about states of action set 3."""


def _state(partial: PartialEnvironment, condition: Condition) -> None:
    partial.set_state(_node(partial, condition.objects[0]), STATE_OF[condition.name])


def _further_state(partial: PartialEnvironment, condition: Condition) -> None:
    """Put a thing into a state of action set 3 and out of those that it excludes; what is full has a drink in it."""
    node_id, state = _node(partial, condition.objects[0]), STATE_OF_SET_3[condition.name]
    partial.set_further(node_id, (state,), partial.base.knowledge.excludes(state))
    if condition.name == "full" and not _is_held(partial, node_id):
        vessel = condition.objects[0][0]
        drinks = [p.object for p in partial.base.knowledge.holds(vessel) if _is_poured(partial, p)]
        if drinks:
            content = partial.add(partial.rng.choice(drinks), partial.room_of(node_id))
            partial.put(content, "INSIDE", node_id)


def _is_poured(partial: PartialEnvironment, placement: Placement) -> bool:
    """Return whether a placement is of a drink that is poured into something, not of one in its carton."""
    name, holder = placement.object, placement.destination
    is_drink = DRINK in partial.base.knowledge.ancestors(name)
    return placement.relation == "IN" and is_drink and not partial.base.towers_over(name, holder)


def _lacks(partial: PartialEnvironment, condition: Condition) -> None:
    partial.set_further(_node(partial, condition.objects[0]), (), LACK_OF_SET_3[condition.name])


def _node(partial: PartialEnvironment, key: Key) -> int:
    return partial.base.character if key == CHARACTER else partial.binding[key]


def _at_reach(partial: PartialEnvironment, condition: Condition) -> None:
    """Place a node close to the other, and to the other's support or container."""
    one, other = (_node(partial, key) for key in condition.objects)
    partial.close(one, other)
    if other in partial.new and not partial.places(other) and not _is_held(partial, other):
        _set_down(partial, other)
    for place in partial.places(other):
        if place != one:
            partial.close(one, place)


def _is_held(partial: PartialEnvironment, node_id: int) -> bool:
    return any(edge.target == node_id and edge.relation in HANDS for edge in partial.added)


def _set_down(partial: PartialEnvironment, node_id: int) -> None:
    """Put something on a piece of furniture of its room: a character that takes it away stays near its neighbors."""
    home, room = partial.base.home, partial.room_of(node_id)
    surfaces = home.properties["SURFACES"] & home.furniture & ~partial.base.seats
    good = [i for i in indices(surfaces) if partial.room_of(home.ids[i]) == room]
    if good:
        partial.put(node_id, "ON", home.ids[partial.rng.choice(good)])


def _facing(partial: PartialEnvironment, condition: Condition) -> None:
    one, other = (_node(partial, key) for key in condition.objects)
    partial.added.append(Edge(one, "FACING", other))


def _nearby(partial: PartialEnvironment, condition: Condition) -> None:
    partial.close(partial.base.character, _node(partial, condition.objects[0]))


def _holds(partial: PartialEnvironment, condition: Condition) -> None:
    node_id = _node(partial, condition.objects[0])
    me = partial.base.character
    full = any(edge.source == me and edge.relation == HANDS[0] for edge in partial.added)
    partial.take_up(node_id)
    partial.added.append(Edge(me, HANDS[full], node_id))
    partial.close(me, node_id)


def _stands(relation: str) -> Fulfil:
    def stand(partial: PartialEnvironment, condition: Condition) -> None:
        one, other = (_node(partial, key) for key in condition.objects)
        if other not in partial.places(one):
            partial.added.append(Edge(one, relation, other))
            partial.close(one, other)

    return stand


def _free(partial: PartialEnvironment, condition: Condition) -> None:
    """Move what is on the seat to the floor of its room; a bed stays made."""
    seat = _node(partial, condition.objects[0])
    i = partial.base.home.index.get(seat, -1)
    _cleared(partial, seat, ~partial.turned_back(i) if partial.made_bed and i >= 0 else -1)


def _cleared(partial: PartialEnvironment, seat: int, which: int) -> int:
    """Move those of these nodes that the home has on a seat to the floor of their room; how many."""
    home = partial.base.home
    i = home.index.get(seat)
    if i is None:
        return 0
    removed = 0
    for j in indices(home.bears[i] & which):
        node_id = home.ids[j]
        if node_id not in partial.taken and node_id not in partial.room:
            room = partial.room_of(node_id)
            partial.lift(node_id)
            partial.settle(node_id, room)
            removed += 1
    return removed


def _occupied(partial: PartialEnvironment, condition: Condition) -> None:
    """Fill the seat to its limit with things that belong there, take room and can be removed."""
    knowledge = partial.base.knowledge
    seat = _node(partial, condition.objects[0])
    name = condition.objects[0][0]
    fixed = _cleared(partial, seat, ~partial.base.home.able("Grab"))
    home, i = partial.base.home, partial.base.home.index.get(seat, -1)
    kind = home.classes[i] if i >= 0 else name
    limit = max(knowledge.seat_limit(kind), knowledge.bed_limit(kind))
    is_bed = knowledge.has(kind, "LIEABLE")
    aside = sum(is_of_kind(each, "bedding", knowledge) for each in partial.classes_on(seat)) if is_bed else 0
    small = _takeable(knowledge, name, is_bed)
    for _ in range(limit - partial.crowd(seat) + fixed + aside):
        node_id = partial.add(partial.rng.choice(small), partial.room_of(seat))
        partial.put(node_id, "ON", seat)


def _takeable(knowledge: Knowledge, seat: str, is_bed: bool) -> list[str]:
    """Return the classes that belong on a seat, can be taken off it and take room there; on a bed, bedding does not."""
    belongs = [p.object for p in knowledge.holds(seat) if p.relation == "ON"] or ["book", "cat", "pillow"]
    found = [name for name in belongs if knowledge.has(name, "GRABBABLE")]
    return [name for name in found if not (is_bed and is_of_kind(name, "bedding", knowledge))] or ["book"]


def _resting(partial: PartialEnvironment, condition: Condition) -> None:
    """Seat the character on something near at the start, else on any seat of the room, else at its place."""
    me = partial.base.character
    partial.set_state(me, condition.name.upper())
    home = partial.base.home
    wanted = "SITTABLE" if condition.name == "sitting" else "LIEABLE"
    seats = [i for i in indices(home.properties[wanted]) if home.ids[i] not in partial.taken
             and not home.bears[i] & ~partial.turned_back(i)]  # fmt: skip
    if seats:
        seat = home.ids[partial.rng.choice(seats)]
        partial.added.append(Edge(me, "ON", seat))
        partial.close(me, seat)
        partial.room[me] = partial.room_of(seat)


def _done(partial: PartialEnvironment, condition: Condition) -> None:
    """Satisfied by placing."""


FULFIL: dict[str, Fulfil] = {
    **dict.fromkeys(STATE_OF, _state),
    **dict.fromkeys(STATE_OF_SET_3, _further_state),
    **dict.fromkeys(LACK_OF_SET_3, _lacks),
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
    "not_near": condition_violation.not_near,
    "other_room": condition_violation.other_room,
    "in_closed_container": condition_violation.in_closed_container,
    "facing_away": condition_violation.facing_away,
    "full_hands": condition_violation.full_hands,
    "doors_closed": condition_violation.doors_closed,
    "pet": condition_violation.pet,
}
