"""The progress of a goal, updated by changes and by acts (thesis 6.3, tables B.1 and C.2)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from functools import cached_property
from operator import is_

from hearth.schemas.call_errors import explained
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import BANS, Goal, Joined
from hearth.schemas.graph_change import Change
from hearth.schemas.literals import AGENT, HANDS, HOLDS, Literal, Name
from hearth.schemas.program import Step
from hearth.schemas.short_repr import brief
from hearth.schemas.vocabulary import EVERY_STATE_ID, RELATIONS
from hearth.simulation.engine import Execution
from hearth.simulation.goal_trace import Trace, acts, by_agent
from hearth.simulation.literal_truth import Candidates, candidates, nodes
from hearth.simulation.world.changed_nodes import BY_PLACE, changed, unchanged
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

RELATED = frozenset({*RELATIONS, HOLDS})
"""The relations of goals."""

LiteralFault = tuple[str, Code, str]
"""Refusals of a goal's literal: a message, a code and a suggestion."""


@dataclass(frozen=True, slots=True)
class Watch:
    """A literal of a goal: the nodes that can make it hold, and those that do now (see `literal_truth.Candidates`)."""

    literal: Literal[Name]
    wanted: int
    candidates: Candidates
    met: tuple[int, ...] = ()

    __repr__ = brief

    @property
    def count(self) -> int:
        """Return how often it holds."""
        return sum(mask.bit_count() for mask in self.met)


@dataclass(frozen=True)
class Progress:
    """A goal in a world: how often each of its literals holds. A value; `after` gives the next one.

    Attributes:
        goal: as given.
        watches: its literals, followed by the changes; none of a goal about actions or order.
        trace: of such a goal, the run up to now.

    Examples:
        >>> goal = hearth.Goal.of(hearth.Literal.of("HOLDS", "agent", "milk"), hearth.Literal.of("CLOSED", "fridge"))
        >>> progress = hearth.Progress.start(goal, world).after(execution.final, execution.final.changes(world))
        >>> progress.counts, progress.satisfied
        ((1, 0), False)
    """

    goal: Goal
    watches: tuple[Watch, ...]
    trace: Trace | None = None

    __repr__ = brief

    @classmethod
    @explained
    def start(cls, goal: Goal, world: World) -> Progress:
        """Look at the whole world once.

        Raises:
            HearthError: UNKNOWN_OBJECT, UNKNOWN_ACTION, UNKNOWN_AGENT, WRONG_ARITY or SYNTAX: a literal names nothing
                of this home, or what no action changes.
        """
        for literal, _ in goal.literals():
            if fault := check(literal, world.home):
                raise HearthError.of(fault[1], f"goal {literal}: {fault[0]}", suggestion=fault[2])
        return cls.at(goal, world)

    @classmethod
    def at(cls, goal: Goal, world: World) -> Progress:
        """Return the same unchecked: a literal about absent things never holds."""
        if goal.parts or any(acts(literal, world.home) for literal, _ in goal):
            return cls(goal, (), Trace((world,)))
        found = ((literal, wanted, candidates(literal, world.home)) for literal, wanted in goal)
        return cls(goal, tuple(Watch(each, some.needed(wanted), some, some.met(world)) for each, wanted, some in found))

    @classmethod
    def of(cls, goal: Goal, execution: Execution) -> Progress:
        """Return the progress at the end of a run."""
        found = cls.start(goal, execution.final)
        return replace(found, trace=Trace.of(execution)) if found.trace else found

    def after(self, world: World, change: Change, done: Sequence[Step] = ()) -> Progress:
        """Return the progress in a world that follows the last by a change.

        Looks only at the nodes that the change names.

        Args:
            world: after the tick.
            change: from the world before.
            done: the instructions of the tick; goals about actions and order need them, and every tick.
        """
        if self.trace:
            return replace(self, trace=Trace((*self.trace.worlds, world), (*self.trace.done, tuple(done))))
        touched = _touched(change, world.home)
        if not touched:
            return self
        touched[HOLDS] = touched[HANDS[0]] | touched[HANDS[1]]
        return replace(
            self, watches=tuple(_updated(watch, world, touched[watch.literal.name]) for watch in self.watches)
        )

    def then(self, before: World, world: World, done: Sequence[Step] = ()) -> Progress:
        """Return the same as `after`, from the world before instead of a change; faster, where both are of one home.

        Args:
            before: the world that this is the progress in.
            world: after the tick.
            done: the instructions of the tick, as `after` needs them.
        """
        if self.trace or before.home is not world.home:
            return self.after(world, world.changes(before), done)
        if unchanged(before, world) and not any(watch.literal.name in BY_PLACE for watch in self.watches):
            return self
        watches = [_updated(watch, world, changed(watch.literal.name, before, world)) for watch in self.watches]
        same = all(map(is_, watches, self.watches))
        return self if same else Progress(self.goal, tuple(watches))

    @cached_property
    def counts(self) -> tuple[int, ...]:
        """Return how often each literal holds, in the goal's order."""
        if self.trace:
            return tuple(self.trace.times(literal, 0, len(self.trace.done)) for literal, _ in self.goal)
        return tuple(watch.count for watch in self.watches)

    @cached_property
    def has(self) -> tuple[bool, ...]:
        """Return whether each joined part is reached, in the goal's order."""
        trace = self.trace
        return tuple(trace.has(part, 0, len(trace.done)) for part in self.goal.parts) if trace else ()

    @cached_property
    def lost(self) -> tuple[bool, ...]:
        """Return whether each joined part can't be reached any longer, in the goal's order: a ban that was broken."""
        return tuple(map(self.trace.lost, self.goal.parts)) if self.trace else ()

    @cached_property
    def broken(self) -> tuple[Joined, ...]:
        """Return the bans that were broken, each for good; of a goal `F within n`, time is over and nothing broken."""
        return tuple(part for part, lost in zip(self.goal.parts, self.lost, strict=False) if lost and part.join in BANS)

    @cached_property
    def satisfied(self) -> bool:
        """Return whether every literal holds as often as is wanted, and every part is reached.

        True for an empty goal.
        """
        return all(found >= wanted for found, (_, wanted) in self.required()) and all(self.has)

    @cached_property
    def fraction(self) -> float:
        """The satisfied share of the required counts and parts, from 0 to 1; 1 for an empty goal.

        0 once a ban was broken, as no part of such a goal helps any longer.
        """
        if self.broken:
            return 0.0
        wanted = sum(count for _, (_, count) in self.required()) + len(self.goal.parts)
        found = sum(min(count, most) for count, (_, most) in self.required()) + sum(self.has)
        return found / wanted if wanted else 1.0

    def unmet(self) -> Goal:
        """Return the rest of the goal: each literal with its missing number, and the parts that are not reached."""
        missing = ((literal, wanted - found) for found, (literal, wanted) in self.required())
        parts = (part for part, reached in zip(self.goal.parts, self.has, strict=True) if not reached)
        return Goal(tuple((literal, number) for literal, number in missing if number > 0), tuple(parts))

    def required(self) -> Iterator[tuple[int, tuple[Literal[Name], int]]]:
        """Yield how often each literal holds, with the literal and how often it must."""
        counts = self.counts
        for number, (literal, wanted) in enumerate(self.goal):
            needed = self.trace.needed(literal, wanted) if self.trace else self.watches[number].wanted
            yield counts[number], (literal, needed)


