"""A helper with a partial view: it goes to watch its partner while that is worth more than fetching.

Beyond the thesis, which names partial observation as open (7.6). Watching has a price: the way to the partner's
believed place, and the ticks in which nothing is fetched. A thing that the partner has brought unseen is evidence, too.
"""

from __future__ import annotations

from dataclasses import dataclass

from hearth.agents.agent_locations import note_others
from hearth.agents.belief import Place
from hearth.agents.expected_time_helper import CERTAIN, ExpectedTime, Settings
from hearth.agents.goal_posterior import ActionModel
from hearth.agents.goal_space import Edge, GoalsIn
from hearth.agents.regression_planning import Regression
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal
from hearth.schemas.program import Step
from hearth.schemas.rng import rng
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import Pose, View
from hearth.simulation.world.bits import lowest

NEAR = "CLOSE"
"""The relation of the subgoal that is to be where the partner is."""


@dataclass(frozen=True, slots=True)
class Watching(Settings):
    """Settings of the helper.

    Attributes:
        seeks: it goes to where it sees its partner; if not, it watches only who is in view anyway.
    """

    seeks: bool = True


USUAL = Watching()

SEARCHING = ActionModel(searching=0.1)
"""Model of a partner that does not see everything either."""


class Watchful(ExpectedTime):
    """A helper that acts by its beliefs, and looks for its partner where that is expected to save time."""

    def __init__(self, goals: GoalsIn, settings: Watching = USUAL, model: ActionModel = SEARCHING) -> None:
        super().__init__(goals, settings, model)
        self.watching = settings

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode (see `agents.protocol`)."""
        super().reset(observation, goal, seed)
        self._elsewhere = rng(seed, "whereabouts", observation.agent)
        self._seen_before = True
        node = observation.world.home.ids[self.partner]
        self.other = Pose(1 - observation.agent, node, None, "standing")

    def act(self, observation: View, legal: Legal) -> Step | None:
        """Return the first instruction towards the most helpful edge, which may be to see more."""
        places = dict(zip(self.space.things, self.posterior.places, strict=False))
        before = {thing: place for thing, place in places.items() if self.belief.known >> thing & 1}
        seen = self.look(observation)
        note_others(self.belief, observation, self._elsewhere)
        if not (seen and self._seen_before):
            self._notice(before)
        self._seen_before = seen
        unmet = self.other is None or self.other.place is None
        certain = float(self.posterior.weights.max()) >= CERTAIN
        self.subgoal = self._seeking() if unmet and not certain else self.choose(observation)
        if self.subgoal is None:
            return None
        search = Regression(observation, legal, self.belief, self._spare(observation))
        if self.subgoal.relation == NEAR:
            return search.first(Literal(NEAR, (self.me, self.partner)))
        return self._first(search, self.subgoal)

    def _notice(self, before: dict[int, Place]) -> None:
        """Weigh the goals by the things that the partner brought while it was out of view.

        Args:
            before: where things were that it had seen.
        """
        space = self.space
        for thing, place in zip(space.things, self.scene.places, strict=True):
            if place == before.get(thing, place) or before[thing].node == self.me:
                continue
            for row in space.rows_of[space.number[thing]]:
                if space.counts_at(row, *place):
                    self.posterior.notice(row)

    def _waiting(self, view: View) -> tuple[float, Edge | None]:
        """Return the expected ticks as for a helper that sees its partner, or, after the way there, once it does."""
        if view.others or self._forecasts[0][0] >= CERTAIN:
            return super()._waiting(view)
        return self._expected((), self.settings.patience + self._away(view)), self._seeking()

    def _seeking(self) -> Edge | None:
        return Edge(NEAR, self.partner, self.me) if self.watching.seeks else None

    def _away(self, view: View) -> float:
        """Ticks of the way to where the partner is believed to be."""
        room = self.belief.where[self.partner].node
        metres, _ = self.distances.leg(self.distances.cell(view.me.place), room)
        return self.distances.ticks(metres)

    def _believed(self, thing: int) -> Place:
        """Return the believed place of a thing; an unseen thing is not yet at a place that a goal wants."""
        place = super()._believed(thing)
        if self.belief.known >> thing & 1:
            return place
        rows = self.space.rows_of[self.space.number[thing]]
        if not any(self.space.counts_at(row, *place) for row in rows):
            return place
        home = self.home
        return Place("INSIDE", lowest(home.inside[place.node] & home.rooms))
