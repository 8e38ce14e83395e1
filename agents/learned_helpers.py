"""Helpers that have learnt: Hybrid chooses subgoals by a policy and plans for them, HRL acts by a policy, too (B.3)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from hearth.agents.agent_locations import note_others
from hearth.agents.hierarchical_helper import HELPING
from hearth.agents.human_like import HumanLike
from hearth.agents.policy_observations import SceneReader
from hearth.agents.subgoals import Missing, Subgoal
from hearth.models.helping.policy_inputs import Pair, Scene
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View

if TYPE_CHECKING:
    from hearth.models.helping.policies import TrainedPolicy

PATIENCE = 40
"""Ticks after which HRL chooses a subgoal anew."""


@dataclass(frozen=True, slots=True)
class Choice:
    """A choice to learn from: the tick, the policy's input, and the choice."""

    tick: int
    scene: Scene
    chosen: Pair


class Hybrid(HumanLike):
    """A policy chooses the class of things and the place of the next subgoal; regression does the rest.

    Of the things of the class it takes one that it holds, else the one that costs least by belief; the thesis takes
    any. If no part of the policy's choice is missing by belief, it waits for a tick and asks again.

    Attributes:
        choices: of subgoals, since the episode began.
    """

    def __init__(self, policy: str | TrainedPolicy = "helping-subgoals") -> None:
        super().__init__(HELPING)
        self._policy = policy

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode (see `agents.protocol`).

        Raises:
            HearthError: MISSING_FILE: there is no such policy, or the extra `models` is not installed.
        """
        super().reset(observation, goal, seed)
        self.policy = _restored(self._policy, "subgoals")
        self.reader = SceneReader(self.policy.words, observation.world.home, self.me, self.aims)
        self.choices: list[Choice] = []
        self._state: Any = None

    def act(self, observation: View, legal: Legal) -> Step | None:
        """Return the first instruction of the plan for its subgoal."""
        self.reader.note(observation)
        note_others(self.belief, observation, self.chooser)
        return super().act(observation, legal)

    def available(self, view: View, open_now: list[Subgoal], missing: Missing) -> list[Subgoal]:
        """Return all subgoals: the policy chooses."""
        return open_now

    def choose(self, view: View, subgoals: Sequence[Subgoal], missing: Missing) -> Subgoal | None:
        """Return a subgoal that the policy chose; None if no such subgoal is missing."""
        if not subgoals:
            return None
        scene = self.reader.subgoals(view, missing).scene
        pair, self._state = self.policy.choose(scene, self._state, self.chooser)
        self.choices.append(Choice(view.tick, scene, pair))
        fitting = [each for each in subgoals if self.reader.pairs.get(each.part) == pair]
        cell, held = self.distances.cell(view.me.place), view.world.agents[view.agent].held
        return min(fitting, key=lambda each: (not held >> each.thing & 1, self.cost(cell, each)[0]), default=None)


class Learned(Hybrid):
    """HRL: a second policy chooses the actions for a subgoal, one by one.

    Attributes:
        actions: its choices since the episode began.
    """

    def __init__(
        self, policy: str | TrainedPolicy = "helping-subgoals", low: str | TrainedPolicy = "helping-actions"
    ) -> None:
        super().__init__(policy)
        self._low_policy = low

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode; errors as of `Hybrid.reset`."""
        super().reset(observation, goal, seed)
        self.low = _restored(self._low_policy, "actions")
        self.actions: list[Choice] = []
        self._low_state: Any = None
        self._since = 0

    def act(self, observation: View, legal: Legal) -> Step | None:
        """Return the second policy's action for the subgoal."""
        self.reader.note(observation)
        note_others(self.belief, observation, self.chooser)
        self.belief.observe(observation)
        missing = self.aims.missing(self.belief, observation)
        open_now = self.aims.open(self.belief, missing)
        before = self.subgoal
        if observation.tick - self._since > PATIENCE:
            self.subgoal = None
        if self.subgoal is None or not self._still(open_now):
            self.subgoal = self.choose(observation, open_now, missing)
        if self.subgoal is None:
            return None
        if before is None or self.subgoal.part != before.part:
            self._low_state, self._since = None, observation.tick
        return self._acted(observation, legal, self.subgoal)

    def _still(self, open_now: Sequence[Subgoal]) -> bool:
        """Return whether its kind of subgoal is missing still; which thing it is for, the second policy decides."""
        return self.subgoal is not None and any(each.part == self.subgoal.part for each in open_now)

    def _acted(self, view: View, legal: Legal, subgoal: Subgoal) -> Step | None:
        moment = self.reader.actions(view, subgoal, legal)
        if not any(map(any, moment.scene.legal)):
            return None
        chosen, self._low_state = self.low.choose(moment.scene, self._low_state, self.chooser)
        self.actions.append(Choice(view.tick, moment.scene, chosen))
        return self.reader.step(view, subgoal, legal, moment, chosen)


def _restored(policy: str | TrainedPolicy, chooses: str) -> TrainedPolicy:
    if not isinstance(policy, str):
        return policy
    from hearth.models.helping.policies import restored

    return restored(policy, chooses)
