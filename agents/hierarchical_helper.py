"""The hierarchical planner as a helper: the human-like agent's planner with a belief of its own (thesis 6.5, B.2)."""

from __future__ import annotations

from typing import Protocol

from hearth.agents.agent_locations import note_others
from hearth.agents.human_like import Habits, HumanLike
from hearth.agents.subgoals import Missing, Subgoal
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import Pose, View


class Partner(Protocol):
    """A partner whose current subgoal a helper with the true goal may know (thesis B.2)."""

    @property
    def subgoal(self) -> Subgoal | None:
        """Return its current subgoal; None if it has none."""


HELPING = Habits(closes=False, gives=True)
"""Habits of helpers: to close opened things is a habit of people (thesis B.1.1) that helps no agent."""


class Hierarchical(HumanLike):
    """An agent that pursues its goal next to a partner, and leaves the partner's current subgoal to the partner.

    If no other subgoal is left and it sees nothing in the partner's hands, it pursues that subgoal, too.

    Where nothing else is left to be done and, as far as it can see, the partner's hands are empty, it does that, too.
    """

    def __init__(self, partner: Partner | None = None, habits: Habits = HELPING, *, timed: bool = False) -> None:
        """Make a helper.

        Args:
            partner: whose subgoal it leaves alone. The thesis gives a helper with the true goal its partner's plan;
                without one, as with a goal that was inferred or is random, it leaves nothing.
            habits: of planning.
            timed: it leaves to the partner only the things that the partner reaches first, as far as it knows.
        """
        super().__init__(habits)
        self.partner = partner
        self.timed = timed

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode (see `agents.protocol`)."""
        super().reset(observation, goal, seed)
        self._other: Pose | None = None

    def act(self, observation: View, legal: Legal) -> Step | None:
        """Return the first instruction of its plan, now that it has seen where the partner is."""
        self._note_other(observation)
        return super().act(observation, legal)

    def _note_other(self, view: View) -> None:
        """Update the place of the other agent: as last seen; in any other room, if it is no longer there."""
        self._other = view.others[-1] if view.others else self._other
        note_others(self.belief, view, self.chooser)

    def available(self, view: View, open_now: list[Subgoal], missing: Missing) -> list[Subgoal]:
        """Return the subgoals but those of its partner; those too, if there are no others."""
        mine = super().available(view, open_now, missing)
        theirs = self.partner.subgoal if self.partner else None
        if theirs is None or (view.world.agents[view.agent].held and mine is not open_now):
            return mine
        if self.timed and not self._left_to_partner(view, theirs):
            return mine
        rest = [each for each in mine if each.thing != theirs.thing and not self._provided(each, theirs, missing)]
        return rest or ([] if self._other is not None and self._other.holding else mine)

    def _provided(self, mine: Subgoal, theirs: Subgoal, missing: Missing) -> bool:
        """Return whether the partner is doing the last that a part of the goal lacks."""
        return mine.part == theirs.part and missing[mine.part][0] < 2

    def _left_to_partner(self, view: View, theirs: Subgoal) -> bool:
        """Return whether the partner reaches the thing of its subgoal before this agent.

        It does if it has the thing, or if neither the partner's place nor the thing's is known.
        """
        place, other = self.belief.where.get(theirs.thing), self._other
        if place is None or other is None or not self.belief.known >> theirs.thing & 1:
            return True
        if place.node == view.world.home.index[other.node]:
            return True
        mine = self.distances.leg(self.distances.cell(view.me.place), place.node)[0] / view.me.stride
        return self.distances.leg(self.distances.cell(other.place), place.node)[0] / other.stride <= mine
