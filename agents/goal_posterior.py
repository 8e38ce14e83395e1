"""The exact posterior over all goals that an agent may have, by the likelihood of each observed action.

A model of the one who acts says how probable an action is under a goal: it goes for one of the things that the goal
still lacks, a near one rather than a far one, takes it, and carries it to where the goal wants it. Chapter 7
approximates this by particles; 661 goals can be reckoned with one by one.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from hearth.agents.goal_space import Flags, Floats, GoalSpace, Numbers, Places, Scene
from hearth.agents.walk_distances import Distances
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Failure
from hearth.schemas.literals import HANDS, HOLDS
from hearth.schemas.program import Step
from hearth.simulation.observation.views import Pose
from hearth.simulation.world.home import Home
from hearth.simulation.world.pose import Pose as Place

MOST = 1_000
"""Things of a predicate that goals want, at most."""

FAR = 1e6
"""Ticks to a place that can't be reached."""


@dataclass(frozen=True, slots=True)
class ActionModel:
    """A model of an agent's choices.

    Attributes:
        rationality: how much less probable a thing becomes with each tick that it is farther.
        slip: probability of an action that the model does not explain.
        searching: how probably it looks for a thing in a place where the thing is not, since it does not see all.
        rest: how probably it does nothing though there is something to fetch.
    """

    rationality: float = 0.3
    slip: float = 0.02
    searching: float = 0.0
    rest: float = 0.2


USUAL_MODEL = ActionModel()


class _Lacking(NamedTuple):
    """The missing predicates of goals, as long as the same things count.

    Attributes:
        missing: (G, P) the count that each goal lacks.
        possible: (G,) 1 where it lacks something, and there are as many things as it lacks.
        able: (P, T) whether a thing fits a predicate and does not count for it yet.
        row, number: of each pair of a predicate and how many are missing, which many goals share.
        goals: those that lack something.
        pairs: (K, goals) the pairs of each, filled up with one more than there are.
    """

    missing: Numbers
    possible: Floats
    able: Flags
    row: Numbers
    number: Numbers
    goals: Numbers
    pairs: Numbers

    @classmethod
    def of(cls, space: GoalSpace, counted: Flags) -> _Lacking:
        """Return the missing predicates of a space's goals, given the things that count."""
        missing, able = space.missing(counted), space.fits & ~counted
        possible = missing.any(axis=1) & (missing <= able.sum(axis=1)).all(axis=1)
        goals, rows = np.nonzero(missing)
        needed, which = np.unique(rows * MOST + missing[goals, rows], return_inverse=True)
        row, number = np.divmod(needed, MOST)
        some, begins, lengths = np.unique(goals, return_index=True, return_counts=True)
        pairs = np.full((lengths.max(initial=0), len(some)), len(needed))
        pairs[np.arange(len(goals)) - np.repeat(begins, lengths), np.repeat(np.arange(len(some)), lengths)] = which
        return cls(missing, possible.astype(np.float64), able, row, number, some, pairs)


