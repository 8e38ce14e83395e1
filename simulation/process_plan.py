"""The processes of `processes.yaml`, ready to be asked of worlds which things take part in them.

What a row says of kinds of things never changes in a home: each kind has a number, and a home the nodes of each.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache
from operator import itemgetter
from typing import NamedTuple

from hearth.kb.formula import TRUE, And, Formula, Term
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Process
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import EVERY_STATE_ID
from hearth.simulation.actions.formula_evaluation import kind_of
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.moved_edges import BEARS, CONTENTS
from hearth.simulation.world.world import World


class Kind(NamedTuple):
    """A thing or a device of a process: a kind of things that never changes, and the states that it has to be in.

    Attributes:
        number: the place of the kind among those of all processes.
        has, lacks: the rows of the states.
    """

    number: int
    has: tuple[int, ...]
    lacks: tuple[int, ...]

    def nodes(self, world: World, here: Here) -> int:
        """Return the nodes that are so."""
        states, found = world.states, here.kind(world.home, self.number)
        for number in self.has:
            found &= states[number]
        for number in self.lacks:
            found &= ~states[number]
        return found

    def without(self, number: int) -> Kind:
        """Return the same, whether or not it is in a state."""
        return Kind(self.number, self.has, tuple(each for each in self.lacks if each != number))


class Devices(NamedTuple):
    """The devices of some processes, and the relation in which things stand to them.

    Attributes:
        number: the place of these among those of all processes.
        kind: what they are.
        relation: the kind of the rows that have the things: `CONTENTS` or `BEARS`.
    """

    number: int
    kind: Kind
    relation: int


class Moment:
    """A world at one moment, with the working devices and the things in or on them, as far as somebody asked."""

    __slots__ = ("here", "neighbours", "world")

    def __init__(self, world: World, here: Here) -> None:
        self.world = world
        self.here = here
        self.neighbours: dict[int, tuple[int, int]] = {}

    def at(self, devices: Devices) -> int:
        """Return the things that are in, or on, devices at work."""
        known = self.neighbours.get(devices.number)
        if known is None:
            working = devices.kind.nodes(self.world, self.here)
            known = self.neighbours[devices.number] = working, self.beside(devices, working)
        return known[1]

    def beside(self, devices: Devices, working: int) -> int:
        """Return the things that are in, or on, some devices."""
        world, found = self.world, 0
        row = edge_rows.contents if devices.relation == CONTENTS else edge_rows.bears
        for i in indices(working):
            found |= row(world, i)
        return found


class Part(NamedTuple):
    """The things that take part in a process, and their devices, if there are any."""

    thing: Kind
    devices: Devices | None

    def now(self, moment: Moment) -> int:
        """Return the things that take part."""
        if self.devices is None:
            return self.thing.nodes(moment.world, moment.here)
        found = moment.at(self.devices)
        return found and found & self.thing.nodes(moment.world, moment.here)


class Running(NamedTuple):
    """A process, ready to be advanced.

    Attributes:
        process: the row.
        part: what takes part in it.
        first, bits: its rows among the counts.
        trigger, state: a kind and a state in which one of it has to be, or nothing takes part.
        kept: what keeps up the state that it ends: the parts of other processes.
    """

    process: Process
    part: Part
    first: int
    bits: int
    trigger: int
    state: int
    kept: tuple[Part, ...] = ()

    def now(self, moment: Moment) -> int:
        """Return the things that are in it."""
        now = moment.world.states[self.state]
        if not now or not now & moment.here.kind(moment.world.home, self.trigger):
            return 0
        found = self.part.now(moment)
        for each in self.kept if found else ():
            found &= ~each.now(moment)
        return found


class Plan(NamedTuple):
    """All processes.

    Attributes:
        processes: in the order of the file.
        formulas: what each kind is, and whether characters are left out of it.
        read: the states that they ask for, each with the kinds of which they ask.
        asked: these states.
        of_asked: their rows, of the rows of a world: what is the same object is compared without being read.
        bits: the rows of counts.
        by_row: the processes by their first row of counts.
        triggers: the states without which no process goes on, each with the kinds of which one has to be in it.
        asking: for each state the processes that ask for it, by place, each with a kind of which it asks, and the
            number of the devices that are of that kind, or -1.
        devices: all devices, by number.
        by_devices: the places of the processes of each of them.
    """

    processes: tuple[Running, ...]
    formulas: tuple[tuple[Formula, bool], ...]
    read: dict[int, frozenset[int]]
    asked: tuple[int, ...]
    of_asked: Callable[[Sequence[int]], tuple[int, ...]]
    bits: int
    by_row: dict[int, Running]
    triggers: dict[int, frozenset[int]]
    asking: dict[int, tuple[tuple[int, int, int], ...]]
    devices: tuple[Devices, ...]
    by_devices: tuple[frozenset[int], ...]


@lru_cache(maxsize=8)
def planned(knowledge: Knowledge) -> Plan:
    """Return the processes of the knowledge."""
    numbers: dict[tuple[Formula, bool], int] = {}
    found: list[Running] = []
    devices: dict[tuple[Kind, int], int] = {}
    first = 0
    for process in knowledge.processes.values():
        found.append(_running(process, first, numbers, devices))
        first += found[-1].bits
    every = tuple(each._replace(kept=tuple(_keeping(each, found))) for each in found)
    read = _read(every)
    by_row = {each.first: each for each in every}
    triggers: dict[int, frozenset[int]] = {}
    for each in every:
        triggers[each.state] = triggers.get(each.state, frozenset()) | {each.trigger}
    those = tuple(Devices(number, *each) for each, number in devices.items())
    users = tuple(frozenset(k for k, each in enumerate(every) if one in _devices(each)) for one in those)
    return Plan(
        every,
        tuple(numbers),
        read,
        tuple(read),
        itemgetter(*read),
        first,
        by_row,
        triggers,
        _asking(every),
        those,
        users,
    )


def _devices(process: Running) -> Iterator[Devices]:
    for part in (process.part, *process.kept):
        if part.devices is not None:
            yield part.devices


def _asking(every: Iterable[Running]) -> dict[int, tuple[tuple[int, int, int], ...]]:
    """Return the processes by the states for which they ask."""
    found: dict[int, dict[tuple[int, int, int], None]] = {}
    for place, each in enumerate(every):
        kinds = [(part.thing, -1) for part in (each.part, *each.kept)]
        for kind, devices in (*kinds, *((those.kind, those.number) for those in _devices(each))):
            for number in (*kind.has, *kind.lacks):
                found.setdefault(number, {})[place, kind.number, devices] = None
    return {number: tuple(those) for number, those in found.items()}


def _running(
    process: Process, first: int, numbers: dict[tuple[Formula, bool], int], known: dict[tuple[Kind, int], int]
) -> Running:
    parts = process.condition.parts if isinstance(process.condition, And) else (process.condition,)
    literals = [part for part in parts if isinstance(part, Literal)]
    joined = next((each.name for each in literals if each.name in ("INSIDE", "ON")), "")
    thing = _kind(literals, "x", numbers, bool(joined))
    devices = None
    if joined:
        those = _kind(literals, "d", numbers, False), BEARS if joined == "ON" else CONTENTS
        devices = Devices(known.setdefault(those, len(known)), *those)
    trigger = devices.kind if devices is not None and devices.kind.has else thing
    part = Part(thing, devices)
    return Running(process, part, first, process.after.bit_length(), trigger.number, trigger.has[0])


def _kind(
    literals: Iterable[Literal[Term]], variable: str, numbers: dict[tuple[Formula, bool], int], things_only: bool
) -> Kind:
    """Return what literals say of a variable; no device changes a character."""
    mine = [each for each in literals if len(each.terms) == 2 and each.terms[0].name == variable]
    kinds = tuple(each for each in mine if each.name in ("class", "class_contains", "property"))
    states = [(EVERY_STATE_ID[each.terms[1].name], each.negated) for each in mine if each.name == "state"]
    formula: Formula = TRUE if not kinds else kinds[0] if len(kinds) == 1 else And(kinds)
    return Kind(
        numbers.setdefault((formula, things_only), len(numbers)),
        tuple(number for number, negated in states if not negated),
        tuple(number for number, negated in states if negated),
    )


def _keeping(ending: Running, every: Iterable[Running]) -> Iterator[Part]:
    """Yield the parts of processes that make a state which this one ends, whether or not the state is there."""
    ends = [e.literal for e in ending.process.effects if e.literal.name == "state" and e.literal.negated]
    for literal in ends:
        for other in every:
            if any(each.literal == literal.atom for each in other.process.effects):
                yield Part(other.part.thing.without(EVERY_STATE_ID[literal.terms[1].name]), other.part.devices)


def _read(processes: Iterable[Running]) -> dict[int, frozenset[int]]:
    found: dict[int, frozenset[int]] = {}
    for each in processes:
        for kind in (each.part.thing, *([each.part.devices.kind] if each.part.devices else [])):
            for number in (*kind.has, *kind.lacks):
                found[number] = found.get(number, frozenset()) | {kind.number}
    return found


class Here:
    """The processes in one home: the nodes of each kind, found when they are first asked for.

    Most homes in which programs run are made for one run, and ask for a few. The home is given by callers: one that
    was kept here would only end with the collector.
    """

    __slots__ = ("_asking", "_kinds", "_read", "_triggers", "plan")

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self._kinds: dict[int, int] = {}
        self._read: dict[int, int] = {}
        self._triggers: dict[int, int] = {}
        self._asking: dict[int, tuple[tuple[int, int, int], ...]] = {}

    def kind(self, home: Home, number: int) -> int:
        """Return the nodes of a kind."""
        found = self._kinds.get(number)
        if found is None:
            formula, things_only = self.plan.formulas[number]
            found = kind_of(home, formula) & (~home.characters if things_only else -1)
            self._kinds[number] = found
        return found

    def read(self, home: Home, state: int) -> int:
        """Return the nodes of which processes ask whether they are in a state, by its row."""
        found = self._read.get(state)
        if found is None:
            found = self._read[state] = self._any(home, self.plan.read[state])
        return found

    def triggers(self, home: Home, state: int) -> int:
        """Return the nodes of which one has to be in a state, or some processes do not go on."""
        found = self._triggers.get(state)
        if found is None:
            found = self._triggers[state] = self._any(home, self.plan.triggers[state])
        return found

    def asking(self, home: Home, state: int) -> tuple[tuple[int, int, int], ...]:
        """Return the processes that ask for a state: place, number of devices, and the nodes of which they ask."""
        found = self._asking.get(state)
        if found is None:
            found = self._asking[state] = tuple(
                (place, devices, nodes)
                for place, number, devices in self.plan.asking.get(state, ())
                if (nodes := self.kind(home, number))
            )
        return found

    def _any(self, home: Home, kinds: Iterable[int]) -> int:
        found = 0
        for number in kinds:
            found |= self.kind(home, number)
        return found


def here(home: Home) -> Here:
    """Return the processes in a home, kept with it."""
    known = home.kinds.get(_HERE)
    if known is None:
        known = home.kinds[_HERE] = (None, Here(planned(home.knowledge)))
    found: Here = known[1]
    return found


_HERE = -1
"""The place of a home's processes among its `kinds`; no identity is below 0."""
