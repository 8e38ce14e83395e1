"""The posterior over an agent's goals, weighed goal by goal: the twin of `hearth.agents.goal_posterior`."""

import math

from hearth.agents.goal_posterior import FAR
from hearth.schemas.literals import HOLDS


class Plain:
    """The posterior, goal by goal and thing by thing."""

    def __init__(self, goals, home, model):
        self.goals, self.home, self.model = list(goals), home, model
        self.weights = dict(goals)
        self.pursued, self.last, self.places = {}, None, None

    def observe(self, world, other, costs, trips, space):
        step = other.last and (other.last.instruction, other.last.failure)
        if step and self.places and step != self.last:
            self.weigh(step[0])
        self.last = step
        places = space.places(world)
        if places == self.places:
            return
        self.places, self.last = places, None
        me = self.me = self.home.index[other.node]
        rows = list(dict.fromkeys(literal for goal in self.goals for literal, _ in goal))
        for goal in self.goals:
            lacking = self.lacking(goal, places)
            if not lacking or any(self.too_few(goal, literal, places) for literal in lacking):
                self.weights[goal] = 0.0
            found = {}
            for number, thing in enumerate(space.things):
                for literal in lacking:
                    row = rows.index(literal)
                    if number in self.able(literal, costs[row]):
                        saved = self.saved(goal, literal, number, row, costs, trips)
                        worth = math.exp(-self.model.rationality * (costs[row, number] - saved))
                        found[thing] = found.get(thing, 0.0) + worth
            held = {t: v for t, v in found.items() if places[space.things.index(t)] == (HOLDS, me)}
            found = held or found
            total = sum(found.values())
            self.pursued[goal] = {t: v / total for t, v in found.items()} if total else {}
        self.normalise()
        self.things = space.things

    def saved(self, goal, literal, number, row, costs, trips):
        """A round trip, or, of more things than are needed, the dearest of the cheapest that are."""
        me = self.me

        def trip(n):
            return costs[row, n] if self.places[n] == (HOLDS, me) else trips[row, n]

        met = sum(self.counts(literal, t, p) for t, p in zip(self.all, self.places, strict=True))
        cheapest = sorted(map(trip, self.able(literal, costs[row])))[: dict(goal)[literal] - met]
        return min(trip(number), cheapest[-1])

    def too_few(self, goal, literal, places):
        """Return whether a goal wants more of some things than there are."""
        return dict(goal)[literal] > sum(self.counts(literal, thing, None) for thing in self.all)

    def able(self, literal, costs):
        return [
            n for n, thing in enumerate(self.all)
            if self.counts(literal, thing, None)
            and not self.counts(literal, thing, self.places[n])
            and costs[n] < FAR
        ]  # fmt: skip

    def counts(self, literal, thing, place):
        fits = bool(self.home.instances(literal.subject) >> thing & 1)
        return fits and (place is None or place == (literal.name, self.home.index[literal.target]))

    def lacking(self, goal, places):
        return [
            literal for literal, number in goal
            if sum(self.counts(literal, t, p) for t, p in zip(self.all, places, strict=True)) < number
        ]  # fmt: skip

    def weigh(self, step):
        known, nodes = self.home.knowledge, [self.home.index[ref.node] for ref in step.objects]
        name = step.action
        if not nodes or known.state_of(name) == "CLOSED":
            return
        before = dict(zip(self.all, self.places, strict=True))
        for goal in self.goals:
            pursued, match = self.pursued[goal], {}
            for thing in pursued:
                held = before[thing] == (HOLDS, self.me)
                ends = {
                    self.home.index[literal.target]
                    for literal in self.lacking(goal, self.places)
                    if self.counts(literal, thing, None)
                }
                if name == "Grab":
                    match[thing] = thing == nodes[0]
                elif name in known.group("puts"):
                    match[thing] = thing == nodes[0] and nodes[1] in ends
                elif held:
                    match[thing] = nodes[0] in ends
                else:
                    match[thing] = nodes[0] in (thing, before[thing][1])
            explained = sum(pursued[t] * match[t] for t in pursued)
            self.weights[goal] *= (1 - self.model.slip) * explained + self.model.slip / len(self.all)
            if explained > 0:
                self.pursued[goal] = {t: pursued[t] * match[t] / explained for t in pursued}
        self.normalise()

    def normalise(self):
        total = sum(self.weights.values())
        self.weights = {goal: weight / total for goal, weight in self.weights.items()}
