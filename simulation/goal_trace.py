"""A goal over a run: the facts at its end, the acts, and their order.

A state or relation is reached while it holds; an action is reached once it has been done. The parts of `A then B` are
reached one after the other. After a state, a state is reached only when it begins to hold; after an action it may have
held before, as in `WATCH(x) then ON(television)` of the Embodied Agent Interface. The last part is reached at the end.
`always` and `never` ask for every time since the part before, `within` for some time in its ticks.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from typing import NamedTuple

from hearth.schemas.goals import LASTING, Goal, Joined
from hearth.schemas.literals import AGENT, Literal, Name
from hearth.schemas.program import Step
from hearth.simulation.engine import Execution
from hearth.simulation.literal_truth import candidates, nodes
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


class Trace(NamedTuple):
    """A run.

    Attributes:
        worlds: the start, and the world after each tick.
        done: the instructions done in each tick.
    """

    worlds: tuple[World, ...]
    done: tuple[tuple[Step, ...], ...] = ()

    @classmethod
    def of(cls, execution: Execution) -> Trace:
        """Return the acts of an execution, up to its failure if it has one."""
        return cls(execution.worlds, tuple(islice(execution.program.ticks(), len(execution.worlds) - 1)))

    def reached(self, goal: Goal, since: int = 0, now: int | None = None) -> bool:
        """Return whether a goal is reached in the world of one number, by the acts since that of another."""
        now = len(self.done) if now is None else now
        counted = all(self.times(literal, since, now) >= self.needed(literal, wanted) for literal, wanted in goal)
        return counted and all(self.has(part, since, now) for part in goal.parts)

    def needed(self, literal: Literal[Name], wanted: int) -> int:
        """Return how often a literal must hold to be reached (see `Candidates.needed`)."""
        home = self.worlds[0].home
        return wanted if acts(literal, home) else candidates(literal, home).needed(wanted)

    def times(self, literal: Literal[Name], since: int, now: int) -> int:
        """Return how often a literal holds in a world; of an action, with how many different objects it was done."""
        world = self.worlds[now]
        if acts(literal, world.home):
            done = ((tick, step) for tick in range(since, now) for step in self.done[tick])
            found = ((tick, step.objects) for tick, step in done if _does(step, literal, world.home))
            return len({tuple(ref.node for ref in objects) or (tick,) for tick, objects in found})
        return sum(mask.bit_count() for mask in candidates(literal, world.home).met(world))

    def has(self, part: Joined, since: int, now: int) -> bool:
        """Return whether a joined part of a goal is reached."""
        if part.join == "then":
            return self._ordered(part.goals, since, now)
        if part.join == "or":
            return any(self.reached(goal, since, now) for goal in part.goals)
        (goal,) = part.goals
        if part.join == "within":
            return any(self.reached(goal, since, at) for at in range(since, min(now, since + part.ticks) + 1))
        if part.join in LASTING:
            wanted = part.join == "always"
            return all(self.reached(goal, since, at) is wanted for at in range(since, now + 1))
        if part.join == "not":
            return not self.reached(goal, since, now)
        if part.join == "forpairs":
            return self._paired(part, since, now)
        found = (self.reached(goal.bound(part.variable, node), since, now) for node in self._things(part))
        if part.join == "forn":
            return sum(found) == part.number
        return any(found) if part.join == "exists" else all(found)

    def lost(self, part: Joined) -> bool:
        """Return whether a joined part can't be reached any longer, whatever is done from now on.

        So it is once a ban was broken: `always`, `never`, and `not` of actions; and after the last tick of `within`.
        """
        now = len(self.done)
        if self.has(part, 0, now):
            return False
        if part.join == "not":
            goal, home = part.goals[0], self.worlds[0].home
            return not goal.parts and all(acts(literal, home) for literal, _ in goal)
        return part.join in LASTING or (part.join == "within" and now >= part.ticks)

    def _paired(self, part: Joined, since: int, now: int) -> bool:
        """Return whether each thing of the class with fewer things has a partner of its own in the other class."""
        ones, others = (self._of_class(kind) for kind in (part.kind, part.other[1]))
        few, many = (ones, others) if len(ones) <= len(others) else (others, ones)
        names = (part.variable, part.other[0]) if few is ones else (part.other[0], part.variable)
        fits = {
            one: [other for other in many if one != other
                  and self.reached(part.goals[0].bound(names[0], one).bound(names[1], other), since, now)]
            for one in few
        }  # fmt: skip
        partner: dict[int, int] = {}
        return all(_has_partner(one, fits, partner, set()) for one in few)

    def _of_class(self, kind: str) -> list[int]:
        home = self.worlds[0].home
        return [home.ids[i] for i in indices(nodes(kind, home))]

    def _things(self, part: Joined) -> Iterable[int]:
        """Return the nodes that a variable may stand for.

        To make an action's literal hold, only those that were used.
        """
        if part.kind:
            return self._of_class(part.kind)
        home = self.worlds[0].home
        about = [literal for literal, _ in part.goals[0].literals() if part.variable in literal.terms]
        if part.join == "exists" and about and _positive(part.goals[0]) and all(acts(each, home) for each in about):
            return {ref.node for steps in self.done for step in steps for ref in step.objects if ref.node is not None}
        return (home.ids[i] for i in indices(home.everything))

    def _ordered(self, goals: Sequence[Goal], since: int, now: int) -> bool:
        home = self.worlds[0].home
        begins = False
        for goal in goals[:-1]:
            first = next((at for at in range(since, now + 1) if self._comes(goal, since, at, begins)), None)
            if first is None:
                return False
            since, begins = first, not any(acts(literal, home) for literal, _ in goal.literals())
        last = Goal(goals[-1].counts, tuple(part for part in goals[-1].parts if part.join not in LASTING))
        begins = begins and bool(last.counts or last.parts or not goals[-1].parts)
        came = not begins or any(self._comes(last, since, at, begins) for at in range(since + 1, now + 1))
        return came and self.reached(goals[-1], since, now)

    def _comes(self, goal: Goal, since: int, at: int, begins: bool) -> bool:
        """Return whether a goal is reached at a time.

        With `begins`, for the first time since an earlier one or again.
        """
        if begins and not goal.counts and [part.join for part in goal.parts] == ["or"]:
            return any(self._comes(other, since, at, begins) for other in goal.parts[0].goals)
        if begins and not goal.counts and [part.join for part in goal.parts] == ["within"]:
            (part,) = goal.parts
            return at <= since + part.ticks and self._comes(part.goals[0], since, at, begins)
        before = begins and (at == since or self.reached(goal, since, at - 1))
        return self.reached(goal, since, at) and not before


def _has_partner(one: int, fits: Mapping[int, Sequence[int]], partner: dict[int, int], tried: set[int]) -> bool:
    """Give a thing a partner that fits, and others new ones where theirs is taken; return whether there is one."""
    for other in fits[one]:
        if other not in tried:
            tried.add(other)
            if other not in partner or _has_partner(partner[other], fits, partner, tried):
                partner[other] = one
                return True
    return False


def _positive(goal: Goal) -> bool:
    return all(
        part.join not in ("not", "never", "forall", "forn") and all(map(_positive, part.goals)) for part in goal.parts
    )


def acts(literal: Literal[Name], home: Home) -> bool:
    """Return whether a literal is about an action that is done."""
    return literal.name in home.knowledge.actions


def by_agent(literal: Literal[Name]) -> bool:
    """Return whether an action's first term says who does it."""
    return bool(literal.terms) and str(literal.terms[0]).partition(":")[0] == AGENT


def _does(step: Step, literal: Literal[Name], home: Home) -> bool:
    if step.action != literal.name:
        return False
    who = by_agent(literal)
    if who and not nodes(literal.terms[0], home) >> home.agents[step.agent] & 1:
        return False
    objects = zip(literal.terms[who:], step.objects, strict=False)
    return all(ref.node is not None and nodes(term, home) >> home.index[ref.node] & 1 for term, ref in objects)
