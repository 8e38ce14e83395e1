"""Processes of action set 3: heating, cooking, washing, cooling, one row of `processes.yaml` each.

Every process counts, for each thing, the ticks for which its literals have held without a break. The counts are kept
bit by bit: a row of a world has the lowest bit of the counts of all things, the next the second, and so on, so that a
tick of one process is a few operations on sets, however many things take part. Where nothing runs, and nothing
changed that could start something, a tick costs a comparison.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache
from typing import Any, NamedTuple

from hearth.kb.formula import TRUE, And, Formula, Term
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Process
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import EVERY_STATE_ID, STATES
from hearth.simulation.actions.literal_effects import made
from hearth.simulation.actions.readings import kind_of
from hearth.simulation.observation import reach
from hearth.simulation.world.bits import indices
from hearth.simulation.world.further import WIDTH
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


class _Kind(NamedTuple):
    """A thing or a device of a process: a kind of things that never changes, and the states that it has to be in."""

    formula: Formula
    has: tuple[int, ...]
    lacks: tuple[int, ...]

    def mask(self, home: Home, states: tuple[int, ...]) -> int:
        """Return the nodes that are so."""
        found = kind_of(home, self.formula)
        for number in self.has:
            found &= states[number]
        for number in self.lacks:
            found &= ~states[number]
        return found

    def without(self, number: int) -> _Kind:
        """Return the same, whether or not it is in a state."""
        return self._replace(lacks=tuple(each for each in self.lacks if each != number))


_Beside = Callable[[World, int], int]

_Part = tuple[_Kind, _Kind | None, _Beside]
"""A thing, its device, and the relation between them."""


class Running(NamedTuple):
    """A process, ready to be advanced.

    Attributes:
        process: the row.
        thing, device: its kinds of things and devices; the device is None where there is none.
        beside: the things in, or on, some devices.
        first, bits: its rows among the counts.
        kept: what keeps up the state that it ends: thing, device and relation of other processes.
    """

    process: Process
    thing: _Kind
    device: _Kind | None
    beside: _Beside
    first: int
    bits: int
    kept: tuple[_Part, ...] = ()

    def now(self, world: World) -> int:
        """Return the things that are in it."""
        found = _taking_part(world, self.thing, self.device, self.beside)
        for each in self.kept if found else ():
            found &= ~_taking_part(world, *each)
        return found


def _taking_part(world: World, thing: _Kind, device: _Kind | None, beside: _Beside) -> int:
    devices = -1 if device is None else device.mask(world.home, world.states)
    things = thing.mask(world.home, world.states) if devices else 0
    return things & beside(world, devices) if things and device is not None else things


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
    device = _kind(literals, "d") if joined else None
    return Running(
        process, _kind(literals, "x"), device, reach.upon if joined == "ON" else reach.contained, first, bits
    )


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
                yield other.thing.without(number), other.device, other.beside


def widened(world: World) -> World:
    """Return the world with the further states, and counts at 0."""
    if len(world.states) > len(STATES):
        return world
    processes = running(world.home.knowledge)
    counts = processes[-1].first + processes[-1].bits if processes else 0
    rows: tuple[Any, ...] = (*world.states, *world.home.further, (0,) * counts)
    wide = World(world.home, rows, world.agents, world.moved)
    wide.idle = not _may_start(wide)
    return wide


def advanced(before: World, world: World) -> World:
    """Return the world one tick later: after the acts of the characters, with the changes of processes.

    Args:
        before: at the start of the tick; where nothing ran in it, and nothing changed since, nothing does.
        world: after the tick's acts.
    """
    if len(world.states) == len(STATES):
        world = widened(world)
    if getattr(before, "idle", False) and (_same(before, world) or not _may_start(world)):
        world.idle = True
        return world
    counts: list[int] | None = None
    known: tuple[int, ...] = world.states[WIDTH]  # type: ignore[assignment] # see `further`
    ready: list[tuple[Running, int]] = []
    for each in running(world.home.knowledge):
        now = each.now(world)
        if not now and not any(known[each.first : each.first + each.bits]):
            continue
        counts = list(known) if counts is None else counts
        over = _counted(counts, each, now)
        if over:
            ready.append((each, over))
    if counts is None:
        world.idle = True
        return world
    rows: tuple[Any, ...] = (*world.states[:WIDTH], tuple(counts))
    return _ended(World(world.home, rows, world.agents, world.moved), ready)


def _same(before: World, world: World) -> bool:
    return before.states is world.states and before.moved is world.moved and before.home is world.home


def _may_start(world: World) -> bool:
    """Return whether a thing or device of a process is in a state without which the process does not go on."""
    home, states = world.home, world.states
    known = home.kinds.get(_TRIGGERS)
    if known is None:
        known = home.kinds[_TRIGGERS] = (None, tuple(_triggers(home)))
    for number, kind in known[1]:  # noqa: SIM110 - `any` takes twice as long, and every tick asks
        if kind & states[number]:
            return True
    return False


_TRIGGERS = -1
"""The place of a home's triggers among its `kinds`; no identity is below 0."""


def _triggers(home: Home) -> Iterator[tuple[int, int]]:
    """For each state the nodes that have to be in it for some process: its devices, else its things."""
    found: dict[int, int] = {}
    for each in running(home.knowledge):
        kind = each.device if each.device is not None and each.device.has else each.thing
        number = kind.has[0]
        found[number] = found.get(number, 0) | kind_of(home, kind.formula)
    yield from found.items()


def _counted(counts: list[int], process: Running, now: int) -> int:
    """Count one more for the things in a process, and from the start again for others; those that are done."""
    carry, over = now, now
    for k in range(process.bits):
        row = counts[process.first + k] & now
        counts[process.first + k], carry = row ^ carry, row & carry
        over &= counts[process.first + k] if process.process.after >> k & 1 else ~counts[process.first + k]
    for k in range(process.bits if over else 0):
        counts[process.first + k] &= ~over
    return over


def _ended(world: World, ready: Iterable[tuple[Running, int]]) -> World:
    """Return the world in which the processes that are done for some things have made true what they do."""
    changes = [
        (effect.literal, (i,)) for each, things in ready for effect in each.process.effects for i in indices(things)
    ]
    return made(changes, world) if changes else world


def seen(world: World) -> tuple[tuple[int, str], ...]:
    """Return the ids of the things in a process, each with its visible sign in words."""
    world = widened(world)
    return tuple(
        (world.home.ids[i], each.process.seen)
        for each in running(world.home.knowledge)
        if each.process.seen
        for i in indices(each.now(world))
    )
