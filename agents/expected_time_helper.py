"""A helper that minimizes the expected time until its partner has finished, over the exact posterior.

Beyond the thesis: NOPA (eq. 7.1) weighs one edge at a time by a few particles. This helper simulates each possible next
thing, under goals that represent the posterior, until the goal is reached (see `completion_forecast`). It uses both
hands and shares the work. A thing that is useless under some goals costs the time that it wastes. With the single true
goal it is the planner of HP_GT.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from hearth.agents.completion_forecast import GIVE, HANDS, TAKE, Forecast, Stop
from hearth.agents.goal_posterior import ActionModel
from hearth.agents.goal_space import Edge, GoalsIn
from hearth.agents.interchangeable_objects import HELPER, Situation
from hearth.agents.online_helper import OnlineHelper
from hearth.schemas.literals import HOLDS
from hearth.simulation.observation.views import View

CERTAIN = 0.999
"""Probability from which on a goal is taken for granted."""


@dataclass(frozen=True, slots=True)
class Settings:
    """Settings of the helper.

    Attributes:
        goals: how many stand for the posterior.
        patience: ticks of waiting that a plan must beat, as if the goal would be known after them.
        take, keep: the least probability that a thing is wanted, to take it and to keep it.
        needless: ticks that a thing costs which turns out not to be wanted, or not where it is put.
        loyalty: ticks by which a new subgoal must be better than the present one.
        nearest, paired: how many heaps are looked at for a single thing, and for two at once.
        sure: the least probability under a goal of a thing that the partner goes for.
    """

    goals: int = 10
    patience: float = 6.0
    take: float = 0.3
    keep: float = 0.15
    needless: float = 2.0
    loyalty: float = 0.4
    nearest: int = 6
    paired: int = 4
    sure: float = 0.5


USUAL = Settings()

PARTNER = ActionModel(rationality=0.45)
"""The helper's model of its partner's choices."""


class ExpectedTime(OnlineHelper):
    """A helper that chooses the action with the shortest expected time until its partner has finished.

    Attributes:
        value: the expected ticks until the partner has finished, given its last choice.
    """

    def __init__(self, goals: GoalsIn, settings: Settings = USUAL, model: ActionModel = PARTNER) -> None:
        super().__init__(goals, model)
        self.settings = settings
        self.value = math.inf

    def choose(self, view: View) -> Edge | None:
        """Return the first step of the best plan; None to wait."""
        self._look(view)
        if not self._forecasts:
            return self._back(view)
        best, chosen = self._waiting(view)
        for stops in self._plans(view):
            edge = self._edge(stops[0])
            value = self._expected(stops) - self.settings.loyalty * (edge == self.subgoal)
            if value < best:
                best, chosen = value, edge
        self.value = best
        return chosen or self._back(view)

    def _waiting(self, view: View) -> tuple[float, Edge | None]:
        """Return the expected ticks if it only watches at first, and the edge for that."""
        if self._forecasts[0][0] >= CERTAIN:
            return math.inf, None
        return self._expected((), self.settings.patience), None

    def _look(self, view: View) -> None:
        """Compute the situation, the goals that stand for all, and how probably each heap's things are wanted."""
        posterior, space, other = self.posterior, self.space, self.other
        assert other is not None
        giving = self.ticks(view, [(self.partner, 1)])
        ways = (posterior.distances, self.distances)
        self._now = Situation(space, self.scene, (self.partner, self.me), (other, view.me), ways, giving)
        self._forecasts = []
        for goal, share in self._representatives():
            lacking = {row: number for row, number in enumerate(posterior.missing[goal].tolist()) if number}
            pursued = int(posterior.pursued[goal].argmax())
            sure = posterior.pursued[goal, pursued] > self.settings.sure
            if lacking:
                self._forecasts.append((share, Forecast(self._now, lacking, pursued if sure else -1)))
        missing = posterior.missing > 0
        known: dict[tuple[int, ...], float] = {}
        for heap in self._now.heaps:
            if heap.rows not in known:
                known[heap.rows] = float(posterior.weights @ missing[:, list(heap.rows)].any(axis=1))
        self._wanted = [known[heap.rows] for heap in self._now.heaps]
        self._rows = posterior.expected

    def _representatives(self) -> list[tuple[int, float]]:
        """Goals at equal steps of the cumulated posterior, with their shares, the likeliest first."""
        weights, number = self.posterior.weights, self.settings.goals
        order = np.argsort(-weights, kind="stable")
        total = np.cumsum(weights[order])
        steps = (np.arange(number) + 0.5) / number * total[-1]
        chosen, counts = np.unique(np.searchsorted(total, steps).clip(0, len(order) - 1), return_counts=True)
        return [(int(order[each]), int(count) / number) for each, count in zip(chosen, counts, strict=True)]

    def _plans(self, view: View) -> Iterator[Sequence[Stop]]:
        """Yield its possible next stops: bring or hand over the things in its hands, take one thing, or two."""
        heaps, settings = self._now.heaps, self.settings
        held = [number for number, heap in enumerate(heaps) if heap.holder == HELPER for _ in heap.things]
        for number in dict.fromkeys(held):
            if self._wanted[number] >= settings.keep:
                likely = [row for row in heaps[number].rows if self._rows[row] > settings.keep]
                yield from ((Stop(number, row),) for row in likely)
                if len(likely) > 1 and not (self.other and self.other.holding):
                    yield (Stop(number, GIVE),)
        if len(self.held(view)) == HANDS:
            return
        near = self._nearest()
        yield from ((Stop(number),) for number in near)
        if not held:
            for one in near[: settings.paired]:
                for other in near[: settings.paired]:
                    if one != other or len(heaps[one].things) >= HANDS:
                        yield Stop(one), Stop(other)

    def _nearest(self) -> list[int]:
        """Return the heaps that are worth a look: probably wanted, and brought in few ticks."""
        found = []
        for number, heap in enumerate(self._now.heaps):
            if heap.holder < 0 and self._wanted[number] >= self.settings.take:
                row = max(heap.rows, key=lambda row: self._rows[row])
                ticks, cell = self._now.leg(HELPER, self._now.starts[HELPER], heap.node)
                ticks += 2 + self._now.leg(HELPER, cell, self._now.targets[row][0])[0]
                found.append((ticks / self._wanted[number], number))
        return [number for _, number in sorted(found)[: self.settings.nearest]]

    def _expected(self, stops: Sequence[Stop], wait: float = 0.0) -> float:
        """Return the expected ticks until the partner has reached its goal, plus the price of needless things."""
        ticks = sum(share * each.finish(stops, wait) for share, each in self._forecasts)
        unwanted = sum(
            1 - (self._wanted[heap] if row == TAKE else self._rows[row]) for heap, row in stops if row != GIVE
        )
        return ticks + self.settings.needless * unwanted

    def _edge(self, stop: Stop) -> Edge:
        things = [self.space.things[number] for number in self._now.heaps[stop.heap].things]
        same = self.subgoal is not None and self.subgoal.thing in things
        thing = self.subgoal.thing if same and self.subgoal else things[0]
        if stop.row == TAKE:
            return Edge("", thing)
        if stop.row == GIVE:
            return Edge(HOLDS, thing, self.partner)
        return Edge(self.space.relations[stop.row], thing, int(self.space.targets[stop.row]))

    def _back(self, view: View) -> Edge | None:
        """Return the edge that brings back a thing in its hands that no goal wants."""
        wanted = {
            self.space.things[number]: probability
            for heap, probability in zip(self._now.heaps, self._wanted, strict=True)
            for number in heap.things
        }
        for thing in self.held(view):
            if wanted.get(thing, 0.0) < self.settings.keep:
                relation, node = self.first_places[thing]
                return Edge(relation, thing, node)
        return None
