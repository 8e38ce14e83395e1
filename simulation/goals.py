"""The progress of a goal, updated by changes (thesis 6.3, tables B.1 and C.2)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, replace

from hearth.schemas.change import Change
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.literals import AGENT, HANDS, HOLDS, Literal, Name
from hearth.schemas.vocabulary import RELATIONS, STATE_ID
from hearth.simulation.holds import Candidates, candidates
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

_RELATIONS = frozenset({*RELATIONS, HOLDS})


@dataclass(frozen=True, slots=True)
class Watch:
    """A literal of a goal: what may make it hold, and what does now (see `holds.Candidates`)."""

    literal: Literal[Name]
    wanted: int
    candidates: Candidates
    met: tuple[int, ...] = ()

    @property
    def count(self) -> int:
        """How often it holds."""
        return sum(mask.bit_count() for mask in self.met)


@dataclass(frozen=True, slots=True)
class Progress:
    """A goal in a world: how often each of its literals holds. A value; `after` gives the next one.

    Examples:
        >>> goal = hearth.Goal.of(hearth.Literal.of("HOLDS", "agent", "milk"), hearth.Literal.of("CLOSED", "fridge"))
        >>> progress = hearth.Progress.start(goal, world).after(execution.final, execution.final.changes(world))
        >>> progress.counts, progress.satisfied
        ((1, 0), False)
    """

    goal: Goal
    watches: tuple[Watch, ...]

    @classmethod
    def start(cls, goal: Goal, world: World) -> Progress:
        """Look at the whole world once.

        Raises:
            HearthError: UNKNOWN_OBJECT, UNKNOWN_AGENT or SYNTAX: a literal names nothing of this home, or what no
                action changes.
        """
        watches = []
        for literal, wanted in goal:
            found = candidates(literal, world.home)
            _check(literal, found, world.home)
            watches.append(Watch(literal, wanted, found, found.met(world)))
        return cls(goal, tuple(watches))

    def after(self, world: World, change: Change) -> Progress:
        """The progress in a world that came of the last by a change; looks only at what the change names."""
        touched = _touched(change, world.home)
        if not touched:
            return self
        watches = tuple(_updated(watch, world, touched) for watch in self.watches)
        return Progress(self.goal, watches)

    @property
    def counts(self) -> tuple[int, ...]:
        """How often each literal holds, in the goal's order."""
        return tuple(watch.count for watch in self.watches)

    @property
    def satisfied(self) -> bool:
        """Whether every literal holds as often as is wanted."""
        return all(watch.count >= watch.wanted for watch in self.watches)

    def unmet(self) -> Goal:
        """What is still to be done: each literal with how many are missing."""
        missing = ((watch.literal, watch.wanted - watch.count) for watch in self.watches)
        return Goal(tuple((literal, number) for literal, number in missing if number > 0))


def _updated(watch: Watch, world: World, touched: Mapping[str, int]) -> Watch:
    name = watch.literal.name
    changed = touched.get(HANDS[0], 0) | touched.get(HANDS[1], 0) if name == HOLDS else touched.get(name, 0)
    if not changed:
        return watch
    met = watch.candidates.updated(watch.met, world, changed)
    return watch if met == watch.met else replace(watch, met=met)


def _touched(change: Change, home: Home) -> Mapping[str, int]:
    """The nodes that a change is about by relation or state; both ends of an edge."""
    found: defaultdict[str, int] = defaultdict(int)
    index = home.index
    for source, relation, target in (*change.added, *change.removed):
        found[relation] |= 1 << index[source] | 1 << index[target]
    for node, state in (*change.set_states, *change.cleared_states):
        found[state] |= 1 << index[node]
    return found


def _check(literal: Literal[Name], found: Candidates, home: Home) -> None:
    """Refuse a literal that no change could make hold, or about what the home and its knowledge do not have."""
    kind, known = ("state", STATE_ID.keys()) if len(literal.terms) == 1 else ("relation", _RELATIONS)
    if literal.name not in known:
        raise _fault(Code.SYNTAX, literal, f"{literal.name} is not a known {kind}")
    for term, nodes in zip(literal.terms, (found.subjects, found.targets), strict=False):
        if nodes or term == AGENT:
            continue
        if isinstance(term, int):
            raise _fault(Code.UNKNOWN_OBJECT, literal, f"the home has no node {term}")
        if term.startswith(f"{AGENT}:"):
            raise _fault(Code.UNKNOWN_AGENT, literal, f"the home has no {term}")
        if home.knowledge.object_class(term) is None:
            raise _fault(Code.UNKNOWN_OBJECT, literal, f"`{term}` is not a known class")


def _fault(code: Code, literal: Literal[Name], message: str) -> HearthError:
    return HearthError.of(code, f"goal {literal}: {message}")
