"""People to be helped who are unlike the one that helpers were tuned with (an open question of thesis 7.6)."""

from __future__ import annotations

from collections.abc import Callable

from hearth.agents.goal_space import GoalsIn
from hearth.agents.human_faults import Faults, Faulty
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal, Name
from hearth.schemas.program import Step
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View
from hearth.simulation.world.home import Home

TURNS = (5, 20)
"""The first and the last tick in which who changes their goal may do so."""


class Slow(Faulty):
    """An agent that acts in every other tick only."""

    def __init__(self) -> None:
        super().__init__(Faults())

    def act(self, observation: View, legal: Legal) -> Step | None:
        """Return the human-like agent's instruction, or none."""
        return None if observation.tick % 2 else super().act(observation, legal)


class NearSighted(Faulty):
    """A person that sees only the area around it, where all others see the whole home, and forgets places of things."""

    near_sighted = True

    def __init__(self) -> None:
        super().__init__(Faults(forgetting=0.02))


class ChangesGoal(Faulty):
    """A person that begins with another goal than the task's, gives it up in the middle, and leaves its results.

    Args:
        goals: that there may be in a home, of which the first is drawn.
    """

    def __init__(self, goals: GoalsIn) -> None:
        super().__init__(Faults())
        self._goals = goals

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode, with a goal of other things or places."""
        super().reset(observation, goal, seed)
        home, self._own = observation.world.home, self.goal
        others = {each: share for each, share in self._goals(home).items() if _is_other(each, self._own, home)}
        self._turn_at = self.chooser.randint(*TURNS) if others else 0
        if others:
            first = self.chooser.choices(list(others), list(others.values()))[0]
            super().reset(observation, first, seed)

    def act(self, observation: View, legal: Legal) -> Step | None:
        """Return the human-like agent's instruction for the present goal."""
        if self._turn_at and observation.tick >= self._turn_at:
            self._turn_at, opened = 0, self.opened
            super().reset(observation, self._own, self._seed)
            self.opened = opened
        return super().act(observation, legal)


def _is_other(first: Goal, own: Goal, home: Home) -> bool:
    """Return whether a goal shares no predicate with another, and a home has the things to reach it."""
    return not {each for each, _ in first} & {each for each, _ in own} and all(
        _number(each, home) >= wanted for each, wanted in first
    )


def _number(literal: Literal[Name], home: Home) -> int:
    return home.instances(str(literal.subject)).bit_count()


PEOPLE: dict[str, Callable[[GoalsIn], Faulty]] = {
    "changes_mind": lambda goals: Faulty(Faults(change_of_mind=0.1)),
    "changes_goal": ChangesGoal,
    "careless": lambda goals: Faulty(Faults(mistake=0.15, leaving_open=1.0)),
    "distracted": lambda goals: Faulty(Faults(distractor=0.03, detour=0.03)),
    "slow": lambda goals: Slow(),
    "near_sighted": lambda goals: NearSighted(),
}
"""Kinds of main agents that no setting of a helper was tuned with."""
