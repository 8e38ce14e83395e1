"""Helping somebody whose goal is unknown (thesis chapter 7): watch, infer, choose a helping subgoal, act on it."""

from __future__ import annotations

import math
from collections.abc import Iterable

from hearth.agents.belief import Belief, Place, place_of
from hearth.agents.distances import Distances
from hearth.agents.goal_space import Counts, Edge, GoalsIn, GoalSpace
from hearth.agents.posterior import USUAL_MODEL, ActionModel, Posterior
from hearth.agents.regression import Regression
from hearth.schemas.goals import Goal
from hearth.schemas.literals import HANDS, HOLDS, Literal
from hearth.schemas.program import Step
from hearth.schemas.rng import rng
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View
from hearth.simulation.world import rows
from hearth.simulation.world.bits import mask_of
from hearth.simulation.world.states import CLOSED
from hearth.simulation.world.world import World

CROOKED = 1.3
"""How much longer a way is than a straight line."""


MOST_PROPOSED = 100
"""Goals of a posterior that are shown; the others have next to no probability."""


class OnlineHelper:
    """A helper that sees everything and infers what is wanted; `choose` says how it helps.

    While its partner is out of view it waits.

    Attributes:
        posterior: over all goals, by what was seen.
        subgoal: what it is doing; None if it waits.
    """

    def __init__(self, goals: GoalsIn, model: ActionModel = USUAL_MODEL) -> None:
        self._goals = goals
        self._model = model
        self.subgoal: Edge | None = None

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode; a goal that it is given is the only one that there may be (see `agents.protocol`)."""
        world, home = observation.world, observation.world.home
        self.space = GoalSpace.of({goal: 1.0} if goal is not None else self._goals(home), home)
        self.chooser = rng(seed, "helper", observation.agent)
        partner = next(agent for n, agent in enumerate(world.agents) if n != observation.agent)
        self.me, self.partner = home.index[observation.me.node], partner.index
        self.posterior = Posterior(self.space, home, partner.stride, self._model)
        self.distances = Distances(home, observation.me.stride)
        self.belief = Belief(home, mask_of(self.space.things), self.chooser)
        self.first_places = {thing: place_of(world, thing) for thing in self.space.things}
        self.subgoal = None

    def act(self, observation: View, legal: Legal) -> Step | None:
        """The first instruction towards what helps most."""
        self.belief.observe(observation)
        if not observation.others:
            return None
        self.posterior.observe(observation.world, observation.others[0])
        self.subgoal = self.choose(observation)
        if self.subgoal is None:
            return None
        return self._first(Regression(observation, legal, self.belief, self._spare(observation)), self.subgoal)

    @property
    def proposed(self) -> dict[Counts, float]:
        """The goals that it reckons with, with their probabilities."""
        likely = self.posterior.likeliest(MOST_PROPOSED).tolist()
        return {self.space.wanted[goal]: self.posterior.probability(goal) for goal in likely}

    def choose(self, view: View) -> Edge | None:
        """What to help with now; None to wait."""
        raise NotImplementedError

    def _first(self, search: Regression, subgoal: Edge) -> Step | None:
        relation, thing, target = subgoal
        if target < 0:
            return search.first(Literal(HANDS[0], (self.me, thing)))
        return search.first(Literal("ON" if relation == HOLDS else relation, (thing, target)))

    def _spare(self, view: View) -> tuple[int, ...]:
        pursued = -1 if self.subgoal is None else self.subgoal.thing
        return tuple(i for i in rows.held_indices(view.world.agents[view.agent]) if i != pursued)

    def held(self, view: View) -> tuple[int, ...]:
        """What it holds, of the things that goals are about."""
        return tuple(i for i in rows.held_indices(view.world.agents[view.agent]) if i in self.first_places)

    def ticks(self, view: View, stops: Iterable[tuple[int, int]]) -> float:
        """Ticks that it takes to go to some nodes in turn, with those that it needs at each."""
        return self.arrivals(view, stops)[-1]

    def arrivals(self, view: View, stops: Iterable[tuple[int, int]]) -> list[float]:
        """Ticks until each of some stops is done: nodes in turn, with the ticks that it needs there."""
        cell, total, before, found = self.distances.cell(view.me.place), 0.0, -1, []
        for node, actions in stops:
            if node == self.partner:
                metres = self._to_partner(view, before)
            elif node == self.me:
                metres = 0.0
            else:
                metres, cell = self.distances.leg(cell, node)
            total += self.distances.ticks(metres) + actions
            found.append(total)
            before = node
        return found

    def _to_partner(self, view: View, before: int) -> float:
        """Metres to the partner from a node, or, as the crow flies and a little more, from where it is."""
        mine, theirs = view.me.place, view.others[0].place
        if before >= 0 and before != self.me:
            return self.distances.leg(self.distances.cell(theirs), before)[0]
        if mine is None or theirs is None:
            return self.distances.stride
        return CROOKED * math.dist(mine.point, theirs.point)

    def taking(self, place: Place, world: World) -> tuple[int, int]:
        """The stop at which something is taken: where, and the ticks of opening and grabbing."""
        return place.node, 1 + bool(place.relation == "INSIDE" and world.states[CLOSED] >> place.node & 1)

    def putting(self, relation: str, target: int, world: World) -> tuple[int, int]:
        """The stop at which something is put."""
        return target, 1 + bool(relation == "INSIDE" and world.states[CLOSED] >> target & 1)
