"""What comes by itself in action set 3: heating, cooking, washing, cooling, one row of `processes.yaml` each.

Every process counts, for each thing, the ticks for which its literals have held without a break. The counts are kept
bit by bit: a row of a world has the lowest bit of the counts of all things, the next the second, and so on, so that a
tick of one process is a few operations on sets, however many things take part. Where nothing runs, and nothing
changed that could start something, a tick costs a comparison.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import lru_cache
from typing import NamedTuple

from hearth.kb.formula import TRUE, And, Formula, Term
from hearth.kb.knowledge import Knowledge
from hearth.kb.records import Process
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import EVERY_STATE_ID
from hearth.simulation.actions.literal_effects import made
from hearth.simulation.observation import reach
from hearth.simulation.rules import Rules
from hearth.simulation.world.affordance import of_kind
from hearth.simulation.world.bits import indices
from hearth.simulation.world.further import WIDTH, is_wide
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


class _Kind(NamedTuple):
    """A thing or a device of a process: a kind of things that never changes, and the states that it has to be in."""

    formula: Formula
    has: tuple[int, ...]
    lacks: tuple[int, ...]

    def mask(self, home: Home, states: tuple[int, ...]) -> int:
        """The nodes that are so."""
        key = ("kind", str(self.formula))
        found = home.kinds.get(key)
        if found is None:
            found = of_kind(self.formula, home.properties, home.by_class, home.everything)
            home.kinds[key] = found
        for number in self.has:
            found &= states[number]
        for number in self.lacks:
            found &= ~states[number]
        return found

    def without(self, number: int) -> _Kind:
        """The same, whether or not it is in a state."""
        return self._replace(lacks=tuple(each for each in self.lacks if each != number))


class Running(NamedTuple):
    """A process, ready to be advanced.

    Attributes:
        process: the row.
        thing, device: who is in it; the device is None where there is none.
        beside: the things in, or on, some devices.
        first, bits: the rows of its counts.
        kept: what keeps up the state that it ends: thing, device and relation of other processes.
    """

    process: Process
    thing: _Kind
    device: _Kind | None
    beside: Callable[[World, int], int]
    first: int
    bits: int
    kept: tuple[tuple[_Kind, _Kind | None, Callable[[World, int], int]], ...] = ()

    def now(self, world: World) -> int:
        """The things that are in it."""
        found = _taking_part(world, self.thing, self.device, self.beside)
        for each in self.kept if found else ():
            found &= ~_taking_part(world, *each)
        return found


def _taking_part(world: World, thing: _Kind, device: _Kind | None, beside: Callable[[World, int], int]) -> int:
    things = thing.mask(world.home, world.states)
    if device is None or not things:
        return things
    devices = device.mask(world.home, world.states)
    return things & beside(world, devices) if devices else 0


@lru_cache(maxsize=8)
def running(knowledge: Knowledge) -> tuple[Running, ...]:
    """The processes of the knowledge."""
    found: list[Running] = []
    first = WIDTH
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


def _keeping(ending: Running, every: Iterable[Running]) -> Iterable[tuple[_Kind, _Kind | None, Callable]]:
    """What makes a state that a process ends, whether or not the state is there already."""
    ends = [e.literal for e in ending.process.effects if e.literal.name == "state" and e.literal.negated]
    for literal in ends:
        for other in every:
            if any(each.literal == literal.atom for each in other.process.effects):
                number = EVERY_STATE_ID[literal.terms[1].name]
                yield other.thing.without(number), other.device, other.beside


def widened(world: World) -> World:
    """The world with the further states, and counts at 0."""
    if is_wide(world):
        return world
    processes = running(world.home.knowledge)
    counts = processes[-1].first + processes[-1].bits - WIDTH if processes else 0
    return World(world.home, world.states + world.home.further + (0,) * counts, world.agents, world.moved)


def advanced(before: World, world: World, rules: Rules) -> World:
    """The world one tick later: after what the characters did in it, what comes by itself.

    Args:
        before: at the start of the tick; where nothing ran in it, and nothing changed since, nothing does.
        world: after the tick's acts.
        rules: of the engine.
    """
    world = widened(world)
    still = before.states is world.states and before.moved is world.moved and before.home is world.home
    if still and getattr(before, "idle", False):
        world.idle = True
        return world
    states: list[int] | None = None
    ready: list[tuple[Running, int]] = []
    for each in running(world.home.knowledge):
        now = each.now(world)
        if not now and not any(world.states[each.first : each.first + each.bits]):
            continue
        states = list(world.states) if states is None else states
        over = _counted(states, each, now)
        if over:
            ready.append((each, over))
    if states is None:
        world.idle = True
        return world
    return _ended(World(world.home, tuple(states), world.agents, world.moved), ready)


def _counted(states: list[int], process: Running, now: int) -> int:
    """Count one more for the things in a process, and from the start again for others; those that are done."""
    carry, over = now, now
    for k in range(process.bits):
        row = states[process.first + k] & now
        states[process.first + k], carry = row ^ carry, row & carry
        over &= states[process.first + k] if process.process.after >> k & 1 else ~states[process.first + k]
    for k in range(process.bits if over else 0):
        states[process.first + k] &= ~over
    return over


def _ended(world: World, ready: Iterable[tuple[Running, int]]) -> World:
    """The world in which the processes that are done for some things have made true what they do."""
    changes = [
        (effect.literal, (i,)) for each, things in ready for effect in each.process.effects for i in indices(things)
    ]
    return made(changes, world) if changes else world


def seen(world: World) -> tuple[tuple[int, str], ...]:
    """The ids of the things in which something goes on, and what is seen of it."""
    world = widened(world)
    return tuple(
        (world.home.ids[i], each.process.seen)
        for each in running(world.home.knowledge)
        if each.process.seen
        for i in indices(each.now(world))
    )
