"""The part of a goal that a program brought about: literals that held at the start earn nothing."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

from hearth.schemas.goals import Goal
from hearth.scoring.signature import signature
from hearth.simulation.engine import Execution
from hearth.simulation.goals import Progress, Watch
from hearth.simulation.processes import as_wide_as
from hearth.simulation.world.world import World


def signatures_of(own: int) -> dict[str, str]:
    """Return the signatures of both readings, with the number of rows that had a goal of their own, if any had."""
    options = {"level": "program", "empty": 1} | ({"own": own} if own else {})
    return {"goal": signature("goal", 2, **options | {"empty": 0}), "goal_whole": signature("goal_whole", 2, **options)}


@dataclass(frozen=True, slots=True)
class GoalScore:
    """A goal at the end of a program, against the start.

    Attributes:
        left: conditions that did not hold at the start, each as often as it is wanted.
        gained: those of them that hold at the end; 0 for a program that fails.
        broken: conditions of a given goal that held at the start and do not hold at the end.
        whole: whether every condition holds at the end, whatever held at the start.
        whole_fraction: the share of all conditions that holds at the end.
    """

    left: int
    gained: int = 0
    broken: int = 0
    whole: bool = False
    whole_fraction: float = 0.0

    @property
    def reached(self) -> bool:
        """Return whether all that was left to do is done, and nothing that held is broken."""
        return self.gained == self.left and not self.broken

    @property
    def fraction(self) -> float:
        """Return the share of the missing and of the broken literals that is done."""
        return self.gained / (self.left + self.broken) if self.left + self.broken else 1.0


class Achieved(NamedTuple):
    """The achievements of a reference.

    Attributes:
        start: its goal in the world before it.
        wanted: how often each literal newly holds after it.
    """

    start: Progress
    wanted: tuple[int, ...]

    @classmethod
    def of(cls, goal: Goal, start: World, final: World) -> Achieved:
        """Return the literals of a goal that newly hold at the end of a reference.

        A thing that held at the start counts for nothing: where one of two lamps was on, `ON(lamp)` asks for the other.
        """
        before = Progress.at(goal, as_wide_as(start, final))
        return cls(before, tuple(_gained(before, _at(before, final))))

    def score(self, final: World | None) -> GoalScore:
        """Score a program by the world at its end; None if the program fails."""
        left = sum(self.wanted)
        if final is None:
            return GoalScore(left)
        after = _at(self.start, final)
        gained = sum(map(min, _gained(self.start, after), self.wanted))
        return GoalScore(left, gained, 0, after.satisfied, after.fraction)


def of_given(goal: Goal, start: World, execution: Execution | None) -> GoalScore:
    """Score a goal that a row brings along; `execution` is None if the program fails.

    Raises:
        HearthError: as `Progress.start`.
    """
    before = _conditions(Progress.start(goal, start))
    left = sum(wanted - min(held, wanted) for held, wanted in before)
    if execution is None:
        return GoalScore(left)
    progress = Progress.of(goal, execution)
    after = _conditions(progress)
    changes = [min(now, wanted) - min(held, wanted) for (held, wanted), (now, _) in zip(before, after, strict=True)]
    gained, broken = sum(each for each in changes if each > 0), -sum(each for each in changes if each < 0)
    return GoalScore(left, gained, broken, progress.satisfied, progress.fraction)


def _conditions(progress: Progress) -> list[tuple[int, int]]:
    """Return how often each condition of a goal holds, and is wanted."""
    return [
        *((held, wanted) for held, (_, wanted) in progress.required()),
        *((int(reached), 1) for reached in progress.has),
    ]


def _at(progress: Progress, world: World) -> Progress:
    """Return a goal's progress in another world of the same home."""
    watches = (replace(each, met=each.candidates.met(world)) for each in progress.watches)
    return Progress(progress.goal, tuple(watches))


def _gained(before: Progress, after: Progress) -> Iterator[int]:
    """Yield how often each literal newly holds."""
    return map(_new, before.watches, after.watches)


def _new(before: Watch, after: Watch) -> int:
    return sum((now & ~held).bit_count() for held, now in zip(before.met, after.met, strict=True))
