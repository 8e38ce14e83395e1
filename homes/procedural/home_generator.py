"""Procedural homes: a random floor plan, furniture with clearances, and small things at the knowledge's placements."""

from dataclasses import replace
from random import Random

from hearth.homes.plans import home_shell, plan_checks
from hearth.homes.plans.home_shell import Shell, Thing
from hearth.homes.plans.layout import Layout, arrange
from hearth.homes.plans.plan import Piece, Plan, Room
from hearth.homes.procedural.floorplans import LEAST_ROOMS, MOST_ROOMS, floor_plan
from hearth.homes.procedural.furnishing import UnfurnishableError, furnish
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import rng
from hearth.schemas.yaml_fields import Faults

TRIES = 60
"""Floor plans drawn before giving up; six in seven are furnished."""
ROOM_TRIES = 4
"""Times a room is furnished before its floor plan is given up."""


def generate(rooms: int, seed: int, knowledge: Knowledge) -> Layout:
    """Return a furnished home with that number of rooms; the same for the same arguments.

    Args:
        rooms: from 3 to 9.
        seed: decides everything else.

    Raises:
        HearthError: NO_PLACE: another number of rooms, or no plan could be furnished.

    Examples:
        >>> layout = hearth.generate(rooms=3, seed=0, knowledge=known)
        >>> [room.class_name for room in layout.plan.rooms]
        ['home_office', 'bedroom', 'bathroom']
    """
    if not LEAST_ROOMS <= rooms <= MOST_ROOMS:
        raise HearthError.of(
            Code.NO_PLACE, f"a home of {rooms} rooms", suggestion=f"from {LEAST_ROOMS} to {MOST_ROOMS} rooms"
        )
    for attempt in range(TRIES):
        layout = _attempt(f"home_{rooms}_{seed}", rooms, knowledge, rng(seed, "home", rooms, attempt))
        if layout is not None:
            return layout
    raise HearthError.of(
        Code.NO_PLACE, f"no home of {rooms} rooms was found for seed {seed}", suggestion="another seed"
    )


def _attempt(name: str, rooms: int, knowledge: Knowledge, rng: Random) -> Layout | None:
    plan = floor_plan(name, rooms, rng)
    faults = Faults(name)
    plan_checks.check_rooms(plan, faults)
    built = home_shell.build(plan, faults)
    if faults:
        return None
    furnished = []
    for room in plan.rooms:
        furniture = _furniture(room, plan, built, knowledge, rng)
        if furniture is None:
            return None
        furnished.append(replace(room, furniture=furniture))
    return _settled(_numbered(replace(plan, rooms=tuple(furnished))), knowledge)


def _furniture(room: Room, plan: Plan, built: Shell, knowledge: Knowledge, rng: Random) -> tuple[Piece, ...] | None:
    """Return a room's furniture: what it needs may find its place at a second try, and a new floor plan costs more."""
    for _ in range(ROOM_TRIES):
        try:
            return furnish(room, plan.height, built, knowledge, rng)
        except UnfurnishableError:
            continue
    return None


def _settled(plan: Plan, knowledge: Knowledge) -> Layout | None:
    """Return the plan with everything in its place.

    Small things without a place are left out, and so are things that nobody reaches, unless they are used from their
    front; other faults end it.
    """
    known: dict[int, tuple[Room, tuple[Thing, ...]]] = {}
    for _ in range(3):
        faults = Faults(plan.name)
        layout = arrange(plan, knowledge, faults, known)
        crowded = {fault.line for fault in faults}
        if crowded:
            plan = _without(plan, crowded)
            continue
        plan_checks.check_layout(layout.plan, layout.shell, layout.things, layout.floor, faults)
        if not faults:
            return layout
        far = {fault.line for fault in faults if fault.code == Code.NO_PATH}
        used = {thing.line for thing in layout.things if thing.front}
        if len(far) < len(faults) or far & used or not far:
            return None
        plan = _without(plan, far)
    return None


def _numbered(plan: Plan) -> Plan:
    """Every entry with a line of its own, by which its faults are known."""
    counter = iter(range(10_000, 100_000))

    def numbered(pieces: tuple[Piece, ...]) -> tuple[Piece, ...]:
        return tuple(replace(piece, line=next(counter)).with_parts(numbered) for piece in pieces)

    return replace(plan, rooms=tuple(replace(room, furniture=numbered(room.furniture)) for room in plan.rooms))


def _without(plan: Plan, lines: set[int]) -> Plan:
    """Return the plan without some entries; rooms that lose none stay the same objects."""

    def kept(pieces: tuple[Piece, ...]) -> tuple[Piece, ...]:
        return tuple(piece.with_parts(kept) for piece in pieces if piece.line not in lines)

    found = ((room, kept(room.furniture)) for room in plan.rooms)
    rooms = (room if left == room.furniture else replace(room, furniture=left) for room, left in found)
    return replace(plan, rooms=tuple(rooms))
