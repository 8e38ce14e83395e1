"""Subgoals: the remaining parts of a goal, by belief, one thing at a time (thesis B.1.1)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from hearth.agents.belief import Belief
from hearth.schemas.goals import Goal
from hearth.schemas.literals import HANDS, HOLDS, Literal, Name
from hearth.schemas.vocabulary import STATE_ID
from hearth.simulation.literal_truth import Candidates, binary, candidates
from hearth.simulation.observation.views import View
from hearth.simulation.world.bits import indices, lowest, mask_of
from hearth.simulation.world.home import Home

HELD, RESTS = 1, 2
"""Order of the parts of a goal that are about characters, after those about things."""

Missing = dict[int, tuple[int, int]]
"""The missing parts of a goal by belief: part -> the number missing, and the set of nodes that count."""


class Subgoal(NamedTuple):
    """A literal that is to hold of certain nodes.

    Attributes:
        literal: about indices of nodes: `ON(plate, table)`, `HOLDS(me, book)`, `ON(me, sofa)`, `ON(television)`.
        part: which of the goal's literals it is for.
        thing: the index of the carried or handled thing: the plate, the book, the sofa, the television.
        target: where it is to go; -1 if it goes nowhere.
    """

    literal: Literal[int]
    part: int
    thing: int
    target: int = -1


@dataclass(frozen=True, slots=True)
class Wanted:
    """One literal of a goal in a home.

    Attributes:
        part: its number in the goal.
        count: how often it must hold.
        candidates: the nodes of which it may hold (see `simulation.literal_truth`).
        last: it is about the agent itself, and comes after the others; 2 if it ends in rest.
    """

    part: int
    count: int
    candidates: Candidates
    last: int

    @property
    def literal(self) -> Literal[Name]:
        """Return the literal as the goal has it."""
        return self.candidates.literal

    @property
    def counted(self) -> int:
        """Return the nodes that may be counted for it."""
        return self.candidates.targets if self.last else self.candidates.subjects


class Aims:
    """A goal as one agent pursues it.

    Attributes:
        wanted: its literals, those about other characters left out.
        things: the movable things that it is about.
        settled: those that a part needs where they are, and no other part may take.
    """

    def __init__(self, goal: Goal, home: Home, me: int, *, gives: bool = False) -> None:
        """Read a goal.

        Args:
            goal: counted literals; joined parts are not pursued.
            home: of the episode.
            me: index of the agent's node.
            gives: it hands over the things that another character is to hold.
        """
        self._home, self._me, self._gives = home, me, gives
        self._handed = 0
        self.settled = 0
        every = [self._wanted(number, literal, count) for number, (literal, count) in enumerate(goal)]
        self.wanted = tuple(each for each in every if self._mine(each))
        self.things = 0
        for each in self.wanted:
            self.things |= each.counted & home.properties["GRABBABLE"]

    def _wanted(self, part: int, literal: Literal[Name], count: int) -> Wanted:
        found = candidates(literal, self._home)
        last = 0
        if found.by_target:
            last = HELD if literal.name in (HOLDS, *HANDS) else RESTS
        return Wanted(part, found.needed(count), found, last)

    def _mine(self, wanted: Wanted) -> bool:
        """Return whether it is the agent's to do: not where another character is to sit."""
        if not wanted.candidates.by_target or wanted.candidates.subjects >> self._me & 1:
            return True
        return self._gives and wanted.last == HELD

    def met(self, wanted: Wanted, belief: Belief, view: View) -> int:
        """Return the set of nodes that are counted for a literal by belief."""
        name, targets = wanted.literal.name, wanted.candidates.targets
        if self._by_others(wanted):
            found = self._given(wanted, belief)
        elif wanted.last:
            found = binary(name)(view.world, self._me, targets)
        elif name in STATE_ID and len(wanted.literal.terms) == 1:
            found = belief.states[STATE_ID[name]] & wanted.candidates.subjects
        else:
            found = 0
            for thing in indices(wanted.candidates.subjects & belief.known):
                relation, node = belief.where[thing]
                if relation == name and targets >> node & 1:
                    found |= 1 << thing
        return wanted.counted & ~found if wanted.literal.negated else found

    def _given(self, wanted: Wanted, belief: Belief) -> int:
        """Return the things that other agents were last seen to hold, of those that they are to hold."""
        seen = wanted.counted & belief.known
        held = (t for t in indices(seen) if belief.where[t].relation == HOLDS)
        subjects = wanted.candidates.subjects
        self._handed = self._handed & ~seen | mask_of(t for t in held if subjects >> belief.where[t].node & 1)
        return self._handed & wanted.counted

    def _by_others(self, wanted: Wanted) -> bool:
        """Return whether it is another character that is to hold something."""
        return wanted.last == HELD and not wanted.candidates.subjects >> self._me & 1

    def missing(self, belief: Belief, view: View) -> Missing:
        """Return the parts of the goal that are not reached by belief."""
        found = {}
        self.settled = 0
        for wanted in self.wanted:
            met = self.met(wanted, belief, view)
            if not wanted.literal.negated:
                self.settled |= mask_of(list(indices(met))[: wanted.count])
            if (number := wanted.count - met.bit_count()) > 0:
                found[wanted.part] = number, met
        return found

    def open(self, belief: Belief, missing: Missing) -> list[Subgoal]:
        """Return the subgoals that would bring a missing part nearer.

        Those about things come first, then the thing that it is to hold, then the place to rest. A thing that another
        character holds is left to it.
        """
        for last in range(3):
            found = [
                subgoal
                for wanted in self.wanted
                if wanted.part in missing and last == (0 if self._by_others(wanted) else wanted.last)
                for subgoal in self._open(wanted, missing[wanted.part][1], belief)
            ]
            if found:
                return found
        return []

    def _open(self, wanted: Wanted, met: int, belief: Belief) -> list[Subgoal]:
        things = wanted.counted & ~met & ~self.settled
        held = {t for t in indices(things) if t in belief.where and belief.where[t].relation == HOLDS}
        free = [t for t in indices(things) if t not in held or belief.where[t].node == self._me]
        name = wanted.literal.name
        if self._by_others(wanted):
            other = lowest(wanted.candidates.subjects)
            return [Subgoal(Literal("ON", (t, other)), wanted.part, t, other) for t in free]
        if wanted.last:
            return [Subgoal(Literal(name, (self._me, t)), wanted.part, t) for t in free]
        if len(wanted.literal.terms) == 1:
            return [Subgoal(Literal(name, (t,), wanted.literal.negated), wanted.part, t) for t in free]
        if wanted.literal.negated:
            return [Subgoal(Literal(HOLDS, (self._me, t)), wanted.part, t) for t in free]
        target = lowest(wanted.candidates.targets)
        return [Subgoal(Literal(name, (t, target)), wanted.part, t, target) for t in free]
