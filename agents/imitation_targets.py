"""The planner's choices as a policy would have made them, for learning by imitation."""

from __future__ import annotations

from collections.abc import Sequence

from hearth.agents.hierarchical_helper import HELPING, Hierarchical, Partner
from hearth.agents.learned_helpers import Choice
from hearth.agents.policy_observations import SceneReader
from hearth.agents.subgoals import Missing, Subgoal
from hearth.models.helping.policy_inputs import Words
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View


class ShownChoices(Hierarchical):
    """The hierarchical planner, which records its choices and the inputs that a policy would have had.

    Attributes:
        choices: of subgoals.
        spells: of actions, one list for each time that the kind of subgoal changed, with the part that it was for.
    """

    def __init__(self, words: Words, partner: Partner | None = None) -> None:
        super().__init__(partner, HELPING)
        self.words = words

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode (see `agents.protocol`)."""
        super().reset(observation, goal, seed)
        self.reader = SceneReader(self.words, observation.world.home, self.me, self.aims)
        self.choices: list[Choice] = []
        self.spells: list[tuple[int, list[Choice]]] = []

    def act(self, observation: View, legal: Legal) -> Step | None:
        """Return the planner's instruction."""
        self.reader.note(observation)
        step = super().act(observation, legal)
        if step is not None and self.subgoal is not None and self.subgoal.part in self.reader.pairs:
            moment = self.reader.actions(observation, self.subgoal, legal)
            chosen = self.reader.choice(step, moment)
            if chosen is not None:
                self._spell(self.subgoal.part).append(Choice(observation.tick, moment.scene, chosen))
        return step

    def _spell(self, part: int) -> list[Choice]:
        if not self.spells or self.spells[-1][0] != part:
            self.spells.append((part, []))
        return self.spells[-1][1]

    def choose(self, view: View, subgoals: Sequence[Subgoal], missing: Missing) -> Subgoal | None:
        """Return the planner's subgoal."""
        found = super().choose(view, subgoals, missing)
        pair = self.reader.pairs.get(found.part) if found is not None else None
        if pair is not None:
            self.choices.append(Choice(view.tick, self.reader.subgoals(view, missing).scene, pair))
        return found
