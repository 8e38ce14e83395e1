"""The processes whose things may have changed since an earlier world, so that the others need not be asked again."""

from __future__ import annotations

from typing import NamedTuple

from hearth.simulation.process_plan import Here, Moment
from hearth.simulation.world.home import Home
from hearth.simulation.world.moved_edges import Moved
from hearth.simulation.world.process_ticks import GoingOn
from hearth.simulation.world.world import World

Neighbours = dict[int, tuple[int, int]]


class Asked(NamedTuple):
    """The answers of all processes in a world.

    Attributes:
        home, states, moved: of the world.
        going_on: for each process the things that take part in it; None where nothing does.
        neighbours: the working devices, and the things in or on them (see `Moment`).
        watched, beside: as in `Ticks`.
    """

    home: Home
    states: tuple[int, ...]
    moved: Moved
    going_on: tuple[GoingOn | None, ...]
    neighbours: Neighbours
    watched: tuple[int, ...]
    beside: int


def stale(asked: Asked, moment: Moment) -> set[int]:
    """Return the places of the processes that have to be asked again, and give the moment the neighbours that hold."""
    world, here = moment.world, moment.here
    neighbours = moment.neighbours
    neighbours.update(asked.neighbours)
    found: set[int] = set()
    was, now = asked.states, world.states
    if was is not now:
        rows = here.plan.of_asked
        for number in here.plan.asked if rows(was) != rows(now) else ():
            change = was[number] ^ now[number]
            if change:
                _after(change, number, here, world, found, neighbours)
    if asked.moved is not world.moved:
        plan = here.plan
        for number, (working, things) in asked.neighbours.items():
            if number in neighbours and (beside := moment.beside(plan.devices[number], working)) != things:
                neighbours[number] = working, beside
                found |= plan.by_devices[number]
    return found


def _after(change: int, number: int, here: Here, world: World, found: set[int], neighbours: Neighbours) -> None:
    """Add the processes that ask of some things that entered or left a state, and forget such devices."""
    for place, devices, nodes in here.asking(world.home, number):
        if change & nodes:
            found.add(place)
            if devices >= 0:
                neighbours.pop(devices, None)
