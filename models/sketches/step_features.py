"""What the chooser knows of the steps that may come next: those of plan and sketch, and optional ones.

The exact planner makes a program run; optional steps are what people and repairs do besides: walk to the room first,
find, look, put back, close. Their choice is learned.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.models.decoding.options import Options
from hearth.models.sketches.choices import Candidate, Choice
from hearth.models.sketches.name_numbers import Words
from hearth.models.sketches.sketch_progress import Progress, plain
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.observation import reach
from hearth.simulation.world import rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.states import LYING, SITTING

ROLES = 18
"""What a node may be to the step that comes next; see `Situation.roles`."""

STYLE = 9
"""Habitual actions, the commonest, whose counts so far show how a program is written."""

SHOWN = 3
"""Things of one kind whose steps are offered: what is held, is done before, comes later."""


TOOLS = 5
"""Classes beside the sketch's of which things are offered."""


class Habits(NamedTuple):
    """What programs do beside their sketches, as counted in training programs.

    Attributes:
        actions: those of steps that sketches leave out.
        style: the commonest of them.
        tools: classes that programs use beside a class or an action of the sketch, the commonest first.
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
            others = {r.name for step in steps for r in step.objects if not knowledge.is_room(r.name)} - {*names}
            named.update(names.keys())
            for name in names:
                beside.setdefault(name, Counter()).update(others)
        tools = {
            name: tuple(other for other, n in found.most_common(TOOLS) if n >= FEWEST and n >= named[name] * OFTEN)
            for name, found in sorted(beside.items())
        }
        common = sorted((name for name, n in actions.items() if n >= FEWEST), key=lambda name: (-actions[name], name))
        return cls(frozenset(common), tuple(common[:STYLE]), tools)


def _named(sketch: Sequence[Step]) -> dict[str, None]:
    """The classes and the actions of a sketch."""
    return dict.fromkeys([*(ref.name for step in sketch for ref in step.objects), *(step.action for step in sketch)])


FEWEST, OFTEN = 5, 0.08
"""How often something is done at least to be a habit: in programs, and in how many of those with the class."""


class Offer:
    """The candidates for a program's next step; None is its end.

    Args:
        progress: so far.
        options: what can be done now.
        habits: what programs do beside their sketches.
        words: numbers of names.
    """

    def __init__(self, progress: Progress, options: Options, habits: Habits, words: Words) -> None:
        self.progress, self.options, self.words, self.habits = progress, options, words, habits
        self.world, self.home = progress.world, progress.world.home
        self.me = self.world.agents[0]
        self.coming, self.proposed = progress.coming, progress.proposed
        self._past = Past(progress.steps, progress.since)
        self._known: dict[int, list[float]] = {}
        self.planned = {each.step: n for n, each in reversed(list(enumerate(progress.plan)))}
        self.candidates: list[Step | None] = list(dict.fromkeys(self._found(habits.actions)))
        if self.coming is None:
            self.candidates.append(None)

    def _found(self, optional: frozenset[str]) -> Iterator[Step]:
        """The next steps of plan and sketch, if they can be done, and optional ones about nodes that play a role."""
        home = self.home
        for step in (self.coming, self.proposed):
            if step is not None and self.options.allows(step.action, self._nodes(step)):
                yield step
        for action in sorted(optional & self.options.masks.keys()):
            masks = self.options.masks[action]
            if not masks:
                yield Step(action)
            for node in self.roles if masks else ():
                if masks[0] >> node & 1:
                    first = ObjectRef(home.classes[node], 1, home.ids[node])
                    if len(masks) == 1:
                        yield Step(action, (first,))
                    for other in self.roles if len(masks) > 1 else ():
                        if masks[1] >> other & 1 and other != node:
                            yield Step(action, (first, ObjectRef(home.classes[other], 1, home.ids[other])))

    @cached_property
    def roles(self) -> Mapping[int, list[float]]:
        """The nodes that steps are offered about, and their roles."""
        found: dict[int, list[float]] = {}
        for role, nodes in enumerate(self._by_role()):
            for node in nodes:
                if node >= 0:
                    found.setdefault(node, [0.0] * ROLES)[role] = 1.0
        return found

    def _by_role(self) -> Iterator[Sequence[int]]:
        world, progress = self.world, self.progress
        first, second = (*(self._nodes(self.coming) if self.coming else ()), -1, -1)[:2]
        yield (first,)
        yield (second,)
        yield (rows.room_of(world, first) if first >= 0 else -1,)
        yield (rows.closed_container(world, first) if first >= 0 else -1,)
        yield (rows.room_of(world, second) if second >= 0 else -1,)
        last = progress.steps[-1:]
        yield self._nodes(last[0])[:1] if last else ()
        yield self._nodes(last[0])[1:] if last else ()
        yield list(indices(self.me.held))[:SHOWN]
        yield self._nodes(self.proposed) if self.proposed else ()
        later = [node for step in progress.sketch[progress.next + 1 :] for node in self._nodes(step)]
        yield list(dict.fromkeys(later))[:SHOWN]
        earlier = [node for step in progress.steps[-2::-1] for node in self._nodes(step)]
        yield [node for node in dict.fromkeys(earlier) if not self.home.rooms >> node & 1][:SHOWN]
        yield [rows.room_of(world, node) for node in later[:1]]
        yield list(indices(rows.on(world, first)))[:1] if first >= 0 and not self.home.characters >> first & 1 else ()
        yield list(indices(self.me.on))[:1]
        yield [rows.room_of(world, node) for node in later[1:]]
        around = (
            rows.inside(world, node) & ~self.home.rooms | rows.on(world, node) for node in (first, *later) if node >= 0
        )
        yield [found for mask in around for found in list(indices(mask))[:2]]
        yield list(indices(self.home.rooms))
        yield self._tools()

    def _tools(self) -> list[int]:
        """Things that the sketch does not name, of classes that programs use with those it names; in the room first."""
        home, world = self.home, self.world
        names = _named(self.progress.sketch)
        used = dict.fromkeys(other for name in names for other in self.habits.tools.get(name, ()) if other not in names)
        room = rows.agent_room(world, self.me)
        found = []
        for name in list(used)[:TOOLS]:
            nodes = sorted(indices(home.by_class.get(name, 0)), key=lambda i: rows.room_of(world, i) != room)
            found += nodes[:2]
        return found

    def _nodes(self, step: Step) -> list[int]:
        return [self.home.index[ref.node] for ref in step.objects if ref.node is not None]

    # Features

    def choice(self, right: Step | None = None, *, known: bool = False) -> Choice:
        """The choice as features; `right` is the step that came next, if it is `known`."""
        place = -1
        if known:
            wanted = None if right is None else plain(right, self.home)
            place = self.candidates.index(wanted) if wanted in self.candidates else -1
        candidates = [self._candidate(step) for step in self.candidates]
        return Choice(self._names(), self._bag, self._numbers(), candidates, place)

    def _names(self) -> list[int]:
        """Three actions before, what the sketch and the plan want next, how far it is, and where the character is."""
        word, progress = self.words, self.progress
        before = [step.action for step in progress.steps[:-4:-1]] + ["", "", ""]
        classes = [ref.name for ref in (self.coming.objects if self.coming else ())] + ["", ""]
        then = progress.sketch[progress.next + 1 : progress.next + 2]
        prepared = [each.step for each in progress.plan[:2]] + [Step(""), Step("")]
        about = [ref.name for ref in prepared[0].objects] + [""]
        done = progress.sketch[progress.next - 1 : progress.next] if progress.next else ()
        room = rows.agent_room(self.world, self.me)
        return [
            *(word.action(name) for name in before[:3]),
            word.action(self.coming.action if self.coming else ""),
            *(word.thing(name) for name in classes[:2]),
            word.action(then[0].action if then else ""),
            word.action(done[0].action if done else ""),
            *(word.action(step.action) for step in prepared[:2]),
            word.thing(about[0]),
            word.code(progress.since),
            word.code(progress.next),
            word.code(len(progress.sketch) - progress.next),
            word.thing(self.home.classes[room] if room >= 0 else ""),
        ]

    @property
    def _bag(self) -> list[int]:
        word = self.words
        names = [
            (word.action(s.action), *(word.thing(ref.name) for ref in s.objects[:1])) for s in self.progress.sketch
        ]
        return [number for each in names for number in each]

    def _numbers(self) -> list[float]:
        world, progress, me = self.world, self.progress, self.me
        nodes = self._nodes(self.coming) if self.coming else []
        able = self.coming is not None and self.options.allows(self.coming.action, nodes)
        counts = [step.action for step in progress.steps]
        left = next((n for n, each in enumerate(progress.plan) if each.source >= 0), 0)
        return [
            float(able),
            float(bool(world.states[SITTING] & me.bit)),
            float(bool(world.states[LYING] & me.bit)),
            me.held.bit_count() / 2,
            len(progress.steps) / 20,
            progress.since / 6,
            left / 8,
            len(progress.plan) / 20,
            *(counts.count(name) / (1 + progress.next) for name in (*self.habits.style, *[""] * STYLE)[:STYLE]),
            *(self._here(nodes[0]) if nodes else [0.0] * 5),
        ]

    def _here(self, node: int) -> list[float]:
        bit = 1 << node
        room = rows.agent_room(self.world, self.me)
        return [
            float(bool(self._close & bit)),
            float(bool(self._faced & bit)),
            float(bool(self.me.held & bit)),
            float(rows.room_of(self.world, node) == room),
            float(bool(self.home.rooms & bit)),
        ]

    @cached_property
    def _close(self) -> int:
        return reach.close_to(self.world, self.me)

    @cached_property
    def _faced(self) -> int:
        return reach.faced_by(self.world, self.me)

    def _candidate(self, step: Step | None) -> Candidate:
        word = self.words
        if step is None:
            return Candidate([word.code(0), 0, 0], [1.0, *[0.0] * (CANDIDATE_NUMBERS - 1)])
        nodes = self._nodes(step)
        first, second = (*nodes, -1, -1)[:2]
        numbers = [
            0.0,
            float(step == self.coming),
            float(step == self.proposed),
            1 / (1 + self.planned[step]) if step in self.planned else 0.0,
            float(len(nodes) > 1),
            *self._past.of(step),
            *self._roles_of(first),
            *self._roles_of(second)[:2],
            *self._looks(first),
        ]
        return Candidate([word.action(step.action), self._class(first), self._class(second)], numbers)

    def _roles_of(self, node: int) -> list[float]:
        return self.roles.get(node, NO_ROLES)

    def _class(self, node: int) -> int:
        return self.words.thing(self.home.classes[node]) if node >= 0 else 0

    def _looks(self, node: int) -> list[float]:
        """Where a node is to the character, and its states: the same for all steps about it."""
        if node < 0:
            return [0.0] * 15
        known = self._known.get(node)
        if known is None:
            states = [float(state >> node & 1) for state in self.world.states]
            known = self._known[node] = [*self._here(node), *states]
        return known


NO_ROLES = [0.0] * ROLES


class Past:
    """What a program has done so far, counted once for all candidates.

    Args:
        steps: so far.
        since: how many of them since the last step of the sketch.
    """

    def __init__(self, steps: Sequence[Step], since: int) -> None:
        self.times = Counter(steps)
        self.about: dict[ObjectRef | None, list[str]] = {}
        for step in steps:
            self.about.setdefault(_first(step), []).append(step.action)
        recent = steps[len(steps) - since :]
        self.recent = {*recent}
        self.recent_about = {_first(step) for step in recent}
        self.recent_actions = {step.action for step in recent}
        self.last = steps[-1] if steps else None

    def of(self, step: Step) -> list[float]:
        """Whether a step, its action and its object have come before, and how lately."""
        first = _first(step)
        about = self.about.get(first, []) if first else []
        return [
            min(self.times[step], 3) / 2,
            float(step in self.recent),
            min(about.count(step.action), 3) / 2,
            min(len(about), 4) / 4,
            float(first is not None and first in self.recent_about),
            float(self.last is not None and self.last.action == step.action),
            float(step.action in self.recent_actions),
            float(self.last is not None and _first(self.last) == first),
        ]


def _first(step: Step) -> ObjectRef | None:
    return step.objects[0] if step.objects else None


CANDIDATE_NUMBERS = 5 + 8 + ROLES + 2 + 5 + 10
"""Numbers of a candidate step."""