def _updated(watch: Watch, world: World, touched: int) -> Watch:
    if not touched:
        return watch
    met = watch.candidates.updated(watch.met, world, touched)
    return watch if met == watch.met else replace(watch, met=met)


def _touched(change: Change, home: Home) -> defaultdict[str, int]:
    """Return the nodes that a change is about by relation or state; both ends of an edge."""
    found: defaultdict[str, int] = defaultdict(int)
    index = home.index
    for source, relation, target in (*change.added, *change.removed):
        found[relation] |= 1 << index[source] | 1 << index[target]
    for node, state in (*change.set_states, *change.cleared_states):
        found[state] |= 1 << index[node]
    return found


def check(literal: Literal[Name], home: Home) -> LiteralFault | None:
    """Return why no change could make a literal hold, or what the home and its knowledge do not have.

    None if nothing.
    """
    known, terms = home.knowledge, literal.terms
    if acts(literal, home):
        action = known.actions[literal.name]
        if (number := len(terms) - by_agent(literal)) > action.arity:
            return f"{literal.name} has {number} objects and takes {action.arity}", Code.WRONG_ARITY, ""
        if not action.executed:
            return f"{literal.name} is not simulated", Code.NOT_SIMULATED, ""
    elif not terms:
        return f"`{literal.name}` is not a known action", Code.UNKNOWN_ACTION, _near(literal.name, home, "action")
    elif literal.name not in (EVERY_STATE_ID if len(terms) == 1 else RELATED if len(terms) == 2 else ()):
        kind, names = ("state", EVERY_STATE_ID) if len(terms) == 1 else ("relation", RELATED)
        near = get_close_matches(literal.name, names, n=1)
        meant = f"did you mean `{near[0]}`?" if near else ""
        return f"{literal.name} is not a known {kind}", Code.SYNTAX, meant
    return next((fault for term in terms if (fault := unknown(term, home))), None)


def unknown(term: Name, home: Home) -> LiteralFault | None:
    """Return why a term stands for nothing that there could be; None if it does."""
    if term == AGENT or nodes(term, home) or str(term).startswith("?"):
        return None
    if isinstance(term, int):
        return f"the home has no node {term}", Code.UNKNOWN_OBJECT, ""
    if term.startswith(f"{AGENT}:"):
        return f"the home has no {term}", Code.UNKNOWN_AGENT, ""
    if home.knowledge.object_class(term):
        return None
    return f"`{term}` is not a known class", Code.UNKNOWN_OBJECT, _near(term, home, "object")


def _near(name: str, home: Home, kind: str) -> str:
    near = home.knowledge.suggest(name, kind)
    return f"did you mean `{near[0]}`?" if near else ""
