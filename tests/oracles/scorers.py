"""Scorers without a model: random ones, and one that knows the program that it is to write."""

from __future__ import annotations

from random import Random

import numpy as np

from hearth.models.decoding.scorers import Asked, Part, Scores
from hearth.schemas.program import ObjectRef, Step

BY_ACTION = (Part.ACTION, Part.FIRST, Part.SECOND)
BY_OBJECT = (Part.FIRST, Part.ACTION, Part.SECOND)
WHOLE = (Part.STEP,)


class RandomScorer:
    """Random scores that depend on what is asked alone, as a model's with random weights."""

    def __init__(self, actions, order=BY_OBJECT, end=-2.0) -> None:
        self.order, self.actions, self.end = order, tuple(sorted(actions)), end

    def begin(self, worlds, inputs):
        return list(inputs)

    def advance(self, asked, steps):
        return [each.state for each in asked]

    def score(self, asked, part):
        return [self._score(each, part) for each in asked]

    def _score(self, asked: Asked, part: Part) -> Scores:
        home = asked.world.home
        nodes = sum(node + 2 for node in asked.chosen[1:] if node is not None)
        draw = np.random.default_rng([asked.state, len(asked.steps), len(part), nodes])
        proposed = self._proposed(asked) if part is Part.STEP else ()
        count = {Part.ACTION: len(self.actions), Part.STEP: len(proposed)}.get(part, len(home))
        if part is self.order[0]:
            count += 2 if part is Part.FIRST else 1
        values = draw.normal(size=count)
        if part is self.order[0]:
            values[-1] += self.end
        return Scores(values, proposed)

    def _proposed(self, asked: Asked) -> tuple[Step, ...]:
        """Whole steps that mostly cannot be done."""
        home, random = asked.world.home, Random(asked.state * 997 + len(asked.steps))
        arity = home.knowledge.arity
        found = []
        for _ in range(80):
            action = random.choice(self.actions)
            nodes = [random.choice(home.ids) for _ in range(arity[action])]
            found.append(Step(action, tuple(ObjectRef(home.classes[home.index[n]], 1, n) for n in nodes)))
        return tuple(found)


class Knowing(RandomScorer):
    """Scores that lead to one program."""

    def __init__(self, actions, program, order=BY_OBJECT) -> None:
        super().__init__(actions, order)
        self.program = program

    def _score(self, asked, part):
        home = asked.world.home
        count = len(self.actions) if part is Part.ACTION else len(home)
        first = part is self.order[0]
        values = np.full(count + (first and 1 + (part is Part.FIRST)), -9.0)
        if len(asked.steps) >= len(self.program):
            values[-1] = 0.0
            return Scores(values)
        step = self.program[len(asked.steps)]
        nodes = [home.index[ref.node] for ref in step.objects]
        if part is Part.ACTION:
            values[self.actions.index(step.action)] = 0.0
        else:
            place = part is Part.SECOND
            wanted = nodes[place] if place < len(nodes) else len(home)
            values[min(wanted, len(values) - 1)] = 0.0  # another draft of the beam may be at another action
        return Scores(values)
