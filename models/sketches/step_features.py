"""The chooser's features of the possible next steps, as numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import cached_property
from random import Random
from typing import NamedTuple

from hearth.models.decoding.next_step_options import Options
from hearth.models.sketches.candidate_choices import Candidate, Choice
from hearth.models.sketches.name_numbers import Words
from hearth.models.sketches.next_steps import ROLES, STYLE, Deed, Habits, NextSteps
from hearth.models.sketches.sketch_progress import Progress, plain
from hearth.models.sketches.text_features import AROUND, TextState
from hearth.schemas.program import Step
from hearth.simulation.observation import reach
from hearth.simulation.world import edge_rows
from hearth.simulation.world.states import LYING, SITTING


class Offer:
    """The candidates for a program's next step; None is its end.

    Args:
        progress: so far.
        options: the possible steps now.
        habits: the steps of programs that their sketches leave out.
        words: numbers of names.
    """

    def __init__(self, progress: Progress, options: Options, habits: Habits, words: Words) -> None:
        self.progress, self.options, self.words, self.habits = progress, options, words, habits
        self.world, self.home = progress.world, progress.world.home
        self.me = self.world.agents[0]
        self.coming, self.proposed = progress.coming, progress.proposed
        self._next_steps = NextSteps(progress, options, habits)
        self.roles, deed = self._next_steps.roles, self._next_steps.deed
        self._past = Past([deed(step) for step in progress.steps], progress.since)
        self._known: dict[int, _OfNode] = {}
        self.planned = {deed(each.step): n for n, each in reversed(list(enumerate(progress.plan)))}
        self._deeds = self._next_steps.steps
        self.candidates: list[Step | None] = list(self._deeds.values())
        if self.coming is None:
            self.candidates.append(None)

    def choice(self) -> Choice:
        """Return the choice as features."""
        return self._choice(range(len(self.candidates)), -1)

    def known_choice(self, right: Step | None, most: int, random: Random) -> Choice | None:
        """Return the choice whose right step is known, with random others; None if the right step is not offered.

        Against random candidates a network learns the same order as against all, and in a third of the time.
        """
        wanted = None if right is None else plain(right, self.home)
        if wanted not in self.candidates:
            return None
        place = self.candidates.index(wanted)
        others = [n for n in range(len(self.candidates)) if n != place]
        some = sorted([place, *random.sample(others, min(most - 1, len(others)))])
        return self._choice(some, some.index(place))

    def _choice(self, places: Sequence[int], right: int) -> Choice:
        deeds = [*self._deeds]
        candidates = [self._candidate(deeds[n]) if n < len(deeds) else self._end() for n in places]
        return Choice(self._names(), self._bag, self._numbers(), candidates, right, self.progress.clues.bag(self.words))

    def _end(self) -> Candidate:
        return Candidate([self.words.code(0), *[0] * (2 + AROUND)], [1.0, *NOTHING[1:]])

    def _names(self) -> list[int]:
        """Return the last three actions, the next steps of sketch and plan, the progress, and the character's place."""
        word, progress = self.words, self.progress
        before = [step.action for step in progress.steps[:-4:-1]] + ["", "", ""]
        classes = [ref.name for ref in (self.coming.objects if self.coming else ())] + ["", ""]
        then = progress.sketch[progress.next + 1 : progress.next + 2]
        prepared = [each.step for each in progress.plan[:2]] + [Step(""), Step("")]
        about = [ref.name for ref in prepared[0].objects] + [""]
        done = progress.sketch[progress.next - 1 : progress.next] if progress.next else ()
        room = edge_rows.agent_room(self.world, self.me)
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
        nodes = self._next_steps.nodes(self.coming) if self.coming else []
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
            self._text.place,
            self._text.done,
            float(bool(progress.clues.words)),
        ]

    def _here(self, node: int) -> list[float]:
        bit = 1 << node
        room = edge_rows.agent_room(self.world, self.me)
        return [
            float(bool(self._close & bit)),
            float(bool(self._faced & bit)),
            float(bool(self.me.held & bit)),
            float(edge_rows.room_of(self.world, node) == room),
            float(bool(self.home.rooms & bit)),
        ]

    @cached_property
    def _text(self) -> TextState:
        """Return how far the text is done."""
        steps = self.progress.steps
        return TextState.of(self.progress.clues, (ref.name for step in steps for ref in step.objects[::-1]))

    @cached_property
    def _close(self) -> int:
        return reach.close_to(self.world, self.me)

    @cached_property
    def _faced(self) -> int:
        return reach.faced_by(self.world, self.me)

    @cached_property
    def _next(self) -> tuple[Deed | None, Deed | None]:
        """Return the next steps of the sketch and of the plan."""
        coming, proposed = (
            None if step is None else self._next_steps.deed(step) for step in (self.coming, self.proposed)
        )
        return coming, proposed

    def _candidate(self, deed: Deed) -> Candidate:
        action, first, second = deed
        coming, proposed = self._next
        here, other = self._of(first), self._of(second)
        numbers = [
            0.0,
            float(deed == coming),
            float(deed == proposed),
            1 / (1 + self.planned[deed]) if deed in self.planned else 0.0,
            float(second >= 0),
            *self._past.of(deed),
            *here.numbers,
            *other.numbers[:2],
            *other.mention,
        ]
        return Candidate([self.words.action(action), here.number, other.number, *here.around], numbers)

    def _of(self, node: int) -> _OfNode:
        """Return the features that all steps about a node share."""
        known = self._known.get(node)
        if known is None:
            known = self._known[node] = self._looked(node) if node >= 0 else NO_NODE
        return known

    def _looked(self, node: int) -> _OfNode:
        """Return a node's class, the words about its mention, its roles, place, states, and place in the text."""
        clues, name = self.progress.clues, self.home.classes[node]
        states = [float(state >> node & 1) for state in self.world.states]
        place = clues.place(name)
        mention = [1.0, place, place - self._text.place] if place >= 0 else [0.0] * MENTION_NUMBERS
        numbers = [*self.roles.get(node, NO_ROLES), *self._here(node), *states, *mention]
        return _OfNode(self.words.thing(name), clues.around(name, self.words), numbers, mention)


