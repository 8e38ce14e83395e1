"""The test that a goal is reached over a run, read slowly off graphs: the twin of `simulation.goal_trace`.

A time is the number of ticks that are done. A part is asked from the time at which the one before it was reached.
"""

from __future__ import annotations

from dataclasses import dataclass

from hearth.kb.knowledge import Knowledge
from hearth.schemas.goals import Goal, Joined
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.literals import Literal
from hearth.schemas.program import Step
from oracles.holds import Plain


@dataclass(frozen=True)
class PlainRun:
    """The graph at each time, and the instructions of each tick."""

    graphs: list[EnvironmentGraph]
    plain: list[Plain]
    ticks: list[tuple[Step, ...]]
    knowledge: Knowledge

    @classmethod
    def of(cls, graphs: list[EnvironmentGraph], ticks: list[tuple[Step, ...]], knowledge: Knowledge) -> PlainRun:
        """The reading of a run."""
        return cls(graphs, [Plain.of(graph, graphs[0], knowledge) for graph in graphs], ticks, knowledge)

    def reached(self, goal: Goal, since: int, now: int) -> bool:
        for literal, wanted in goal.counts:
            if self.count(literal, since, now) < wanted:
                return False
        return all(self.part(part, since, now) for part in goal.parts)

    def count(self, literal: Literal, since: int, now: int) -> int:
        plain = self.plain[now]
        if literal.name not in self.knowledge.actions:
            return plain.count(literal)
        found = set()
        for time in range(since + 1, now + 1):
            for step in self.ticks[time - 1]:
                if step.action == literal.name and self.fits(step, literal, plain):
                    found.add(tuple(ref.node for ref in step.objects) or time)
        return len(found)

    def fits(self, step: Step, literal: Literal, plain: Plain) -> bool:
        terms = list(literal.terms)
        if terms and isinstance(terms[0], str) and terms[0].split(":")[0] == "agent":
            who = sorted(plain.characters())[step.agent]
            if who not in plain.meant(terms.pop(0), {}):
                return False
        return all(step.objects[n].node in plain.meant(term, {}) for n, term in enumerate(terms))

    def part(self, part: Joined, since: int, now: int) -> bool:
        if part.join == "or":
            return any(self.reached(goal, since, now) for goal in part.goals)
        if part.join == "always":
            return not [time for time in range(since, now + 1) if not self.reached(part.goals[0], since, time)]
        if part.join == "never":
            return not [time for time in range(since, now + 1) if self.reached(part.goals[0], since, time)]
        if part.join == "within":
            times = [time for time in range(since, now + 1) if self.reached(part.goals[0], since, time)]
            return bool(times) and times[0] - since <= part.ticks
        if part.join == "not":
            return not self.reached(part.goals[0], since, now)
        if part.join == "then":
            return self.chain(list(part.goals), since, now, begins=False)
        each = [self.reached(part.goals[0].bound(part.variable, node.id), since, now) for node in self.graphs[0].nodes]
        return any(each) if part.join == "exists" else all(each)

    def chain(self, goals: list[Goal], since: int, now: int, begins: bool) -> bool:
        goal, *rest = goals
        times = [time for time in range(since, now + 1) if self.comes(goal, since, time, begins)]
        if not rest:
            whole = self.reached(goal, since, now)
            lasting = [part for part in goal.parts if part.join in ("always", "never")]
            if not begins or not lasting:
                return bool(times) and whole
            other = Goal(goal.counts, tuple(part for part in goal.parts if part not in lasting))
            begun = other == Goal() or any(self.comes(other, since, time, True) for time in range(since, now + 1))
            return begun and whole
        acts = any(literal.name in self.knowledge.actions for literal, _ in goal.literals())
        return bool(times) and self.chain(rest, times[0], now, not acts)

    def comes(self, goal: Goal, since: int, time: int, begins: bool) -> bool:
        if not begins:
            return self.reached(goal, since, time)
        if not goal.counts and len(goal.parts) == 1 and goal.parts[0].join == "or":
            return any(self.comes(one, since, time, True) for one in goal.parts[0].goals)
        if not goal.counts and len(goal.parts) == 1 and goal.parts[0].join == "within":
            return time - since <= goal.parts[0].ticks and self.comes(goal.parts[0].goals[0], since, time, True)
        return time > since and self.reached(goal, since, time) and not self.reached(goal, since, time - 1)
