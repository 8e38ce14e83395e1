"""Processes of action set 3: heating, cooking, washing, cooling, one row of `processes.yaml` each.

Every process counts, for each thing, the ticks for which its literals have held without a break (see `process_ticks`).
What takes part in which process is asked only when something has changed since the last tick: in a home where
appliances run and nobody touches them a tick adds 1 to a number until one of them is done.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Any, NamedTuple

from hearth.kb.formula import TRUE, And, Formula, Term
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Process
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import EVERY_STATE_ID, STATES
from hearth.simulation.actions.literal_effects import made
from hearth.simulation.actions.readings import kind_of
from hearth.simulation.world import rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.further import WIDTH
from hearth.simulation.world.home import Home
from hearth.simulation.world.moved_edges import BEARS, CONTENTS, NOTHING
from hearth.simulation.world.process_ticks import GoingOn, Ticks, ticks_left
from hearth.simulation.world.world import World


class _Kind(NamedTuple):
    """A thing or a device of a process: a kind of things that never changes, and the states that it has to be in.

    Attributes:
        nodes: the nodes of the kind in one home; -1 before the home is known.
    """

    formula: Formula
    has: tuple[int, ...]
    lacks: tuple[int, ...]
    nodes: int = -1

    def within(self, home: Home) -> _Kind:
        """Return the same in one home."""
        return self._replace(nodes=kind_of(home, self.formula))

    def mask(self, states: tuple[int, ...]) -> int:
        """Return the nodes that are so."""
        found = self.nodes
        for number in self.has:
            found &= states[number]
        for number in self.lacks:
            found &= ~states[number]
        return found

    def without(self, number: int) -> _Kind:
        """Return the same, whether or not it is in a state."""
        return self._replace(lacks=tuple(each for each in self.lacks if each != number))


class _Devices(NamedTuple):
    """The devices of some processes, and the relation in which things stand to them.

    Attributes:
        number: its place among those of a home; -1 before the home is known.
        kind: the kind of the rows that have the things: `CONTENTS` or `BEARS`.
    """

    device: _Kind
    kind: int
    number: int = -1

    def beside(self, world: World) -> tuple[int, int]:
        """Return the devices that are at work, and what is in, or on, them."""
        found, devices = 0, self.device.mask(world.states)
        row = rows.contents if self.kind == CONTENTS else rows.bears
        for i in indices(devices):
            found |= row(world, i)
        return devices, found


_Known = dict[int, tuple[int, int]]
"""Number of `_Devices` -> `beside`, as far as it has been asked of a world."""


class _Part(NamedTuple):
    """The things that take part in a process, and their devices, if there are any."""

    thing: _Kind
    devices: _Devices | None

    def within(self, home: Home, known: dict[tuple[_Kind, int], _Devices]) -> _Part:
        """Return the same in one home, whose devices so far are known; no device changes a character."""
        thing = self.thing.within(home)
        if self.devices is None:
            return _Part(thing, None)
        device, kind, _ = self.devices
        devices = known.setdefault((device, kind), _Devices(device.within(home), kind, len(known)))
        return _Part(thing._replace(nodes=thing.nodes & ~home.characters), devices)

    def now(self, world: World, known: _Known) -> int:
        """Return the things that take part."""
        if self.devices is None:
            return self.thing.mask(world.states)
        number = self.devices.number
        if number not in known:
            known[number] = self.devices.beside(world)
        found = known[number][1]
        return found and found & self.thing.mask(world.states)


class Running(NamedTuple):
    """A process, ready to be advanced.

    Attributes:
        process: the row.
        part: what takes part in it.
        first, bits: its rows among the counts.
        kept: what keeps up the state that it ends: the parts of other processes.
        state, triggers: a state that nodes have to be in, or nothing takes part: the devices', else the things' own.
    """

    process: Process
    part: _Part
    first: int
    bits: int
    kept: tuple[_Part, ...] = ()
    state: int = 0
    triggers: int = -1

    def now(self, world: World, known: _Known) -> int:
        """Return the things that are in it."""
        found = self.part.now(world, known)
        for each in self.kept if found else ():
            found &= ~each.now(world, known)
        return found


@lru_cache(maxsize=8)
def running(knowledge: Knowledge) -> tuple[Running, ...]:
    """Return the processes of the knowledge."""
    found: list[Running] = []
    first = 0
    for process in knowledge.processes.values():
        bits = process.after.bit_length()
        found.append(_running(process, first, bits))
        first += bits
    return tuple(each._replace(kept=tuple(_keeping(each, found))) for each in found)


def _running(process: Process, first: int, bits: int) -> Running:
    parts = process.condition.parts if isinstance(process.condition, And) else (process.condition,)
    literals = [part for part in parts if isinstance(part, Literal)]
    joined = next((each.name for each in literals if each.name in ("INSIDE", "ON")), "")
    devices = _Devices(_kind(literals, "d"), BEARS if joined == "ON" else CONTENTS) if joined else None
    return Running(process, _Part(_kind(literals, "x"), devices), first, bits)


def _kind(literals: Iterable[Literal[Term]], variable: str) -> _Kind:
    mine = [each for each in literals if len(each.terms) == 2 and each.terms[0].name == variable]
    kinds = tuple(each for each in mine if each.name in ("class", "class_contains", "property"))
    states = [(EVERY_STATE_ID[each.terms[1].name], each.negated) for each in mine if each.name == "state"]
    return _Kind(
        And(kinds) if kinds else TRUE,
        tuple(number for number, negated in states if not negated),
        tuple(number for number, negated in states if negated),
    )


def _keeping(ending: Running, every: Iterable[Running]) -> Iterable[_Part]:
    """Yield the parts of processes that make a state which this one ends, whether or not the state is there."""
    ends = [e.literal for e in ending.process.effects if e.literal.name == "state" and e.literal.negated]
    for literal in ends:
        for other in every:
            if any(each.literal == literal.atom for each in other.process.effects):
                number = EVERY_STATE_ID[literal.terms[1].name]
                yield other.part._replace(thing=other.part.thing.without(number))


class _Plan(NamedTuple):
    """The processes of a home.

    Attributes:
        processes: those in which something of the home may take part.
        read: the states that they ask for, each with the nodes of which they ask.
        devices: their devices by number.
        by_row: the processes by their first row of counts.
    """

    processes: tuple[Running, ...]
    read: tuple[tuple[int, int], ...]
    devices: dict[int, _Devices]
    by_row: dict[int, Running]


def _in_home(home: Home) -> _Plan:
    """Return the processes of a home, kept with it."""
    known = home.kinds.get(_PROCESSES)
    if known is None:
        processes = tuple(_possible(home))
        known = home.kinds[_PROCESSES] = (None, _plan(processes))
    found: _Plan = known[1]
    return found


_PROCESSES = -1
"""The place of a home's processes among its `kinds`; no identity is below 0."""


