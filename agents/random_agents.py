"""Main agents that act at random: the rows against which all other agents are measured."""

from __future__ import annotations

from hearth.agents.random_helper import RandomHelper
from hearth.schemas.goals import Goal
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.rng import rng
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View
from hearth.simulation.world.bits import indices

PLAYED = "played"
"""The group of the actions of challenges."""


class AdmissibleRandom(RandomHelper):
    """A main agent that draws one of the legal instructions, each with equal probability.

    Attributes:
        subgoal: None; it pursues nothing.
    """

    subgoal: None = None


class Random:
    """A main agent that draws an action and seen things for it, whether or not these can be done.

    It draws among the actions of challenges with equal probability, then among the seen nodes.

    Attributes:
        subgoal: None; it pursues nothing.
    """

    subgoal: None = None

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode, whatever the goal is."""
        self.chooser = rng(seed, "agent", observation.agent)

    def act(self, observation: View, legal: Legal) -> Step | None:
        """Return an instruction, which may be impossible."""
        home = observation.world.home
        action = self.chooser.choice(sorted(home.knowledge.group(PLAYED)))
        seen = list(indices(observation.mask))
        arity = home.knowledge.actions[action].arity
        if len(seen) < arity:
            return None
        chosen = self.chooser.sample(seen, arity)
        return Step(action, tuple(ObjectRef(home.classes[i], 0, home.ids[i]) for i in chosen), observation.agent)
