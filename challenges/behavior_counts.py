"""Counts of helpful and harmful behavior of two agents in an episode, from its ticks (thesis 6.5.3, figure 6-7).

Everything is counted in the real world, from the actions and from each agent's visible nodes, so that a replay counts
the same.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from functools import reduce
from operator import or_

from hearth.challenges.challenge_definition import Challenge
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.simulation.engine import act
from hearth.simulation.env import Tick
from hearth.simulation.goals import Progress
from hearth.simulation.observation.visible_nodes import visible
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.states import OPEN
from hearth.simulation.world.world import World

OFTEN = 3
"""An agent that does the same thing as often as this to the same objects is in a loop."""

MAIN, HELPER = 0, 1


@dataclass(slots=True)
class Columns:
    """The figures of one episode.

    Attributes:
        conflicts: things that counted for the other agent's goal and that an agent moved away.
        undone: things that counted for the main agent's goal and did no longer.
        loops: instructions that changed something and that the same agent had done to the same objects twice before.
        false_beliefs: things that an agent had seen where they no longer are, since the other took them unseen.
        needless: things that the helper moved and that in the end neither count for the goal nor are where they were.
        revealed: containers that the helper opened and the main agent then saw open.
        blocked: ticks that an agent lost because the other stood in its way, or had the thing that it reached for.
        idle: ticks in which the helper did nothing, or nothing that could be done.
        failed: instructions that could not be done.
    """

    conflicts: int = 0
    undone: int = 0
    loops: int = 0
    false_beliefs: int = 0
    needless: int = 0
    revealed: int = 0
    blocked: int = 0
    idle: int = 0
    failed: int = 0


NAMES = tuple(each.name for each in fields(Columns))


def analysed(
    which: Challenge, start: World, ticks: Sequence[Tick], goals: Sequence[Goal | None], progress: Sequence[Progress]
) -> Columns:
    """Return the columns of an episode.

    Args:
        which: the challenge.
        start: the world at its start.
        ticks: of the episode.
        goals: of each agent, naming furniture of the home; None where an agent has none.
        progress: of the main agent's goal, at the start and after each tick.
    """
    analysis = _Analysis(which, start, goals)
    for number, tick in enumerate(ticks):
        analysis.add(tick, progress[number], progress[number + 1])
    return analysis.finished(progress[-1])


@dataclass(slots=True)
class _Analysis:
    which: Challenge
    start: World
    goals: Sequence[Goal | None]
    columns: Columns = field(default_factory=Columns)
    done: Counter[Step] = field(default_factory=Counter)
    known: list[int] = field(default_factory=list)
    seen_open: int = 0
    opened: int = 0
    taken: int = 0
    things: int = 0
    other: Progress | None = None
    world: World | None = None

    def __post_init__(self) -> None:
        home = self.start.home
        self.world = self.start
        self.known = [self._seen(self.start, number) for number in range(len(self.start.agents))]
        for name in self.which.grammar.most_of:
            self.things |= home.instances(name)
        if len(self.goals) > HELPER and self.goals[HELPER] not in (None, self.goals[MAIN]):
            self.other = Progress.at(self.goals[HELPER] or Goal(), self.start)

    def add(self, tick: Tick, before: Progress, after: Progress) -> None:
        """Count a tick."""
        self.world = tick.world
        self.columns.failed += len(tick.failures)
        did = {n: step for n, step in tick.instructions.items() if n not in tick.failures}
        self.columns.idle += len(self.start.agents) > HELPER and HELPER not in did
        self._count_undone(did, before, after, tick)
        self._count_loops(did, tick)
        self._count_blocked(did, tick)
        self._count_seen(did, tick)

    def _count_undone(self, did: dict[int, Step], before: Progress, after: Progress, tick: Tick) -> None:
        lost = _lost(before, after)
        self.columns.undone += lost.bit_count()
        self.columns.conflicts += self._by(did.get(HELPER), before, lost, tick)
        if self.other is not None:
            now = self.other.then(tick.before, tick.world)
            self.columns.conflicts += self._by(did.get(MAIN), self.other, _lost(self.other, now), tick)
            self.other = now
        elif len(self.goals) > HELPER and self.goals[HELPER] is not None:
            self.columns.conflicts += self._by(did.get(MAIN), before, lost, tick)

    def _by(self, did: Step | None, before: Progress, lost: int, tick: Tick) -> int:
        """Return how many of these nodes an instruction is about and moves away.

        An agent may also walk to the nodes that the other takes.
        """
        about = lost & self._named(did) if lost and did is not None else 0
        if not about or did is None:
            return 0
        alone = act(tick.before, did, self.which.rules)
        return (about & _lost(before, before.then(tick.before, alone))).bit_count() if isinstance(alone, World) else 0

    def _named(self, step: Step) -> int:
        index = self.start.home.index
        found = 0
        for ref in step.objects:
            found |= 1 << index[ref.node] if ref.node in index else 0
        return found

    def _count_loops(self, did: dict[int, Step], tick: Tick) -> None:
        known = self.start.home.knowledge
        for step in did.values():
            if step.objects and step.action not in known.group("goes") and tick.before is not tick.world:
                self.done[step] += 1
                self.columns.loops += self.done[step] >= OFTEN

    def _count_blocked(self, did: dict[int, Step], tick: Tick) -> None:
        known = self.start.home.knowledge
        for number, step in did.items():
            if step.action in known.group("goes"):
                before, after = tick.before.agents[number], tick.world.agents[number]
                self.columns.blocked += before.pose == after.pose and not after.close & self._named(step)
        others = {self.start.home.ids[agent.index] for agent in self.start.agents}
        for failure in tick.failures.values():
            self.columns.blocked += failure.code is Code.CONFLICT or not others.isdisjoint(failure.objects)

    def _count_seen(self, did: dict[int, Step], tick: Tick) -> None:
        """Count false beliefs and revealed places: each agent's present and past observations."""
        if len(self.start.agents) < 2:
            return
        seen = [self._seen(tick.world, number) for number in range(len(self.start.agents))]
        for number, step in did.items():
            held = tick.world.agents[number].held & ~tick.before.agents[number].held
            for other in range(len(seen)):
                if other != number:
                    unseen = held & self.things & self.known[other] & ~seen[other]
                    self.columns.false_beliefs += unseen.bit_count()
                    self.known[other] &= ~unseen
            if number == HELPER:
                self.taken |= held
                self.opened |= self._named(step) & tick.world.states[OPEN] & ~tick.before.states[OPEN]
            else:
                self.seen_open |= self._named(step) & tick.world.states[OPEN]
        found = self.opened & tick.world.states[OPEN] & seen[MAIN] & ~self.seen_open
        self.columns.revealed += found.bit_count()
        self.seen_open |= found
        self.known = [before | now for before, now in zip(self.known, seen, strict=True)]

    def _seen(self, world: World, number: int) -> int:
        return visible(world, world.agents[number]) if self.which.partial else world.home.everything

    def finished(self, last: Progress) -> Columns:
        """Return the columns, including those that are known at the end only."""
        assert self.world is not None
        counted = reduce(or_, (mask for watch in last.watches for mask in watch.met), 0)
        for i in indices(self.taken & ~counted):
            self.columns.needless += _place(self.world, i) != _place(self.start, i)
        return self.columns


def _lost(before: Progress, after: Progress) -> int:
    """Return the nodes that counted for a goal and do no longer."""
    if before is after:
        return 0
    found = 0
    for was, now in zip(before.watches, after.watches, strict=True):
        if was is not now:
            found |= reduce(or_, was.met, 0) & ~reduce(or_, now.met, 0)
    return found


def _place(world: World, i: int) -> tuple[int, int]:
    holders = sum(agent.bit for agent in world.agents if agent.held >> i & 1)
    return (edge_rows.on(world, i) | edge_rows.inside(world, i)) & ~world.home.rooms, holders