def _possible(home: Home) -> Iterator[Running]:
    known: dict[tuple[_Kind, int], _Devices] = {}
    for each in running(home.knowledge):
        part = each.part.within(home, known)
        if part.thing.nodes and (part.devices is None or part.devices.device.nodes):
            kept = tuple(kept.within(home, known) for kept in each.kept)
            trigger = part.devices.device if part.devices is not None and part.devices.device.has else part.thing
            yield each._replace(part=part, kept=kept, state=trigger.has[0], triggers=trigger.nodes)


def _plan(processes: tuple[Running, ...]) -> _Plan:
    parts = [part for each in processes for part in (each.part, *each.kept)]
    devices = {part.devices.number: part.devices for part in parts if part.devices is not None}
    return _Plan(processes, tuple(_read(processes).items()), devices, {each.first: each for each in processes})


def _read(processes: Iterable[Running]) -> dict[int, int]:
    found: dict[int, int] = {}
    for each in processes:
        for kind in (each.part.thing, *([each.part.devices.device] if each.part.devices else [])):
            for number in (*kind.has, *kind.lacks):
                found[number] = found.get(number, 0) | kind.nodes
    return found


def widened(world: World) -> World:
    """Return the world with the further states, counts at 0, and what has gone on for long at its end."""
    if len(world.states) > _NARROW:
        return world
    home = world.home
    if world.moved is not NOTHING or world.states is not home.states:
        return _widened(world)
    known = home.kinds.get(_START)
    if known is None:
        known = home.kinds[_START] = (None, _widened(world).states)
    wide = World(home, known[1], world.agents, world.moved)
    wide.settled = True
    return wide


