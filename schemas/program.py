"""Programs: what a person says is to be done, step by step (thesis 2.3.3, eq. 2.1)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace

from hearth.schemas.short_repr import brief

MOST_OBJECTS = 2
"""Objects that an action takes at most."""


@dataclass(frozen=True, slots=True, order=True)
class ObjectRef:
    """An object as a program names it: `<television> (1)`.

    Attributes:
        name: class name, lower case with underscores.
        instance: counter among the program's objects of that name, from 1; 0 when only a node is named.
        node: id of the graph node it is bound to, or None.
    """

    name: str
    instance: int = 1
    node: int | None = None

    @property
    def key(self) -> tuple[str, int]:
        """Identity within its program, independent of its binding.

        An object that only a node names has that node, below 0.
        """
        return (self.name, self.instance or -(self.node or 0))


@dataclass(frozen=True, slots=True)
class Step:
    """One instruction of one agent.

    Attributes:
        action: canonical name (`PutBack`).
        objects: its arguments in order.
        agent: which agent acts.
        joins: done in the same tick as the step before (`... | ...`).
        modifiers: how it is done, as (name, value) pairs: `("at", "3,2")`, `("hand", "left")`, `("speed", "slow")`.
    """

    action: str
    objects: tuple[ObjectRef, ...] = ()
    agent: int = 0
    joins: bool = False
    modifiers: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Program:
    """A titled, described list of steps.

    Attributes:
        title: one line.
        description: sentences, possibly over several lines.
        steps: the instructions in order.
        lines: where each step stood in its file, from 1; empty when unknown, and not part of its identity.
    """

    title: str = ""
    description: str = ""
    steps: tuple[Step, ...] = ()
    lines: tuple[int, ...] = field(default=(), compare=False)

    __repr__ = brief

    def line(self, number: int) -> int:
        """Return the file line of step `number` (from 0), or 0 when unknown."""
        return self.lines[number] if number < len(self.lines) else 0

    def ticks(self) -> Iterator[tuple[Step, ...]]:
        """Yield the steps that happen together, in order."""
        group: list[Step] = []
        for step in self.steps:
            if group and not step.joins:
                yield tuple(group)
                group = []
            group.append(step)
        if group:
            yield tuple(group)

    def objects(self) -> tuple[ObjectRef, ...]:
        """Every distinct object, in order of first mention."""
        seen: dict[tuple[str, int], ObjectRef] = {}
        for step in self.steps:
            for ref in step.objects:
                seen.setdefault(ref.key, ref)
        return tuple(seen.values())

    def agents(self) -> int:
        """Return how many agents it needs: one more than the highest it names."""
        return max((step.agent for step in self.steps), default=0) + 1

    def with_steps(self, steps: Iterable[Step]) -> Program:
        """Return the same title and description with other steps."""
        return Program(self.title, self.description, tuple(steps))

    def unbound(self) -> Program:
        """Return the program as collected: node ids left out, and instances for the objects that they alone named."""
        return self.numbered().bound({})

    def numbered(self) -> Program:
        """Return the program with an instance for each object that only a node names, so it can get other nodes."""
        if all(ref.instance for step in self.steps for ref in step.objects):
            return self
        taken = {ref.key for ref in self.objects() if ref.instance}
        given: dict[ObjectRef, ObjectRef] = {}
        for ref in self.objects():
            if not ref.instance:
                free = next(n for n in range(1, len(taken) + 2) if (ref.name, n) not in taken)
                given[ref] = ObjectRef(ref.name, free, ref.node)
                taken.add((ref.name, free))
        steps = (replace(step, objects=tuple(given.get(ref, ref) for ref in step.objects)) for step in self.steps)
        return replace(self, steps=tuple(steps))

    def bound(self, nodes: dict[tuple[str, int], int]) -> Program:
        """Return the program with each object bound to the node given for its (name, instance), or to none."""

        refs = {ref: ObjectRef(ref.name, ref.instance, nodes.get(ref.key)) for ref in _refs(self.steps)}
        steps = tuple(
            Step(s.action, tuple([refs[ref] for ref in s.objects]), s.agent, s.joins, s.modifiers) for s in self.steps
        )
        return Program(self.title, self.description, steps, self.lines)


def _refs(steps: Iterable[Step]) -> set[ObjectRef]:
    return {ref for step in steps for ref in step.objects}
