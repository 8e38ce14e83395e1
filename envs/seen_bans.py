"""The bans of a goal, as far as an agent sees that they were broken; a broken ban puts the goal out of reach."""

from __future__ import annotations

from collections.abc import Iterator

from hearth.schemas.goals import BANS, Goal, Joined
from hearth.schemas.program import Step
from hearth.simulation.goals import Progress
from hearth.simulation.observation.views import View

OUT_OF_REACH = "the goal can't be reached any longer"
"""Said where a part of a goal is lost, to people and to agents."""


class SeenBans:
    """The bans of one agent's goal, followed through its observations.

    Args:
        goal: the agent's goal.
        view: the agent's first observation.
    """

    def __init__(self, goal: Goal, view: View) -> None:
        bans = tuple(part for part in goal.parts if part.join in BANS)
        self._progress = Progress.at(Goal(parts=bans), view.world)
        self._tick = view.tick

    def look(self, view: View) -> None:
        """Take the observation of a new tick: the world, and the acts of the characters that are seen."""
        if self._progress.goal.parts and view.tick > self._tick:
            before = self._progress.trace.worlds[-1] if self._progress.trace else view.world
            self._progress = self._progress.then(before, view.world, tuple(_done(view)))
            self._tick = view.tick

    def lines(self) -> Iterator[str]:
        """Yield a line for each ban: whether it is kept, and where it is lost, what that means."""
        for part, lost, kept in self.states():
            yield f"  {part}: {f'broken; {OUT_OF_REACH}' if lost else 'kept so far' if kept else 'not so now'}"

    def states(self) -> Iterator[tuple[Joined, bool, bool]]:
        """Yield each ban, whether it is lost for good, and whether it is kept."""
        progress = self._progress
        yield from zip(progress.goal.parts, progress.lost, progress.has, strict=True)


def _done(view: View) -> Iterator[Step]:
    for pose in (view.me, *view.others):
        if pose.last is not None and pose.last.failure is None:
            yield pose.last.instruction
