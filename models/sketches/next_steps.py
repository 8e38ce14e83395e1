"""The steps that may come next: those of plan and sketch, and optional ones about nodes that play a role.

The exact planner makes a program run. Optional steps are the additional steps of people and repairs: walk to the room
first, find, look, put back, close. Their choice is learned.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.models.decoding.next_step_options import Options
from hearth.models.sketches.sketch_progress import Progress
from hearth.models.sketches.text_features import MOST
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices

ROLES = 19
"""Roles of a node for the next step; see `NextSteps.roles`."""

STYLE = 9
"""Habitual actions, the commonest, whose counts so far show how a program is written."""

SHOWN = 3
"""Largest number of things of one kind whose steps are offered: held things, things of earlier and of later steps."""

TOOLS = 5
"""Largest number of classes outside the sketch whose things are offered."""

FEWEST, OFTEN = 5, 0.08
"""Smallest frequency of a habit: a number of programs, and a share of the programs with the class."""

Deed = tuple[str, int, int]
"""A step as an action and the indices of its nodes; -1 for none."""


class Habits(NamedTuple):
    """The steps of programs that their sketches leave out, as counted in training programs.

    Attributes:
        actions: those of steps that sketches leave out.
        style: the commonest of them.
        tools: classes that programs use with a class or an action of the sketch, the commonest first.
    """

    actions: frozenset[str]
    style: tuple[str, ...]
    tools: Mapping[str, tuple[str, ...]]

    @classmethod
    def of(cls, programs: Iterable[tuple[Sequence[Step], Sequence[Step]]], knowledge: Knowledge) -> Habits:
        """Counted in (sketch, program) pairs."""
        actions: Counter[str] = Counter()
        beside: dict[str, Counter[str]] = {}
        named: Counter[str] = Counter()
        for sketch, steps in programs:
            kept = {*sketch}
            actions.update(step.action for step in steps if step not in kept)
            names = _named(sketch)
            used = {ref.name for step in steps for ref in step.objects} - {*names}
            others = sorted(name for name in used if not knowledge.is_room(name))  # a set's order is not the next run's
            named.update(names.keys())
            for name in names:
                beside.setdefault(name, Counter()).update(others)
        tools = {
            name: tuple(other for other, n in _commonest(found) if n >= FEWEST and n >= named[name] * OFTEN)
            for name, found in sorted(beside.items())
        }
        common = sorted((name for name, n in actions.items() if n >= FEWEST), key=lambda name: (-actions[name], name))
        return cls(frozenset(common), tuple(common[:STYLE]), tools)


def _commonest(found: Counter[str]) -> list[tuple[str, int]]:
    """Return the first `TOOLS` classes and their counts; of those counted as often, the first by name."""
    return sorted(found.items(), key=lambda each: (-each[1], each[0]))[:TOOLS]


def _named(sketch: Sequence[Step]) -> dict[str, None]:
    """Return the classes and the actions of a sketch."""
    return dict.fromkeys([*(ref.name for step in sketch for ref in step.objects), *(step.action for step in sketch)])


class NextSteps:
    """The candidates for a program's next step, and the nodes they are about.

    Args:
        progress: so far.
        options: the possible steps now.
        habits: the steps of programs that their sketches leave out.
    """

    def __init__(self, progress: Progress, options: Options, habits: Habits) -> None:
        self.progress, self.options, self.habits = progress, options, habits
        self.world, self.home = progress.world, progress.world.home
        self.me = self.world.agents[0]
        self.coming, self.proposed = progress.coming, progress.proposed
        self.steps: dict[Deed, Step] = dict(self._found(habits.actions))

    def nodes(self, step: Step) -> list[int]:
        """Return the indices of a step's nodes."""
        return [self.home.index[ref.node] for ref in step.objects if ref.node is not None]

    def deed(self, step: Step) -> Deed:
        """Return a step as its action and nodes."""
        first, second = (*self.nodes(step), -1, -1)[:2]
        return step.action, first, second

    def _found(self, optional: frozenset[str]) -> Iterator[tuple[Deed, Step]]:
        """Yield the next steps of plan and sketch, if possible, and optional ones about nodes that play a role."""
        for step in (self.coming, self.proposed):
            if step is not None and self.options.allows(step.action, self.nodes(step)):
                yield self.deed(step), step
        refs = {node: ObjectRef(self.home.classes[node], 1, self.home.ids[node]) for node in self.roles}
        for action in sorted(optional & self.options.masks.keys()):
            masks = self.options.masks[action]
            if not masks:
                yield (action, -1, -1), Step(action)
                continue
            for node in [node for node in refs if masks[0] >> node & 1]:
                if len(masks) == 1:
                    yield (action, node, -1), Step(action, (refs[node],))
                    continue
                for other, ref in refs.items():
                    if masks[1] >> other & 1 and other != node:
                        yield (action, node, other), Step(action, (refs[node], ref))

    @cached_property
    def roles(self) -> Mapping[int, list[float]]:
        """Return the nodes that steps are offered about, and their roles."""
        found: dict[int, list[float]] = {}
        for role, nodes in enumerate(self._by_role()):
            for node in nodes:
                if node >= 0:
                    found.setdefault(node, [0.0] * ROLES)[role] = 1.0
        return found

    def _by_role(self) -> Iterator[Sequence[int]]:
        world, progress = self.world, self.progress
        first, second = (*(self.nodes(self.coming) if self.coming else ()), -1, -1)[:2]
        yield (first,)
        yield (second,)
        yield (edge_rows.room_of(world, first) if first >= 0 else -1,)
        yield (edge_rows.closed_container(world, first) if first >= 0 else -1,)
        yield (edge_rows.room_of(world, second) if second >= 0 else -1,)
        last = progress.steps[-1:]
        yield self.nodes(last[0])[:1] if last else ()
        yield self.nodes(last[0])[1:] if last else ()
        yield list(indices(self.me.held))[:SHOWN]
        yield self.nodes(self.proposed) if self.proposed else ()
        later = [node for step in progress.sketch[progress.next + 1 :] for node in self.nodes(step)]
        yield list(dict.fromkeys(later))[:SHOWN]
        earlier = [node for step in progress.steps[-2::-1] for node in self.nodes(step)]
        yield [node for node in dict.fromkeys(earlier) if not self.home.rooms >> node & 1][:SHOWN]
        yield [edge_rows.room_of(world, node) for node in later[:1]]
        yield (
            list(indices(edge_rows.on(world, first)))[:1]
            if first >= 0 and not self.home.characters >> first & 1
            else ()
        )
        yield list(indices(self.me.on))[:1]
        yield [edge_rows.room_of(world, node) for node in later[1:]]
        around = (
            edge_rows.inside(world, node) & ~self.home.rooms | edge_rows.on(world, node)
            for node in (first, *later)
            if node >= 0
        )
        yield [found for mask in around for found in list(indices(mask))[:2]]
        yield list(indices(self.home.rooms))
        yield self._tools()
        yield self._mentioned()

    def _tools(self) -> list[int]:
        """Things that the sketch does not name, of classes that programs use with those it names; in the room first."""
        home, world = self.home, self.world
        names = _named(self.progress.sketch)
        used = dict.fromkeys(other for name in names for other in self.habits.tools.get(name, ()) if other not in names)
        room = edge_rows.agent_room(world, self.me)
        found = []
        for name in list(used)[:TOOLS]:
            nodes = sorted(indices(home.by_class.get(name, 0)), key=lambda i: edge_rows.room_of(world, i) != room)
            found += nodes[:2]
        return found

    def _mentioned(self) -> list[int]:
        """Things that the text mentions: those that steps were about, else the sketch's, else those nearest."""
        home, world, places = self.home, self.world, self.progress.clues.places
        if not places:
            return []
        room = edge_rows.agent_room(world, self.me)
        used = [node for step in (*self.progress.steps, *self.progress.sketch) for node in self.nodes(step)]
        own = {home.classes[node]: node for node in reversed(used)}
        found = [own[name] for name in places if name in own]
        for name in [name for name in places if name not in own][:MOST]:
            nodes = indices(next((home.by_class[n] for n in home.knowledge.same_class(name) if n in home.by_class), 0))
            found += sorted(nodes, key=lambda i: (edge_rows.room_of(world, i) != room, i))[:1]
        return found