class Posterior:
    """Probabilities of all goals of a space, updated by every action that is seen.

    Attributes:
        space: the goals.
        weights: (G,) their probabilities now.
        missing: (G, P) the count that each goal lacks now.
        pursued: (G, T) under each goal, the probability that the agent fetches or carries a thing.
    """

    def __init__(self, space: GoalSpace, home: Home, stride: float, model: ActionModel = USUAL_MODEL) -> None:
        self.space = space
        self.model = model
        self.weights: Floats = space.prior
        self.distances = Distances(home, stride)
        self._known = home.knowledge
        self._trips: dict[tuple[int, int], int] = {}
        self._home = home
        self._last: tuple[Step, Failure | None] | None = None
        self._stood: tuple[tuple[Step, Failure | None] | None, Place | None] = (None, None)
        self.places: Places = []
        self._counted: Flags = np.zeros((0, 0), np.bool_)

    def observe(self, scene: Scene, other: Pose) -> None:
        """Update the posterior by an agent's last attempt, and by the home since then.

        Args:
            scene: now.
            other: the pose of that agent, with its last attempt.
        """
        last = None if other.last is None else (other.last.instruction, other.last.failure)
        stood, self._stood = self._stood, (last, other.place)
        if self.places and last is not None:
            if stood == self._stood and last[1] is None:
                self._rest()
            elif last != self._last:
                self._weigh(last[0])
        self._last = last
        places = scene.places
        if places != self.places:
            self.places = places
            counted = self.space.counted(places)
            if not np.array_equal(counted, self._counted):
                self._counted, self._lacking = counted, _Lacking.of(self.space, counted)
                self.missing = self._lacking.missing
            self._keep(self._lacking.possible)
            self._expect(scene, other)
            self._last = None

    def _expect(self, scene: Scene, other: Pose) -> None:
        """Compute the thing that is fetched or carried next under each goal.

        An agent that must fetch all of some things saves most by beginning with things that are near now, but far from
        their target. The score is the cost from here less the cost from the target, or less that of the dearest thing
        that is needed otherwise.
        """
        lacking, me = self._lacking, self._home.index[other.node]
        row, number = lacking.row, lacking.number
        self._held = np.array([place == (HOLDS, me) for place in self.places])
        cost = self.costs(scene.closed, other)
        able = lacking.able & (cost < FAR)
        trips = np.where(self._held, cost, self.round_trips(scene.closed))
        ordered = np.sort(np.where(able, trips, FAR), axis=1)
        last = able.sum(axis=1) - 1
        dearest = ordered[row, np.clip(last[row], 0, number - 1)]
        order = np.where(able[row], cost[row] - np.minimum(trips[row], dearest[:, None]), np.inf)
        least = float(order.min(initial=np.inf))
        near = np.exp(-self.model.rationality * (order - (least if np.isfinite(least) else 0.0)))
        found = np.zeros((len(self.space.goals), len(self.space.things)))
        found[lacking.goals] = np.vstack((near, np.zeros_like(near[:1]))).take(lacking.pairs, axis=0).sum(axis=0)
        carried = found * self._held
        found = np.where(carried.any(axis=1, keepdims=True), carried, found)
        total = found.sum(axis=1, keepdims=True)
        self.pursued = np.divide(found, total, out=np.zeros_like(found), where=total > 0)

    def costs(self, closed: int, other: Pose) -> Floats:
        """Return (P, T) ticks until a thing counts for a predicate, if it is brought there next; FAR if it can't be."""
        start = self.distances.cell(other.place)
        me = self._home.index[other.node]
        found = np.full(self.space.fits.shape, FAR)
        for number, (relation, node) in enumerate(self.places):
            if relation == HOLDS and node != me:
                continue
            fetched, cell = 0.0, start
            if relation != HOLDS:
                metres, cell = self.distances.leg(start, node)
                fetched = self.distances.ticks(metres) + 1 + (relation == "INSIDE" and closed >> node & 1)
            for row in self.space.rows_of[number]:
                target = int(self.space.targets[row])
                carried = self.distances.ticks(self.distances.leg(cell, target)[0])
                shut = self.space.relations[row] == "INSIDE" and closed >> target & 1
                found[row, number] = fetched + carried + 1 + shut
        return found

    def round_trips(self, closed: int) -> Floats:
        """Return (P, T) ticks to fetch a thing from a predicate's target; FAR if a character holds the thing."""
        distances = self.distances
        found = np.full(self.space.fits.shape, FAR)
        for number, (relation, node) in enumerate(self.places):
            if relation == HOLDS:
                continue
            shut = relation == "INSIDE" and closed >> node & 1
            for row in self.space.rows_of[number]:
                target = int(self.space.targets[row])
                if (node, target) not in self._trips:
                    metres, cell = distances.leg(distances.end(target), node)
                    back = distances.leg(cell, target)[0]
                    self._trips[node, target] = distances.ticks(metres) + distances.ticks(back) + 2
                found[row, number] = self._trips[node, target] + shut
        return found

    def _weigh(self, step: Step) -> None:
        """Weigh the goals by an action, and update the possible pursuits under each goal."""
        match = self._matching(step)
        if match is None:
            return
        explained = (self.pursued * match).sum(axis=1)
        slip = self.model.slip
        self._keep((1 - slip) * explained + slip / max(1, len(self.space.things)))
        joint = self.pursued * match
        total = explained[:, None]
        self.pursued = np.where(total > 0, joint / np.where(total > 0, total, 1.0), self.pursued)

    def notice(self, row: int) -> None:
        """Weigh the goals by a thing that the agent has brought, unseen, to the target of a predicate."""
        slip = self.model.slip
        self._keep((1 - slip) * (self.space.counts[:, row] > 0) + slip)

    def answered(self, row: int, count: int) -> None:
        """Weigh the goals by an answer: a predicate that is still wanted, and how many are missing."""
        slip, lacking = self.model.slip, np.maximum(1, (self.missing > 0).sum(axis=1))
        self._keep((1 - slip) * (self.missing[:, row] == count) / lacking + slip * slip)

    def _rest(self) -> None:
        """Weigh the goals by a tick without action: an agent with nothing to fetch waits for the things of others."""
        self._keep(np.where(self.pursued.any(axis=1), self.model.rest, 1.0))

    def _keep(self, likelihood: Floats) -> None:
        weights = self.weights * likelihood
        total = weights.sum()
        if total > 0:
            self.weights = weights / total

    def _matching(self, step: Step) -> Floats | None:
        """Return (G, T) whether an action is one towards a thing, under a goal.

        The result is None for an action that says nothing about a goal.
        """
        nodes = [self._home.index[ref.node] for ref in step.objects if ref.node in self._home.index]
        known, name = self._known, step.action
        if not nodes or known.state_of(name) == "CLOSED":
            return None
        if name in known.group("goes"):
            return self._towards(nodes[0], rooms=True)
        if known.state_of(name) == "OPEN":
            return self._towards(nodes[0], rooms=False)
        if name in _taking(known):
            taken = np.array([thing == nodes[0] for thing in self.space.things], np.float64)
            return np.broadcast_to(taken, self.pursued.shape)
        if name in known.group("puts") and len(nodes) > 1 and nodes[0] in self.space.number:
            put = np.array([thing == nodes[0] for thing in self.space.things], np.float64)
            return self._wanted_at(nodes[1]) * put
        return None

    def _towards(self, node: int, rooms: bool) -> Floats:
        """Walks and openings: towards a thing or its place, and with a thing in hand to where it is wanted."""
        of_room = rooms and bool(self._home.rooms >> node & 1)
        fetched = np.array(
            [
                node in (thing, place) or (of_room and bool(self._home.inside[place] >> node & 1))
                for thing, (_, place) in zip(self.space.things, self.places, strict=True)
            ],
            np.float64,
        )
        fetched = np.maximum(fetched, self.model.searching)
        carried = self._wanted_at(node, of_room) if self._held.any() else np.zeros((1, 1))
        if of_room:
            carried = np.maximum(carried, self.model.searching)
        found: Floats = np.where(self._held, carried, fetched)
        return found

    def _wanted_at(self, node: int, of_room: bool = False) -> Floats:
        """Return (G, T) whether a goal lacks a thing on or in some furniture, or in a room."""
        inside, targets = self._home.inside, self.space.targets
        here = np.array([node == each or (of_room and bool(inside[each] >> node & 1)) for each in targets.tolist()])
        lacking = (self.missing > 0) * here.astype(np.float64)
        found: Floats = (lacking @ self.space.fits.astype(np.float64) > 0).astype(np.float64)
        return found

    @property
    def expected(self) -> Floats:
        """Return (P,) the probability that each predicate is still wanted at least once more."""
        return self.weights @ (self.missing > 0)

    def probability(self, number: int) -> float:
        """Return the probability of a goal by its number."""
        return float(self.weights[number])

    def likeliest(self, number: int) -> Numbers:
        """Return the numbers of the likeliest goals, the likeliest first."""
        return np.argsort(-self.weights, kind="stable")[:number]


@lru_cache(maxsize=8)
def _taking(knowledge: Knowledge) -> frozenset[str]:
    """Return the actions by which one gets something into a hand."""
    return frozenset(
        action.name
        for action in knowledge.actions.values()
        for effect in action.effects
        if effect.literal.name in HANDS and not effect.literal.negated
    )
