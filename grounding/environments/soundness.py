"""Soundness of a sampled environment: the checks of `home lint`, made of its differences from the home only."""

from hearth.schemas.failures import Code, Failure
from hearth.schemas.vocabulary import EVERY_STATE, STATES
from hearth.simulation.actions.literal_effects import excluded
from hearth.simulation.world import edge_rows
from hearth.simulation.world.action_set_3_states import WIDTH, is_wide
from hearth.simulation.world.bits import indices
from hearth.simulation.world.world import World

NEEDED = (("CAN_OPEN", "OPEN", "CLOSED"), ("HAS_SWITCH", "ON", "OFF"))
"""A thing with the property is in one of the states."""


def unsound(world: World) -> Failure | None:
    """Return the first fault of a start that was derived from a sound home; None when it is sound as well.

    Args:
        world: of a home made by `edit.extended`; only its changes are checked.
    """
    home = world.home
    touched = (home.base[1] if home.base is not None else home.everything) | home.restated
    return _in_states(world, touched) or _in_hands(world) or _in_places(world, touched & ~home.rooms)


def _fault(world: World, code: Code, mask: int, expected: str, actual: str) -> Failure:
    found = list(indices(mask))[:2]
    home = world.home
    ids, names = tuple(home.ids[i] for i in found), tuple(home.classes[i] for i in found)
    return Failure(code, objects=ids, names=names, expected=expected, actual=actual)


def _in_states(world: World, touched: int) -> Failure | None:
    states, properties = dict(zip(STATES, world.states, strict=False)), world.home.properties
    for one, other in zip(STATES[::2], STATES[1::2], strict=True):
        if both := states[one] & states[other] & touched:
            return _fault(world, Code.CONTRADICTION, both, f"{one} or {other}", "both")
    for prop, one, other in NEEDED:
        if neither := properties[prop] & touched & ~(states[one] | states[other]) & ~world.home.characters:
            return _fault(world, Code.CONDITION_UNMET, neither, f"{one} or {other}", "neither")
    return _in_further_states(world, touched) if is_wide(world) else None


def _in_further_states(world: World, touched: int) -> Failure | None:
    excludes = excluded(world.home.knowledge)
    for number in range(len(STATES), WIDTH):
        row = world.states[number] & touched
        for other in excludes[number] if row else ():
            if both := row & world.states[other]:
                one, rival = EVERY_STATE[number], EVERY_STATE[other]
                return _fault(world, Code.CONTRADICTION, both, f"{one} or {rival}", "both")
    return None


def _in_hands(world: World) -> Failure | None:
    seen = 0
    for agent in world.agents:
        for hand in (agent.right, agent.left):
            if hand & (hand - 1):
                return _fault(world, Code.CONFLICT, hand, "one thing a hand", "more")
        if seen & agent.held:
            return _fault(world, Code.CONFLICT, seen & agent.held, "one who holds it", "two")
        seen |= agent.held
    home = world.home
    places = ~(home.rooms | home.characters)  # clothes in a hand may be worn, too: PutOff then leaves them in the hand
    placed = sum(1 << i for i in indices(seen & ~home.characters) if (home.on[i] | home.inside[i]) & places)
    return _fault(world, Code.CONFLICT, placed, "held, in a room only", "also in its place") if placed else None


def _in_places(world: World, touched: int) -> Failure | None:
    """Each thing is in one room, in one innermost container, and not in itself."""
    home = world.home
    held = sum(agent.held for agent in world.agents)
    before = home.base[0].inside if home.base is not None else []
    known = len(before)
    for i in indices(touched & ~home.characters):
        inside = home.inside[i]
        if i < known and inside == before[i]:
            continue
        here = inside & home.rooms
        if here & (here - 1):
            return _fault(world, Code.BAD_GRAPH, 1 << i, "one room", "several")
        if not here and not held >> i & 1 and edge_rows.room_of(world, i) < 0 and not home.on[i]:
            return _fault(world, Code.NO_ROOM, 1 << i, "a room", "none")
        holders = inside & ~home.rooms
        if holders and (fault := _in_containers(world, i, holders)):
            return fault
    return None


def _in_containers(world: World, i: int, holders: int) -> Failure | None:
    outer = 0
    for holder in indices(holders):
        outer |= edge_rows.containers(world, holder)
    innermost = holders & ~outer
    if innermost & (innermost - 1):
        return _fault(world, Code.BAD_GRAPH, 1 << i, "one container", "several")
    seen, frontier = 0, holders
    while frontier & ~seen:
        seen |= frontier
        frontier = 0
        for holder in indices(seen):
            frontier |= edge_rows.containers(world, holder)
    return _fault(world, Code.LOOP, 1 << i, "a container", "itself") if seen >> i & 1 else None
