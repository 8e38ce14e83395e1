"""A human-like agent with faults: less than rational, forgetful, untidy, mistaken, changing its mind, distracted.

The caller gives the rates, and with them the purpose: `human_population` has people to be helped. Demonstrations have
errands of their own, which depend on a challenge's goals (`challenges/demonstrator.py`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

from hearth.agents.distractions import Errand
from hearth.agents.human_like import PLAIN, Habits, HumanLike
from hearth.agents.regression_planning import Regression
from hearth.agents.subgoals import Missing, Subgoal
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal, Name
from hearth.schemas.program import Step
from hearth.schemas.rng import derive
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View
from hearth.simulation.world.bits import indices
from hearth.simulation.world.states import CLOSED

MOST_TICKS = 20
"""Ticks after which an agent gives up an errand."""

ERRANDS = replace(PLAIN, closes=False)
"""Habits during an errand: the agent leaves open the things that it opens."""


@dataclass(frozen=True, slots=True)
class Faults:
    """Rates of faults; the defaults are none.

    Attributes:
        rationality: how strictly it prefers the faster of two subgoals, per tick: with probabilities in proportion to
            exp(rationality * value); infinite if it always takes the best, 0 if any is as good.
        forgetting: probability, each tick, that it forgets where a thing that is out of view was seen.
        leaving_open: probability that it leaves something open that it would close.
        mistake: probability, as it puts something down, that it does so at a wrong place.
        change_of_mind: probability, each tick, that it turns to another subgoal.
        detour: probability, each tick, that it goes and opens something else first.
        distractor: probability, each tick, that it puts something that is not wanted somewhere first.
    """

    rationality: float = math.inf
    forgetting: float = 0.0
    leaving_open: float = 0.0
    mistake: float = 0.0
    change_of_mind: float = 0.0
    detour: float = 0.0
    distractor: float = 0.0

    def __post_init__(self) -> None:
        """Check the rates.

        Raises:
            HearthError: BAD_ARGUMENT: a rate is not a probability, or the rationality is negative.
        """
        for field in fields(self):
            value = getattr(self, field.name)
            most = math.inf if field.name == "rationality" else 1.0
            if not 0 <= value <= most:
                raise HearthError.of(Code.BAD_ARGUMENT, f"{field.name} is {value}, not from 0 to {most:g}")


class Faulty(HumanLike):
    """The human-like agent with faults; without faults, it acts as the human-like agent."""

    def __init__(self, faults: Faults, habits: Habits = PLAIN) -> None:
        super().__init__(habits)
        self.faults = faults

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode (see `agents.protocol`)."""
        super().reset(observation, goal, seed)
        self._errand: Errand | None = None
        self._seed = seed

    def act(self, observation: View, legal: Legal) -> Step | None:
        """Return the first instruction of its plan, or the instruction that a fault puts in its place."""
        self._forget(observation)
        if self._happens(self.faults.change_of_mind):
            self._turn()
        step = super().act(observation, legal)
        if self._errand is None and (wanted := self._tempted(observation, step)) is not None:
            seed = derive(self._seed, "errand", observation.tick)
            self._errand = Errand(wanted, observation, MOST_TICKS, seed, ERRANDS)
        instead = self._errand.act(observation, legal) if self._errand else None
        if instead is None:
            self._errand = None
        return instead or step

    def choose(self, view: View, subgoals: Sequence[Subgoal], missing: Missing) -> Subgoal | None:
        """One of some subgoals: the better, the more probable."""
        if len(subgoals) < 2 or math.isinf(self.faults.rationality):
            return super().choose(view, subgoals, missing)
        values = self.search(view, subgoals, missing).values
        best = max(values.values())
        weights = [math.exp(self.faults.rationality * (value - best)) for value in values.values()]
        return subgoals[self.chooser.choices(list(values), weights)[0]]

    def _happens(self, probability: float) -> bool:
        """Return whether an event of some probability happens now; probability 0 draws no random number."""
        return probability > 0 and self.chooser.random() < probability

    def _forget(self, view: View) -> None:
        for thing in indices(self.belief.known & ~view.mask):
            if self._happens(self.faults.forgetting):
                self.belief.forget(thing)

    def _turn(self) -> None:
        """Leave the subgoal for another, if there is one."""
        if self.subgoal is not None:
            self._blocked.add(self.subgoal)
            self.subgoal = None

    def _tempted(self, view: View, step: Step | None) -> Literal[Name] | None:
        """Return the literal, by ids, that it makes true instead of an instruction; None if it goes on."""
        home = view.world.home
        me = view.world.agents[view.agent]
        places = list(indices(home.properties["SURFACES"] & home.furniture & view.mask))
        if step is not None and step.action in home.knowledge.group("puts") and self._happens(self.faults.mistake):
            wrong = [home.ids[i] for i in places if home.ids[i] != step.objects[1].node]
            return Literal.of("ON", step.objects[0].node or 0, self.chooser.choice(wrong)) if wrong else None
        if me.held:
            return None
        if self._happens(self.faults.detour):
            closed = list(indices(view.world.states[CLOSED] & home.able("Open") & home.furniture & view.mask))
            return Literal.of("OPEN", home.ids[self.chooser.choice(closed)]) if closed else None
        if self._happens(self.faults.distractor):
            things = list(indices(home.properties["GRABBABLE"] & view.mask & ~self.aims.things & ~home.characters))
            if things and places:
                thing, place = self.chooser.choice(things), self.chooser.choice(places)
                return Literal.of("ON", home.ids[thing], home.ids[place])
        return None

    def _closing(self, search: Regression, step: Step | None, open_now: Sequence[Subgoal], needed: int) -> Step | None:
        closing = super()._closing(search, step, open_now, needed)
        if closing is not None and self._happens(self.faults.leaving_open):
            self.opened &= ~(1 << search.home.index[closing.objects[0].node or 0])
            return None
        return closing
