"""Helping a partner with an unknown goal (thesis chapter 7): watch, infer, choose a helping subgoal, act on it."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import replace

from hearth.agents.belief import Belief, Place
from hearth.agents.goal_posterior import USUAL_MODEL, ActionModel, Posterior
from hearth.agents.goal_space import Counts, Edge, GoalsIn, GoalSpace, Places, Scene
from hearth.agents.partner_plans import Planner
from hearth.agents.protocol import Choice
from hearth.agents.regression_planning import Regression
from hearth.agents.walk_distances import Distances
from hearth.schemas.goals import Goal
from hearth.schemas.literals import HANDS, HOLDS, Literal
from hearth.schemas.program import Step
from hearth.schemas.rng import rng
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import Pose, View
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import mask_of
from hearth.simulation.world.states import CLOSED

CROOKED = 1.3
"""Ratio of the length of a way to the straight line."""


MOST_PROPOSED = 100
"""Goals of a posterior that are shown; the others have next to no probability."""


class OnlineHelper(ABC):
    """A helper that sees everything and infers the partner's goal; `choose` gives its way of helping.

    While its partner is out of view it waits.

    Attributes:
        posterior: over all goals, given the observations.
        other: how its partner stands, as last seen; None before that.
        scene: where things are, as far as it knows.
        first_places: where it saw things first.
        subgoal: its current subgoal; None if it waits.
    """

    def __init__(self, goals: GoalsIn, model: ActionModel = USUAL_MODEL) -> None:
        self._goals = goals
        self._model = model
        self.subgoal: Edge | None = None

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode; a goal that it is given is the only one that there may be (see `agents.protocol`)."""
        home = self.home = observation.world.home
        self.space = GoalSpace.of({goal: 1.0} if goal is not None else self._goals(home), home)
        self.chooser = rng(seed, "helper", observation.agent)
        partner = next(agent for n, agent in enumerate(observation.world.agents) if n != observation.agent)
        self.me, self.partner = home.index[observation.me.node], partner.index
        self.posterior = Posterior(self.space, home, partner.stride, self._model)
        self.distances = Distances(home, observation.me.stride)
        self.belief = Belief(home, mask_of(self.space.things), self.chooser)
        self.first_places: dict[int, Place] = {}
        self.other: Pose | None = None
        self.subgoal = None
        self._puts_down = False

    def act(self, observation: View, legal: Legal) -> Choice:
        """Return the first instruction towards the most helpful edge."""
        if not self.look(observation):
            return None
        self.subgoal = self.choose(observation)
        if self.subgoal is None:
            return None
        return self._first(Regression(observation, legal, self.belief, self._spare(observation)), self.subgoal)

    def look(self, view: View) -> bool:
        """Update the beliefs by an observation; return whether the partner is in view."""
        self.belief.observe(view)
        known, where = self.belief.known, self.belief.where
        for thing in self.space.things:
            if known >> thing & 1:
                self.first_places.setdefault(thing, where[thing])
        self.scene = Scene([self._believed(thing) for thing in self.space.things], self.belief.states[CLOSED])
        if not view.others:
            if self.other is not None:
                self.posterior.observe(self.scene, replace(self.other, last=None))
            return False
        self.other = view.others[0]
        self.posterior.observe(self.scene, self.other)
        return True

    def places(self, view: View) -> Places:
        """Return the places of things: as observed by a helper that sees everything, else as believed."""
        if not self.home.everything & ~view.mask:
            return self.space.places(view.world)
        self.belief.observe(view)
        return [self._believed(thing) for thing in self.space.things]

    def _believed(self, thing: int) -> Place:
        """Return where it believes a thing to be."""
        return self.belief.where[thing]

    @property
    def proposed(self) -> dict[Counts, float]:
        """Return the goals that it reckons with, with their probabilities."""
        likely = self.posterior.likeliest(MOST_PROPOSED).tolist()
        return {self.space.wanted[goal]: self.posterior.probability(goal) for goal in likely}

    @abstractmethod
    def choose(self, view: View) -> Edge | None:
        """Return the edge to help with now; None to wait."""

    def _first(self, search: Regression, subgoal: Edge) -> Step | None:
        relation, thing, target = subgoal
        if (clearing := self._clearing(search, subgoal)) is not None:
            return clearing
        if target < 0:
            return search.first(Literal(HANDS[0], (self.me, thing)))
        return search.first(Literal("ON" if relation == HOLDS else relation, (thing, target)))

    def _clearing(self, search: Regression, subgoal: Edge) -> Step | None:
        """Put a thing down, if both hands are full and the node that it has come to is closed.

        Until then it does not go back to the closed node.
        """
        target = subgoal.target
        shut = subgoal.relation == "INSIDE" and bool(self.scene.closed >> target & 1)
        if not (search.me.right and search.me.left and search.spare and shut):
            self._puts_down = False
        elif search.near(target):
            self._puts_down = True
        return search.first(Literal(HANDS[0], (self.me, search.spare[0]), negated=True)) if self._puts_down else None

    def _spare(self, view: View) -> tuple[int, ...]:
        pursued = -1 if self.subgoal is None else self.subgoal.thing
        return tuple(i for i in edge_rows.held_indices(view.world.agents[view.agent]) if i != pursued)

    def held(self, view: View) -> tuple[int, ...]:
        """Return the things in its hands that goals are about."""
        return tuple(i for i in edge_rows.held_indices(view.world.agents[view.agent]) if i in self.space.number)

    def planner(self) -> Planner:
        """Return a planner of the partner's plans, from its last observed place."""
        assert self.other is not None
        return Planner(self.space, self.scene, self.partner, self.other, self.posterior.distances)

    @property
    def theirs(self) -> int:
        """Return the set of things in its partner's hands that goals are about."""
        return mask_of(thing for thing in self.space.things if self.belief.where[thing] == (HOLDS, self.partner))

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
        mine, theirs = view.me.place, self.other.place if self.other else None
        if before >= 0 and before != self.me:
            return self.distances.leg(self.distances.cell(theirs), before)[0]
        if mine is None or theirs is None:
            return self.distances.stride
        return CROOKED * math.dist(mine.point, theirs.point)

    def taking(self, place: Place) -> tuple[int, int]:
        """Return the stop at which something is taken: where, and the ticks of opening and grabbing."""
        return place.node, 1 + bool(place.relation == "INSIDE" and self.scene.closed >> place.node & 1)

    def putting(self, relation: str, target: int) -> tuple[int, int]:
        """Return the stop at which something is put."""
        return target, 1 + bool(relation == "INSIDE" and self.scene.closed >> target & 1)
