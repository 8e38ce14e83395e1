"""A helper that does anything at random (thesis 6.5)."""

from __future__ import annotations

from hearth.schemas.goals import Goal
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.rng import rng
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View
from hearth.simulation.world.bits import indices


class RandomHelper:
    """Draws one of the instructions that are legal, each with equal probability; most of them are walks."""

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode; whatever the goal is."""
        self.chooser = rng(seed, "agent", observation.agent)

    def act(self, observation: View, legal: Legal) -> Step | None:
        """One of the instructions that can be done."""
        number = int(self.chooser.random() * len(legal))
        home = legal.home
        for action in sorted(legal.masks):
            count = legal.count(action)
            if number < count:
                chosen = self._chosen(legal.masks[action])
                return Step(action, tuple(ObjectRef(home.classes[i], 0, home.ids[i]) for i in chosen), legal.agent)
            number -= count
        return None

    def _chosen(self, masks: tuple[int, ...]) -> list[int]:
        """Return a node for each argument, no two the same; drawn until that is so."""
        while True:
            chosen = [self.chooser.choice(list(indices(mask))) for mask in masks]
            if len(set(chosen)) == len(chosen):
                return chosen
