"""Commands that say from where a thing is taken: `take milk 142 from fridge 137`, `grab the cup from the table`."""

from __future__ import annotations

import re
from typing import NamedTuple

from hearth.envs.json_observations import seen_instances
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import Step
from hearth.schemas.syntax import normal_name
from hearth.simulation.observation.containment import contained, in_room, upon
from hearth.simulation.observation.views import View
from hearth.simulation.world.bits import indices

_TAKEN = re.compile(
    r"(?:take|grab|get|pick up|fetch|remove|retrieve) (?:the |an? )?"
    r"(?!(?:up|out|off|away|down)\b)([a-z][a-z_ ]*?)(?: (\d{1,9}))? (?:from|out of|off) (?:the |an? )?"
    r"([a-z][a-z_ ]*?)(?: (\d{1,9}))?[.!]?",
    re.IGNORECASE,
)


class Taken(NamedTuple):
    """A command to take a thing from a place.

    Attributes:
        command: the same without the place.
        place: its name, with its number where the command has one.
        here: the seen nodes that are in or on it.
    """

    command: str
    place: str
    here: int


def taken_from(line: str, view: View) -> Taken | None:
    """Return the parts of a command that says from where a thing is taken; None of another line.

    Of several things of a class the one that alone is there is meant.

    Raises:
        HearthError: NOT_SEEN: the place is not seen.
    """
    found = _TAKEN.fullmatch(line)
    home = view.world.home
    if not found or not all(home.knowledge.object_class(normal_name(found[n])) for n in (1, 3)):
        return None
    thing, number, place, place_number = normal_name(found[1]), found[2], normal_name(found[3]), found[4]
    here = _things_at(_places(place, place_number, view), view)
    there = seen_instances(thing, home, view.mask) & here
    if number is None and there.bit_count() == 1:
        number = str(home.ids[there.bit_length() - 1])
    return Taken(f"Grab {thing} {number or ''}".rstrip(), f"{place} {place_number or ''}".rstrip(), here)


def need_there(step: Step | None, taken: Taken, view: View) -> Step | None:
    """Return the instruction of a command, if its thing is where the command says.

    Raises:
        HearthError: NOT_SEEN: it is not.
    """
    home = view.world.home
    for ref in step.objects[:1] if step is not None else ():
        if ref.node is not None and not taken.here >> home.index[ref.node] & 1:
            message = f"`{ref.name}` {ref.node} is not in or on `{taken.place}`"
            raise HearthError.of(Code.NOT_SEEN, message, suggestion=f"Grab {ref.name} {ref.node}")
    return step


def _places(name: str, number: str | None, view: View) -> int:
    home = view.world.home
    some = seen_instances(name, home, view.mask)
    if number is not None:
        some &= 1 << home.index.get(int(number), len(home))
    if not some:
        message = f"you do not see `{name}` {number or ''}".rstrip()
        raise HearthError.of(Code.NOT_SEEN, message, suggestion="leave out the place, or name one that you see")
    return some


def _things_at(places: int, view: View) -> int:
    """Return the seen things in or on places, directly or not."""
    world = view.world
    found, frontier = 0, places & ~world.home.rooms
    while frontier:
        frontier = (contained(world, frontier) | upon(world, frontier)) & ~found
        found |= frontier
    for room in indices(places & world.home.rooms):
        found |= in_room(world, room)
    return found & view.mask
