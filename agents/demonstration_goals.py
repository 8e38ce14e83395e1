"""Demonstrations read as goals without learning: by placements, by the last frame, by chance (thesis 6.5).

The network that reads them from states is in `models/watching/`.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from random import Random

from hearth.schemas.goals import Goal
from hearth.schemas.literals import HANDS, HOLDS, Literal, Name
from hearth.simulation.env import Tick
from hearth.simulation.literal_truth import Candidates, candidates
from hearth.simulation.world.home import Home

Predicate = Literal[Name]


@dataclass(frozen=True, slots=True)
class Question:
    """The task of inferring a goal.

    Attributes:
        predicates: those that a goal may have, about names or nodes of the demonstration's home.
        goals: possible goals, of which chance draws one; each as probable as it is frequent.
    """

    predicates: tuple[Predicate, ...]
    goals: tuple[Goal, ...] = ()


Reader = Callable[[Sequence[Tick], Question, Random], Goal]
"""(ticks, question, chooser) -> the inferred goal, of the question's predicates with their counts."""


def by_actions(ticks: Sequence[Tick], question: Question, chooser: Random, agent: int = 0) -> Goal:
    """Count the different things that an agent put, took or rested on where a predicate names them.

    A thing that the agent took away again counts, too.
    """
    if not ticks:
        return Goal()
    home = ticks[-1].world.home
    found = [(each, candidates(each, home)) for each in question.predicates]
    done: defaultdict[Predicate, set[int]] = defaultdict(set)
    for tick in ticks:
        step = tick.instructions.get(agent)
        if step is None or agent in tick.failures:
            continue
        nodes = tuple(home.index.get(ref.node or -1, -1) for ref in step.objects)
        for predicate, some in found:
            if (thing := _made(step.action, nodes, some, home)) >= 0:
                done[predicate].add(thing)
    return Goal(tuple((each, len(done[each])) for each, _ in found if done[each]))


def _made(action: str, nodes: tuple[int, ...], some: Candidates, home: Home) -> int:
    """Return the index of the thing that an instruction makes count for a predicate, or -1."""
    known, name = home.knowledge, some.literal.name
    if not nodes:
        return -1
    thing, last = nodes[0], nodes[-1]
    if some.by_target:
        group = "takes" if name in (HOLDS, *HANDS) else "rests"
        return thing if action in known.group(group) and some.targets >> thing & 1 else -1
    if len(some.literal.terms) == 1:
        return thing if known.state_of(action) == name and some.subjects >> thing & 1 else -1
    if len(nodes) < 2 or known.relation_of(action) != name:
        return -1
    return thing if some.subjects >> thing & 1 and some.targets >> last & 1 else -1


def by_last_frame(ticks: Sequence[Tick], question: Question, chooser: Random) -> Goal:
    """Count the literals that hold in the end and did not hold at the start."""
    if not ticks:
        return Goal()
    first, last = ticks[0].before, ticks[-1].world
    counted = []
    for predicate in question.predicates:
        some = candidates(predicate, last.home)
        new = sum((now & ~then).bit_count() for now, then in zip(some.met(last), some.met(first), strict=True))
        counted.append((predicate, new))
    return Goal(tuple((predicate, number) for predicate, number in counted if number))


def by_chance(ticks: Sequence[Tick], question: Question, chooser: Random) -> Goal:
    """One of the possible goals, whatever happened."""
    return chooser.choice(question.goals) if question.goals else Goal()


def by_states(ticks: Sequence[Tick], question: Question, chooser: Random, model: str = "goal-inference") -> Goal:
    """Return the goal that a network infers from the places of things; needs the extra `models`.

    Args:
        ticks, question, chooser: as for every reader.
        model: a checkpoint's folder, or the name of one that comes with Hearth.
    """
    from hearth.models.watching.goal_inference import restored

    return restored(model).infer(ticks, question.predicates, question.goals)


READERS: dict[str, Reader] = {
    "actions": by_actions,
    "states": by_states,
    "last-frame": by_last_frame,
    "chance": by_chance,
}
"""The methods that read demonstrations, by the names that `challenge watch` has for them."""


@dataclass(frozen=True, slots=True)
class Agreement:
    """The agreement of an inferred goal with the true one.

    Predicates count as often as they are wanted (thesis 6.5.1).

    Attributes:
        both: in the true and in the inferred goal.
        inferred, true: in each of them.
    """

    both: int
    inferred: int
    true: int

    @property
    def precision(self) -> float:
        """Return the share of the inferred predicates that is true; 1 if none was inferred."""
        return self.both / self.inferred if self.inferred else 1.0

    @property
    def recall(self) -> float:
        """Return the share of the true predicates that was inferred; 1 for an empty goal."""
        return self.both / self.true if self.true else 1.0


def agreement(inferred: Goal, true: Goal) -> Agreement:
    """Compare two goals of the same predicates."""
    ours, theirs = dict(inferred), dict(true)
    both = sum(min(number, theirs.get(predicate, 0)) for predicate, number in ours.items())
    return Agreement(both, sum(ours.values()), sum(theirs.values()))
