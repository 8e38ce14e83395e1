"""The human-like agent: belief, subgoals by tree search, instructions by regression (thesis 6.4, B.1.1)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from random import Random

from hearth.agents.belief import Belief, Extent
from hearth.agents.forbidden_actions import allowed, forbidden
from hearth.agents.mcts import PUBLISHED, Search, Tree
from hearth.agents.regression_planning import Regression
from hearth.agents.subgoals import HELD, Aims, Missing, Subgoal
from hearth.agents.walk_distances import Distances
from hearth.schemas.goals import Goal
from hearth.schemas.literals import HANDS, Literal
from hearth.schemas.program import Step
from hearth.schemas.rng import rng
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.states import CLOSED, OPEN


@dataclass(frozen=True, slots=True)
class Habits:
    """Settings for the decisions of a human-like agent.

    Attributes:
        search: settings of the tree search.
        closes: whether it closes the containers that it opened, once no wanted thing is left there.
        looks_in: the containers in which it looks first (see `belief.Extent`); in the thesis any.
        doubt: ticks that a subgoal counts more if its thing was not seen.
        gives: it hands over the things that another character is to hold.
        sees_all: it knows the whole world as it is (the oracles of 6.5).
    """

    search: Search = PUBLISHED
    closes: bool = True
    looks_in: Extent = "goal"
    doubt: float = 10.0
    gives: bool = False
    sees_all: bool = False


PLAIN = Habits()


class HumanLike:
    """An agent that brings its goal about by its beliefs about the places of things.

    Attributes:
        subgoal: its current subgoal; None before its first tick, and when none is left.
    """

    def __init__(self, habits: Habits = PLAIN) -> None:
        self.habits = habits
        self.subgoal: Subgoal | None = None

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode; without a goal it does nothing (see `agents.protocol`)."""
        home = observation.world.home
        self.goal = goal or Goal()
        self.chooser: Random = rng(seed, "agent", observation.agent)
        self.me = home.index[observation.me.node]
        self.aims = Aims(self.goal, home, self.me, gives=self.habits.gives)
        self.belief = Belief(home, self.aims.things, self.chooser, looks_in=self.habits.looks_in)
        for wanted in self.aims.wanted:
            if len(wanted.literal.terms) == 1:
                self.belief.doubt(wanted.literal.name, wanted.candidates.subjects, wanted.literal.negated)
        self.never = forbidden(self.goal, home)
        self.distances = Distances(home, observation.me.stride)
        self.subgoal = None
        self.opened = 0
        self._blocked: set[Subgoal] = set()

    def act(self, observation: View, legal: Legal) -> Step | None:
        """Return the first instruction of its plan."""
        legal = allowed(legal, self.never) if self.never else legal
        everything = observation.world.home.everything
        self.belief.observe(replace(observation, mask=everything) if self.habits.sees_all else observation)
        self._note_opened(observation)
        missing = self.aims.missing(self.belief, observation)
        open_now = self.aims.open(self.belief, missing)
        self._decide(observation, open_now, missing)
        needed = self._needed(missing, observation.world.agents[observation.agent].held)
        search = Regression(observation, legal, self.belief, self._spare(observation, needed))
        if (clearing := self._clearing(search, needed)) is not None:
            return clearing
        step = search.first(self.subgoal.literal) if self.subgoal else None
        if step is None:
            self._give_up()
        return self._closing(search, step, open_now, needed) or step

    def _give_up(self) -> None:
        """Look elsewhere, or do other things first, where nothing brings the subgoal nearer."""
        if self.subgoal is not None:
            thing = self.subgoal.thing
            if self.belief.things & ~self.belief.known & 1 << thing:
                self.belief.rule_out(thing)
            self._blocked.add(self.subgoal)
            self.subgoal = None

    def _decide(self, view: View, open_now: list[Subgoal], missing: Missing) -> None:
        """Keep the subgoal while it is one of those to choose among, and nothing has failed."""
        subgoals = self.available(view, open_now, missing)
        free = [each for each in subgoals if each not in self._blocked]
        if not free:
            self._blocked.clear()
        subgoals = free or subgoals
        if self.subgoal not in subgoals or self._failed(view):
            self.subgoal = self.choose(view, subgoals, missing)

    def available(self, view: View, open_now: list[Subgoal], missing: Missing) -> list[Subgoal]:
        """Return the subgoals among which it chooses: those whose things it holds, before all others."""
        held = view.world.agents[view.agent].held
        return [each for each in open_now if each.target >= 0 and held >> each.thing & 1] or open_now

    def choose(self, view: View, subgoals: Sequence[Subgoal], missing: Missing) -> Subgoal | None:
        """One of some subgoals, by tree search."""
        if len(subgoals) < 2:
            return subgoals[0] if subgoals else None
        return subgoals[self.search(view, subgoals, missing).best]

    def search(self, view: View, subgoals: Sequence[Subgoal], missing: Missing) -> Tree:
        """Return the tree over some subgoals."""
        needed = {part: number for part, (number, _) in missing.items()}
        parts = [each.part for each in subgoals]

        def cost(start: int, number: int) -> tuple[float, int]:
            return self.cost(start, subgoals[number])

        return Tree(parts, needed, cost, self.distances.cell(view.me.place), self.chooser, self.habits.search)

    def cost(self, cell: int, subgoal: Subgoal) -> tuple[float, int]:
        """Ticks that a subgoal takes from a cell by belief, and the cell at which it ends."""
        place = self.belief.where.get(subgoal.thing)
        ticks = 0.0
        if place is None or place.node != self.me:
            ticks, cell = self._walked(cell, subgoal.thing if place is None else place.node)
            ticks += 1 + (self.belief.shut_in(subgoal.thing) >= 0)
            ticks += 0 if place is None or self.belief.known >> subgoal.thing & 1 else self.habits.doubt
        if subgoal.target >= 0:
            walk, cell = self._walked(cell, subgoal.target)
            shut = subgoal.literal.name == "INSIDE" and self.belief.states[CLOSED] >> subgoal.target & 1
            ticks += walk + 1 + shut
        return ticks, cell

    def _walked(self, cell: int, node: int) -> tuple[float, int]:
        metres, end = self.distances.leg(cell, node)
        return self.distances.ticks(metres), end

    def _failed(self, view: View) -> bool:
        """Return whether its last instruction failed, so that another subgoal may be better."""
        return view.me.last is not None and view.me.last.failure is not None

    def _needed(self, missing: Missing, held: int) -> int:
        """Return the things that could still count for a missing part, and those in its hands that it is to hold."""
        found = 0
        for wanted in self.aims.wanted:
            if wanted.part in missing:
                found |= wanted.counted & ~missing[wanted.part][1] & ~self.aims.settled
            elif wanted.last == HELD:
                found |= mask_of(list(indices(held & wanted.counted))[: wanted.count])
        return found & self.aims.things

    def _spare(self, view: View, needed: int) -> tuple[int, ...]:
        """Return the things that it would put down first if it needs a hand.

        Things that are not needed come first, then those that are not of its current subgoal.
        """
        pursued = -1 if self.subgoal is None else self.subgoal.thing
        others = [i for i in edge_rows.held_indices(view.world.agents[view.agent]) if i != pursued]
        return tuple(sorted(others, key=lambda i: bool(needed >> i & 1)))

    def _clearing(self, search: Regression, needed: int) -> Step | None:
        """Put a thing down, if both hands are full of things that are not needed."""
        me = search.me
        if not (me.right and me.left) or me.held & needed or not search.spare:
            return None
        return search.first(Literal(HANDS[0], (self.me, search.spare[0]), negated=True))

    def _note_opened(self, view: View) -> None:
        """Remember the containers that it opened; forget closed ones, and doors, which it needs open."""
        last, home = view.me.last, view.world.home
        if last is not None and last.failure is None:
            instruction = last.instruction
            opened = instruction.objects if home.knowledge.state_of(instruction.action) == "OPEN" else ()
            self.opened |= mask_of(home.index[ref.node] for ref in opened if ref.node is not None)
        self.opened &= self.belief.states[OPEN] & ~home.doors

    def _closing(self, search: Regression, step: Step | None, open_now: Sequence[Subgoal], needed: int) -> Step | None:
        """Close an opened container before it walks away, if no wanted thing is left there and none is to go in."""
        if not self.habits.closes or not self.opened or not self._leaves(search, step):
            return None
        where = self.belief.where
        kept = mask_of(each.target for each in open_now if each.target >= 0)
        kept |= mask_of(where[thing].node for thing in indices(needed & self.belief.known))
        container = next((i for i in indices(self.opened & ~kept) if search.near(i)), -1)
        return search.first(Literal("CLOSED", (container,))) if container >= 0 else None

    def _leaves(self, search: Regression, step: Step | None) -> bool:
        """Return whether an instruction ends its work at this place."""
        return step is None or step.action in search.home.knowledge.group("goes")
