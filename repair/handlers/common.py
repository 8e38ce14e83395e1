"""Shared parts of the handlers: the context given to them, and the edits that they return."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from hearth.grounding.failure_context import FailureContext
from hearth.grounding.preconditions.postconditions import Postconditions
from hearth.repair.step_context import RESTING
from hearth.schemas.literals import Key
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.rules import Rules
from hearth.simulation.world import edge_rows
from hearth.simulation.world.states import LYING, SITTING
from hearth.simulation.world.world import World


@dataclass(frozen=True, slots=True)
class RepairContext(FailureContext):
    """A failure to repair.

    Attributes:
        rules: those of the execution.
        goal: what the program has to reach (thesis eq. A.1).
        nodes: the nodes of the objects that the goal names.
        missed: the facts of the goal that do not hold, where the program ran to its end; or of the circumstances of a
            step that is done in others.
        wanted: the circumstances of each step; None for one that a repair inserted. Empty where they are unknown.
        worlds: the world before each tick that was done, and the last one.
    """

    rules: Rules
    goal: Postconditions = ()
    nodes: Mapping[Key, int] = field(default_factory=dict)
    missed: Postconditions = ()
    wanted: Sequence[Postconditions | None] = ()
    worlds: Sequence[World] = ()

    @property
    def step(self) -> Step:
        """The failing step."""
        return self.program.steps[self.at]

    @property
    def resting(self) -> bool:
        """Return whether that character sits or lies."""
        states = self.world.states
        return bool((states[SITTING] | states[LYING]) & self.agent.bit)

    def object(self, position: int = 0) -> ObjectRef:
        """Return a node that the failure names, as an object of the program."""
        return self.ref(self.index(position))

    def refs(self, indices: Iterable[int]) -> tuple[ObjectRef, ...]:
        """Nodes as objects of the program: those bound to them, else new instances of their classes."""
        mine = self.step.objects if self.at < len(self.program.steps) else ()
        objects = self.program.objects()
        known = {ref.node: ref for ref in (*reversed(objects), *reversed(mine)) if ref.node is not None}
        last: dict[str, int] = {}
        for ref in objects:
            last[ref.name] = max(last.get(ref.name, 0), ref.instance)
        return tuple(self._ref(index, known, last) for index in indices)

    def _ref(self, index: int, known: dict[int, ObjectRef], last: dict[str, int]) -> ObjectRef:
        node = self.world.home.ids[index]
        if node not in known:
            name = self.world.home.classes[index]
            thing = self.knowledge.object_class(name)
            name = thing.name if thing is not None else name
            last[name] = last.get(name, 0) + 1
            known[node] = ObjectRef(name, last[name], node)
        return known[node]

    def ref(self, index: int) -> ObjectRef:
        """One node as an object of the program."""
        return self.refs((index,))[0]

    def is_close(self, index: int) -> bool:
        """Return whether the character is close to a node."""
        return edge_rows.is_near(self.world, self.agent, index, self.rules.near_hands)

    def by_distance(self, things: Iterable[int]) -> list[int]:
        """Things that are close first, then those in the character's room; among equals by index."""
        room = edge_rows.agent_room(self.world, self.agent)
        return sorted(things, key=lambda i: (not self.is_close(i), edge_rows.room_of(self.world, i) != room, i))

    def nearest(self, things: Iterable[int]) -> int | None:
        """Return the nearest of some things, out of something closed only where there is no other; None of none."""
        ordered = self.by_distance(things)
        return min(ordered, key=lambda i: edge_rows.closed_container(self.world, i) >= 0, default=None)

    def does(self, action: str, *objects: ObjectRef) -> Step:
        """Return a new step of the same character."""
        return Step(action, objects, self.failure.agent)

    @property
    def posture(self) -> frozenset[str]:
        """Actions that leave a seat or a place, or take a seat."""
        return self.group("rests") | self.group("rises") | self.group("walks")

    def is_inserted(self, number: int) -> bool:
        """Return whether a repair has inserted a step, which may be done in any circumstances."""
        return bool(self.wanted) and self.wanted[number] is None

    def rests_at(self, number: int) -> bool | None:
        """Return whether the original does a step sitting or lying.

        None where that is unknown, or the step inserted.
        """
        known = self.wanted[number] if self.wanted else None
        return None if known is None else any(f.name in RESTING and not f.negated for f in known)

    def world_before(self, number: int) -> World:
        """Return the world before the tick of a step that was done, or before the failing one."""
        ticks = sum(not step.joins for step in self.program.steps[1 : number + 1])
        return self.worlds[ticks] if number < self.at else self.world

    def seat_taken(self) -> tuple[int, str, ObjectRef] | None:
        """Return where the program itself has made the character rest, how, and its seat.

        (number of the step, "Sit", couch).
        """
        for number in range(self.at - 1, -1, -1):
            step = self.program.steps[number]
            if step.agent == self.failure.agent and step.action in self.group("rests"):
                return number, step.action, step.objects[0]
            if step.agent == self.failure.agent and step.action in self.group("rises"):
                return None
        return None


class Splice(NamedTuple):
    """Some steps instead of others: `removed` steps from number `at` on give way to `inserted`."""

    at: int
    removed: int
    inserted: tuple[Step, ...] = ()


class Edit(NamedTuple):
    """A repair.

    Attributes:
        name: as in the knowledge's repairs where it stands there.
        splices: in ascending order.
        stays: whether the steps it inserts stay, even if the program does not need them.
    """

    name: str
    splices: tuple[Splice, ...]
    stays: bool = False


Handler = Callable[[RepairContext], Edit | None]
"""From a failure to its repair; None when nothing can be done about it."""


def removed(context: RepairContext, name: str) -> Edit:
    """Leave the failing step out; what was to happen together with it happens all the same."""
    steps = context.program.steps
    at = context.at
    if not steps[at].joins and at + 1 < len(steps) and steps[at + 1].joins:
        rest = steps[at + 1]
        alone = Step(rest.action, rest.objects, rest.agent, False, rest.modifiers)
        return Edit(name, (Splice(at, 2, (alone,)),))
    return Edit(name, (Splice(at, 1),))


def leaving_out(name: str) -> Handler:
    """Return the handler whose repair has that name."""

    def handler(context: RepairContext) -> Edit | None:
        """Leave the step out."""
        return removed(context, name)

    return handler


def before(context: RepairContext, name: str, *steps: Step) -> Edit:
    """Do something first."""
    return Edit(name, (Splice(tick_start(context.program, context.at), 0, steps),))


def around(context: RepairContext, name: str, first: Iterable[Step], after: int, then: Iterable[Step]) -> Edit:
    """Do something before the failing step, and something else right after step number `after`."""
    start = tick_start(context.program, context.at)
    end = tick_end(context.program, after)
    return Edit(name, (Splice(start, 0, tuple(first)), Splice(end, 0, tuple(then))))


def replaced(context: RepairContext, name: str, *steps: Step) -> Edit:
    """Do something instead."""
    return Edit(name, (Splice(context.at, 1, steps),))


def tick_start(program: Program, at: int) -> int:
    """Return the number of the first step of the tick that step `at` belongs to."""
    while 0 < at < len(program.steps) and program.steps[at].joins:
        at -= 1
    return at


def tick_end(program: Program, at: int) -> int:
    """Return the number of the first step after the tick that step `at` belongs to."""
    at += 1
    while at < len(program.steps) and program.steps[at].joins:
        at += 1
    return min(at, len(program.steps))