class _OfNode(NamedTuple):
    """The number of its class, those of the words about its mention, its numbers, and of these the mention's."""

    number: int
    around: Sequence[int]
    numbers: Sequence[float]
    mention: Sequence[float]


NO_ROLES = [0.0] * ROLES


class Past:
    """The steps of a program so far, counted once for all candidates.

    Args:
        deeds: so far.
        since: how many of them since the last step of the sketch.
    """

    def __init__(self, deeds: Sequence[Deed], since: int) -> None:
        self.times = Counter(deeds)
        self.about: dict[int, list[str]] = {}
        for action, first, _ in deeds:
            self.about.setdefault(first, []).append(action)
        recent = deeds[len(deeds) - since :]
        self.recent = {*recent}
        self.recent_about = {first for _, first, _ in recent}
        self.recent_actions = {action for action, _, _ in recent}
        self.last = deeds[-1] if deeds else ("", -2, -2)

    def of(self, deed: Deed) -> list[float]:
        """Return whether a step, its action and its object have come before, and how lately."""
        action, first, _ = deed
        about = self.about.get(first, []) if first >= 0 else []
        return [
            min(self.times[deed], 3) / 2,
            float(deed in self.recent),
            min(about.count(action), 3) / 2,
            min(len(about), 4) / 4,
            float(first >= 0 and first in self.recent_about),
            float(self.last[0] == action),
            float(action in self.recent_actions),
            float(self.last[1] == first),
        ]


MENTION_NUMBERS = 3
"""Numbers of a node that the text is about."""

CANDIDATE_NUMBERS = 5 + 8 + ROLES + 2 + 5 + 10 + 2 * MENTION_NUMBERS
"""Numbers of a candidate step."""

NOTHING = [0.0] * CANDIDATE_NUMBERS

NO_NODE = _OfNode(0, [0] * AROUND, [0.0] * (ROLES + 5 + 10 + MENTION_NUMBERS), [0.0] * MENTION_NUMBERS)
