"""Talking for the price of a tick: the main agent says its remaining goal; a helper asks where that saves time.

Beyond the thesis. A question takes the helper's tick. The answer takes one of its partner's, and names one part of the
partner's goal. Challenges allow talking by `messages`.
"""

from __future__ import annotations

from dataclasses import dataclass

from hearth.agents.expected_time_helper import CERTAIN, PARTNER, ExpectedTime, Settings
from hearth.agents.goal_posterior import ActionModel
from hearth.agents.goal_space import GoalsIn
from hearth.agents.human_like import HumanLike
from hearth.agents.protocol import Choice
from hearth.agents.subgoals import Subgoal, Wanted
from hearth.schemas.agent_messages import Message
from hearth.schemas.goals import Goal
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View

QUIET = 3
"""Ticks without an answer after which nobody is asked any more."""


class Answering:
    """The human-like agent, which, when asked, names a part of its goal that it has not named yet."""

    def __init__(self, main: HumanLike | None = None) -> None:
        self.main = main or HumanLike()

    @property
    def subgoal(self) -> Subgoal | None:
        """Return its current subgoal."""
        return self.main.subgoal

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode (see `agents.protocol`)."""
        self.main.reset(observation, goal, seed)
        self._named: set[int] = set()

    def act(self, observation: View, legal: Legal) -> Choice:
        """Return an answer, if it was asked and can answer; otherwise its usual choice."""
        if any(message.wanted is None for _, message in observation.messages):
            answer = self._answer(observation)
            if answer is not None:
                return answer
        return self.main.act(observation, legal)

    def _answer(self, view: View) -> Message | None:
        """Return the part of which most is missing, apart from its current one."""
        main = self.main
        main.belief.observe(view)
        missing = {part: number for part, (number, _) in main.aims.missing(main.belief, view).items()}
        parts = {each.part: each for each in main.aims.wanted if _is_of_things(each)}
        open_now = [part for part in parts if part in missing and part not in self._named]
        if not open_now:
            return None
        mine = -1 if main.subgoal is None else main.subgoal.part
        chosen = max(open_now, key=lambda part: (missing[part] - (part == mine), -part))
        self._named.add(chosen)
        return Message(parts[chosen].literal, missing[chosen])


def _is_of_things(wanted: Wanted) -> bool:
    literal = wanted.literal
    return not wanted.last and isinstance(literal.subject, str) and isinstance(literal.target, int)


@dataclass(frozen=True, slots=True)
class Talk(Settings):
    """Settings of the helper.

    Attributes:
        asking: ticks after which it would know the goal, if it asks.
        delay: ticks that a question costs its partner.
    """

    asking: float = 3.0
    delay: float = 1.0


USUAL = Talk()


class Asking(ExpectedTime):
    """A helper that shortens its partner's expected time, and asks where an answer is worth more than its price."""

    def __init__(self, goals: GoalsIn, settings: Talk = USUAL, model: ActionModel = PARTNER) -> None:
        super().__init__(goals, settings, model)
        self.talk = settings

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode (see `agents.protocol`)."""
        super().reset(observation, goal, seed)
        self._asked: int | None = None
        self._silent = False
        self._forecasts = []

    def act(self, observation: View, legal: Legal) -> Choice:
        """Return a question, or the first instruction towards the most helpful edge."""
        self._hear(observation)
        step = super().act(observation, legal)
        if self._asked is None and not self._silent and self._is_worth_it():
            self._asked = observation.tick
            return Message()
        return step

    def _is_worth_it(self) -> bool:
        """Return whether to know the goal soon is better than the best plan without."""
        if not self._forecasts or self._forecasts[0][0] >= CERTAIN:
            return False
        return self._expected((), self.talk.asking) + self.talk.delay < self.value

    def _hear(self, view: View) -> None:
        """Record an answer; a partner that does not answer is not asked again."""
        for _, message in view.messages:
            if message.wanted in self.space.predicates and self.posterior.places:
                self.posterior.answered(self.space.predicates.index(message.wanted), message.count)
                self._asked = None
        if self._asked is not None and view.tick - self._asked > QUIET:
            self._silent = True
