"""Processes of action set 3: heating, cooking, washing, cooling, one row of `processes.yaml` each.

Every process counts, for each thing, the ticks for which its literals have held without a break (see `process_ticks`).
What takes part in which process is asked only when something has changed since the last tick: in a home where
appliances run and nobody touches them a tick adds 1 to a number until one of them is done.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from hearth.schemas.vocabulary import STATES
from hearth.simulation.actions.literal_effects import made
from hearth.simulation.process_plan import Moment, Running, here
from hearth.simulation.stale_processes import Asked, stale
from hearth.simulation.world.action_set_3_states import WIDTH, is_wide
from hearth.simulation.world.bits import indices
from hearth.simulation.world.moved_edges import CONTENTS, NOTHING
from hearth.simulation.world.process_ticks import SETTLED, STILL, GoingOn, Ticks, ticks_left
from hearth.simulation.world.world import World


def widened(world: World) -> World:
    """Return the world with the further states, counts at 0, and processes that have gone on for long at their end."""
    if len(world.states) > _NARROW:
        return world
    home = world.home
    if world.moved is not NOTHING or world.states is not home.states:
        try:
            return world.wide
        except AttributeError:
            world.wide = _widened(world)
            return world.wide
    known = home.kinds.get(_START)
    if known is None:
        wide = _widened(world)
        known = home.kinds[_START] = (wide.states, wide.settled)
    wide = World(home, known[0], world.agents, world.moved)
    wide.settled = known[1]
    return wide


def as_wide_as(start: World, other: World) -> World:
    """Return the start of a run, widened if another of its worlds has the further states."""
    return widened(start) if is_wide(other) else start


_START = -5
"""The place of the states at a home's start among its `kinds`; no identity is below 0."""

_NARROW = len(STATES)


def _widened(world: World) -> World:
    place = here(world.home)
    nothing = Ticks((0,) * place.plan.bits)
    rows: tuple[Any, ...] = (*world.states, *world.home.further, nothing)
    wide = World(world.home, rows, world.agents, world.moved)
    moment = Moment(wide, place)
    done = [(each, now) for each in place.plan.processes if each.process.at_start and (now := each.now(moment))]
    wide = _ended(wide, done) if done else wide
    return _with_ticks(wide, _of_now(wide, nothing.rows, None))


def advanced(before: World, world: World) -> World:
    """Return the world one tick later: after the acts of the characters, with the changes of processes.

    Args:
        before: at the start of the tick; what went on in it goes on where nothing of it has changed since.
        world: after the tick's acts.
    """
    states = world.states
    try:
        known = before.settled
    except AttributeError:
        known = 0
    if known == STILL and (states is before.states or not _may_start(world)):
        world.settled = STILL
        return world
    if len(states) == _NARROW:
        world = widened(world)
        states = world.states
    ticks: Ticks = states[WIDTH]  # type: ignore[assignment] # see `action_set_3_states`
    if not known or not (
        (before.states is states and before.moved is world.moved) or _is_as_before(before, world, ticks)
    ):
        ticks = _of_now(world, ticks.counted(), ticks.asked)
    elif not ticks.due:
        world.settled = SETTLED if ticks.watched else STILL
        return world
    return _ended_or_older(world, ticks)


def _ended_or_older(world: World, ticks: Ticks) -> World:
    """Return the world in which each process has counted once more for the things that take part in it."""
    if not ticks.due or ticks.age + 1 < ticks.due:
        return _with_ticks(world, ticks.older() if ticks.due else ticks)
    known, by_row = ticks.counted(), here(world.home).plan.by_row
    rows = [0] * len(known)
    ready = [
        (by_row[each.first], over) for each in ticks.going_on if (over := _count(rows, known, by_row[each.first], each))
    ]
    states: tuple[Any, ...] = (*world.states[:WIDTH], Ticks(tuple(rows), asked=ticks.asked))
    return _ended(World(world.home, states, world.agents, world.moved), ready)


def _with_ticks(world: World, ticks: Ticks) -> World:
    rows: tuple[Any, ...] = (*world.states[:WIDTH], ticks)
    later = World(world.home, rows, world.agents, world.moved)
    later.settled = SETTLED if ticks.due or ticks.watched else STILL
    return later


