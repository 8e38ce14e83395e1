"""A helper that saves the most of its partner's expected time for each tick of its own, over the exact posterior.

Beyond the thesis: NOPA (eq. 7.1) weighs one edge at a time by a few particles. Here every goal counts with its
probability, what a thing saves is what the partner would have needed for it, both hands are used, and a thing whose
place is still uncertain is taken along until it is known where it is wanted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hearth.agents.goal_space import Edge, Flags, Floats, GoalsIn
from hearth.agents.online import OnlineHelper
from hearth.agents.posterior import FAR, USUAL_MODEL, ActionModel
from hearth.schemas.literals import HOLDS
from hearth.simulation.observation.views import View
from hearth.simulation.world.states import CLOSED

HANDS_OF_ANYBODY = 2

LEAST = 0.05
"""Probability below which it is not worth reckoning."""

BOTH_HANDS = 6
"""Ticks that it takes more to open something with both hands full."""


@dataclass(frozen=True, slots=True)
class Settings:
    """How it helps.

    Attributes:
        take, keep: the least probability that a thing is wanted, to take it and to keep it.
        deliver: the least probability of where it is wanted, given that it is, to bring it there.
        committed: how probable it must be that the partner is at a thing, to leave it alone.
        loyalty: how much better a new subgoal must be than the present one.
        candidates: how many things are looked at closely.
    """

    take: float = 0.35
    keep: float = 0.15
    deliver: float = 0.6
    committed: float = 0.5
    loyalty: float = 1.2
    candidates: int = 8


USUAL = Settings()


@dataclass(frozen=True, slots=True)
class _Stakes:
    """What each thing is worth. P predicates, T things.

    Attributes:
        first, second: (P, T) ticks that the partner is expected to save by a thing where a predicate wants it, and by
            another one after it.
        wanted: (P, T) the probability that it is wanted there.
    """

    first: Floats
    second: Floats
    wanted: Floats

    def any(self, number: int) -> float:
        """The probability that a thing is wanted anywhere."""
        return min(1.0, float(self.wanted[:, number].sum()))


class ExpectedTime(OnlineHelper):
    """Does what saves the most expected ticks in each of its own."""

    def __init__(self, goals: GoalsIn, settings: Settings = USUAL, model: ActionModel = USUAL_MODEL) -> None:
        super().__init__(goals, model)
        self.settings = settings

    def choose(self, view: View) -> Edge | None:
        """The first step of the plan that is worth most in each tick; None to wait."""
        stakes = self._stakes(view)
        held = [self.space.things.index(thing) for thing in self.held(view)]
        plans = {**self._deliveries(view, stakes, held), **self._fetches(view, stakes, held)}
        for number in held:
            if stakes.any(number) < self.settings.keep:
                relation, node = self.first_places[self.space.things[number]]
                plans[Edge(relation, self.space.things[number], node)] = 1e-6
        if not plans:
            return None
        best = max(plans, key=lambda each: (plans[each], each))
        now = self.subgoal
        if now in plans and plans[now] * self.settings.loyalty >= plans[best]:
            return now
        return best

    def _stakes(self, view: View) -> _Stakes:
        """What each thing would save, over all goals."""
        posterior, space = self.posterior, self.space
        lacking = posterior.missing.copy()
        going = posterior.weights @ posterior.pursued
        theirs = int(going.argmax()) if going.max() > self.settings.committed else -1
        if theirs >= 0:
            lacking[:, space.fits[:, theirs]] = np.maximum(0, lacking[:, space.fits[:, theirs]] - 1)
        cost = self._round_trips(view)
        ordered = np.sort(cost, axis=1)
        first, second = np.zeros_like(cost), np.zeros_like(cost)
        wanted = np.zeros_like(cost)
        for number in range(1, int(lacking.max(initial=0)) + 1):
            share = posterior.weights @ (lacking == number)
            nth = ordered[:, min(number, ordered.shape[1]) - 1]
            before = ordered[:, max(0, number - 2)]
            first += share[:, None] * np.minimum(cost, nth[:, None])
            if number > 1:
                second += share[:, None] * np.minimum(cost, before[:, None])
            wanted += share[:, None]
        able = space.fits & (cost < FAR)
        if theirs >= 0:
            overtaking = self._overtaking(view, theirs, able, (posterior.missing > 0) & (lacking == 0))
            first += overtaking
            share = posterior.weights @ ((posterior.missing > 0) & (lacking == 0))
            wanted += np.where(overtaking.sum(axis=0) > 0, share[:, None], 0)
        return _Stakes(np.where(able, first, 0), np.where(able, second, 0), np.where(able, wanted, 0))

    def _overtaking(self, view: View, theirs: int, able: Flags, last: Flags) -> Floats:
        """(P, T) ticks saved where what the partner goes for is the last that is wanted, and the helper is faster."""
        found = np.zeros(able.shape)
        share = self.posterior.weights @ last
        rest = self.posterior.costs(view.world, view.others[0])[:, theirs]
        for row in np.flatnonzero((share > LEAST) & self.space.fits[:, theirs]):
            target = self.putting(self.space.relations[row], int(self.space.targets[row]), view.world)
            for number in np.flatnonzero(able[row]):
                place = self.belief.where[self.space.things[number]]
                if place.relation != HOLDS or place.node == self.me:
                    stops = [target] if place.node == self.me else [self.taking(place, view.world), target]
                    found[row, number] = share[row] * max(0.0, rest[row] - self.ticks(view, stops))
        return found

    def _round_trips(self, view: View) -> Floats:
        """(P, T) ticks in which the partner would fetch a thing from where a predicate wants it; FAR of what it has,
        and of what is where it is wanted.
        """
        world, distances = view.world, self.posterior.distances
        found = np.full(self.space.fits.shape, FAR)
        counted = self.space.counted(self.space.places(world))
        for number, thing in enumerate(self.space.things):
            relation, node = self.belief.where[thing]
            if node == self.partner:
                continue
            if relation == HOLDS:
                relation, node = self.first_places[thing]
            for row in np.flatnonzero(self.space.fits[:, number] & ~counted[:, number]):
                end = distances.end(int(self.space.targets[row]))
                ticks = distances.ticks(distances.leg(end, node)[0])
                shut = relation == "INSIDE" and world.states[CLOSED] >> node & 1
                found[row, number] = 2 * ticks + 2 + shut
        return found

    def _deliveries(self, view: View, stakes: _Stakes, held: list[int]) -> dict[Edge, float]:
        """Bringing what it holds to where it is wanted, or to the partner, with what that is worth a tick."""
        found = {}
        for number in held:
            thing = self.space.things[number]
            if (likely := stakes.any(number)) < self.settings.keep:
                continue
            row = int(stakes.wanted[:, number].argmax())
            relation, target = self.space.relations[row], int(self.space.targets[row])
            ticks = self.ticks(view, [self.putting(relation, target, view.world)])
            if stakes.wanted[row, number] >= self.settings.deliver * likely:
                found[Edge(relation, thing, target)] = float(stakes.first[row, number]) / ticks
            elif not view.others[0].holding:
                ticks = self.ticks(view, [(self.partner, 1)])
                found[Edge(HOLDS, thing, self.partner)] = float(stakes.first[:, number].sum()) / 2 / ticks
        return found

    def _fetches(self, view: View, stakes: _Stakes, held: list[int]) -> dict[Edge, float]:
        """Taking another thing and then bringing all there is in hand, with what that is worth a tick."""
        hands = view.world.agents[view.agent]
        if bool(hands.right) + bool(hands.left) == HANDS_OF_ANYBODY:
            return {}
        found: dict[Edge, float] = {}
        near = self._candidates(view, stakes, held)
        for number, alone in near.items():
            plans = [self._worth(view, stakes, [*held, number], [number])]
            if not held:
                plans += [
                    self._worth(view, stakes, [number, other], [number, other]) for other in near if other != number
                ]
            thing = self.space.things[number]
            found[Edge("", thing)] = max(plans) if alone else 0.0
        return {subgoal: worth for subgoal, worth in found.items() if worth > 0}

    def _candidates(self, view: View, stakes: _Stakes, held: list[int]) -> dict[int, float]:
        """The things most worth taking by themselves."""
        found = {}
        for number, thing in enumerate(self.space.things):
            place = self.belief.where[thing]
            if number in held or place.relation == HOLDS or stakes.any(number) < self.settings.take:
                continue
            if worth := self._worth(view, stakes, [number], [number]):
                found[number] = worth
        best = sorted(found, key=lambda number: (-found[number], number))[: self.settings.candidates]
        return {number: found[number] for number in best}

    def _worth(self, view: View, stakes: _Stakes, carried: list[int], taken: list[int]) -> float:
        """Expected ticks saved in each tick by taking some things and bringing all that are carried where they are
        probably wanted; of two for one predicate, the second counts as such.
        """
        stops = [self.taking(self.belief.where[self.space.things[number]], view.world) for number in taken]
        saved, burden, rows = 0.0, 0, []
        for number in carried:
            row = int(stakes.first[:, number].argmax())
            worth = stakes.second if row in rows else stakes.first
            more = float(worth[:, number].sum())
            if more <= 0:
                return 0.0
            saved += more
            stop = self.putting(self.space.relations[row], int(self.space.targets[row]), view.world)
            stops.append((stop[0], 1) if row in rows else stop)
            rows.append(row)
            burden += BOTH_HANDS * (len(carried) == HANDS_OF_ANYBODY and number == carried[0] and stop[1] > 1)
        return saved / max(1.0, self.ticks(view, stops) + burden)