_START = -5
"""The place of the states at a home's start among its `kinds`; no identity is below 0."""

_NARROW = len(STATES)


def _widened(world: World) -> World:
    nothing = Ticks((0,) * sum(each.bits for each in running(world.home.knowledge)))
    rows: tuple[Any, ...] = (*world.states, *world.home.further, nothing)
    wide = World(world.home, rows, world.agents, world.moved)
    every = _in_home(wide.home).processes
    done = [(each, now) for each in every if each.process.at_start and (now := each.now(wide, {}))]
    wide = _ended(wide, done) if done else wide
    return _with_ticks(wide, _of_now(wide, nothing.rows))


def advanced(before: World, world: World) -> World:
    """Return the world one tick later: after the acts of the characters, with the changes of processes.

    Args:
        before: at the start of the tick; what went on in it goes on where nothing of it has changed since.
        world: after the tick's acts.
    """
    states = world.states
    if len(states) == _NARROW:
        world = widened(world)
        states = world.states
    ticks: Ticks = states[WIDTH]  # type: ignore[assignment] # see `further`
    try:
        known = before.settled
    except AttributeError:
        known = False
    if not known or not (
        (before.states is states and before.moved is world.moved) or _is_as_before(before, world, ticks)
    ):
        ticks = _of_now(world, ticks.counted())
    elif not ticks.due:
        world.settled = True
        return world
    return _ended_or_older(world, ticks)


def _ended_or_older(world: World, ticks: Ticks) -> World:
    """Return the world in which each process has counted once more for the things that take part in it."""
    if not ticks.due or ticks.age + 1 < ticks.due:
        return _with_ticks(world, ticks.older() if ticks.due else ticks)
    known, by_row = ticks.counted(), _in_home(world.home).by_row
    rows = [0] * len(known)
    ready = [
        (by_row[each.first], over) for each in ticks.going_on if (over := _count(rows, known, by_row[each.first], each))
    ]
    states: tuple[Any, ...] = (*world.states[:WIDTH], Ticks(tuple(rows)))
    return _ended(World(world.home, states, world.agents, world.moved), ready)


def _with_ticks(world: World, ticks: Ticks) -> World:
    rows: tuple[Any, ...] = (*world.states[:WIDTH], ticks)
    later = World(world.home, rows, world.agents, world.moved)
    later.settled = True
    return later


def _is_as_before(before: World, world: World, ticks: Ticks) -> bool:
    """Return whether nothing has changed of which a process asks."""
    was, now = before.states, world.states
    if was is not now:
        for number, nodes in _in_home(world.home).read:
            if was[number] != now[number] and (was[number] ^ now[number]) & nodes:
                return False
    one, other = before.moved, world.moved
    if one is not other:
        if (one.inside ^ other.inside | one.on ^ other.on) & ticks.beside:
            return False
        for key in ticks.watched:
            if one.extra.get(key) != other.extra.get(key):
                return False
    return before.home is world.home


def _of_now(world: World, known: tuple[int, ...]) -> Ticks:
    """Return the ticks of a world as it is: what goes on in it, and has counted so far; what does not starts anew."""
    rows = [0] * len(known)
    going_on: list[GoingOn] = []
    due = 0
    states, beside = world.states, _Known()
    for each in _in_home(world.home).processes:
        now = each.now(world, beside) if each.triggers & states[each.state] else 0
        if now:
            for k in range(each.first, each.first + each.bits):
                rows[k] = known[k] & now
            going = GoingOn(each.first, each.bits, now)
            going_on.append(going)
            left = ticks_left(rows, going, each.process.after)
            due = left if not due else min(due, left)
    return Ticks(tuple(rows), tuple(going_on), 0, due, *_watched(world.home, beside))


def _watched(home: Home, known: _Known) -> tuple[tuple[int, ...], int]:
    """Return what `Ticks` watch: the devices that are at work, and what stands in or on them."""
    keys: list[int] = []
    beside = 0
    for number, (devices, _) in known.items():
        kind = _in_home(home).devices[number].kind
        table = home.contents if kind == CONTENTS else home.bears
        for i in indices(devices):
            keys.append(8 * i + kind)
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
    return tuple(
        (world.home.ids[i], each.process.seen)
        for each in _in_home(world.home).processes
        if each.process.seen
        for i in indices(each.now(world, {}))
    )