def _may_start(world: World) -> bool:
    """Return whether something is in a state without which no process goes on."""
    place, states = here(world.home), world.states
    for number in place.plan.triggers:
        row = states[number]
        if row and row & place.triggers(world.home, number):
            return True
    return False


def _is_as_before(before: World, world: World, ticks: Ticks) -> bool:
    """Return whether nothing has changed of which a process asks."""
    was, now = before.states, world.states
    if was is not now:
        place = here(world.home)
        rows = place.plan.of_asked
        for number in place.plan.asked if rows(was) != rows(now) else ():
            if was[number] != now[number] and (was[number] ^ now[number]) & place.read(world.home, number):
                return False
    one, other = before.moved, world.moved
    if one is not other:
        if (one.inside ^ other.inside | one.on ^ other.on) & ticks.beside:
            return False
        for key in ticks.watched:
            if one.extra.get(key) != other.extra.get(key):
                return False
    return before.home is world.home


def _of_now(world: World, known: tuple[int, ...], asked: Asked | None) -> Ticks:
    """Return the ticks of a world as it is: what goes on in it, and has counted so far; what does not starts anew.

    Args:
        world: as the characters have left it.
        known: the counts so far.
        asked: the answers of the processes in an earlier world; None if they are not known.
    """
    if asked is None and not _may_start(world):
        return Ticks((0,) * len(known))
    place = here(world.home)
    moment = Moment(world, place)
    processes = place.plan.processes
    going_on: list[GoingOn | None]
    again: Iterable[int]
    if asked is None or asked.home is not world.home:
        rows, going_on, again = [0] * len(known), [None] * len(processes), range(len(processes))
    else:
        rows, going_on, again = list(known), list(asked.going_on), stale(asked, moment)
    for number in again:
        each = processes[number]
        now = each.now(moment)
        going_on[number] = GoingOn(each.first, each.bits, now) if now else None
        for k in range(each.first, each.first + each.bits):
            rows[k] = known[k] & now
    neighbours = moment.neighbours
    if asked is not None and neighbours == asked.neighbours:
        watched, beside = asked.watched, asked.beside
    else:
        watched, beside = _watched(moment)
    found = tuple(each for each in going_on if each is not None)
    by_row = place.plan.by_row
    due = min((ticks_left(rows, each, by_row[each.first].process.after) for each in found), default=0)
    remembered = Asked(world.home, world.states, world.moved, tuple(going_on), neighbours, watched, beside)
    return Ticks(tuple(rows), found, 0, due, watched, beside, remembered)


def _watched(moment: Moment) -> tuple[tuple[int, ...], int]:
    """Return what `Ticks` watch: the devices that are at work, and the things in or on them."""
    home = moment.world.home
    keys: list[int] = []
    beside = 0
    for number, (working, _) in moment.neighbours.items():
        devices = moment.here.plan.devices[number]
        table = home.contents if devices.relation == CONTENTS else home.bears
        for i in indices(working):
            keys.append(8 * i + devices.relation)
            beside |= 1 << i | table[i]
    return tuple(keys), beside


def _count(rows: list[int], known: tuple[int, ...], process: Running, going: GoingOn) -> int:
    """Count one more for the things in a process, and return those for which it is done; these start from 0 again."""
    carry = over = going.things
    for k in range(process.first, process.first + process.bits):
        row = known[k]
        rows[k], carry = row ^ carry, row & carry
        over &= rows[k] if process.process.after >> (k - process.first) & 1 else ~rows[k]
    for k in range(process.first, process.first + process.bits if over else 0):
        rows[k] &= ~over
    return over


def _ended(world: World, ready: Iterable[tuple[Running, int]]) -> World:
    """Return the world in which the processes that are done for some things have made true what they do."""
    changes = [
        (effect.literal, (i,)) for each, things in ready for effect in each.process.effects for i in indices(things)
    ]
    return made(changes, world)


def seen(world: World) -> tuple[tuple[int, str], ...]:
    """Return the ids of the things in a process, each with its visible sign in words."""
    world = widened(world)
    place = here(world.home)
    moment = Moment(world, place)
    return tuple(
        (world.home.ids[i], each.process.seen)
        for each in place.plan.processes
        if each.process.seen
        for i in indices(each.now(moment))
    )
