"""How far a goal is reached, kept up to date by what changes (thesis 6.3, tables B.1 and C.2)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import reduce
from operator import or_

from hearth.schemas.errors import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal, Predicate
from hearth.schemas.vocabulary import RELATIONS, STATE_ID
from hearth.simulation import rows
from hearth.simulation.agent import Agent
from hearth.simulation.bits import indices
from hearth.simulation.change import Change
from hearth.simulation.home import Home
from hearth.simulation.world import World

HOLDS = "HOLDS"
"""Either hand: HOLDS_RH or HOLDS_LH."""

_HANDS = ("HOLDS_RH", "HOLDS_LH")


@dataclass(frozen=True, slots=True)
class _Watch:
    """A predicate over a home: which nodes may be its subject and its target, and which of them count now.

    What is counted are subjects; of a predicate about an agent, targets: `HOLDS(agent, book): 2` is two books.
    """

    predicate: Predicate
    wanted: int
    subjects: int
    targets: int
    by_target: bool
    met: int = 0

    @property
    def count(self) -> int:
        """How many things satisfy it."""
        return self.met.bit_count()


@dataclass(frozen=True, slots=True)
class Progress:
    """A goal in a world: which of its predicates are satisfied how often. A value; `after` gives the next one."""

    goal: Goal
    watches: tuple[_Watch, ...]

    @classmethod
    def start(cls, goal: Goal, world: World) -> Progress:
        """Look at the whole world once.

        Raises:
            HearthError: UNKNOWN_OBJECT or SYNTAX: a predicate names nothing of this home, or is none.
        """
        watches = []
        for predicate, wanted in goal:
            watch = _watch(predicate, wanted, world.home)
            candidates = watch.targets if watch.by_target else watch.subjects
            met = reduce(or_, (1 << i for i in indices(candidates) if _holds(watch, world, i)), 0)
            watches.append(replace(watch, met=met))
        return cls(goal, tuple(watches))

    def after(self, world: World, change: Change) -> Progress:
        """The progress in a world that came of the last by a change; looks only at what the change names."""
        touched = set(_touched(change, world.home))
        if not touched:
            return self
        watches = tuple(_updated(watch, world, touched) for watch in self.watches)
        return Progress(self.goal, watches)

    @property
    def counts(self) -> tuple[int, ...]:
        """How often each predicate is satisfied, in the goal's order."""
        return tuple(watch.count for watch in self.watches)

    @property
    def satisfied(self) -> bool:
        """Whether every predicate is satisfied as often as is wanted."""
        return all(watch.count >= watch.wanted for watch in self.watches)

    def unmet(self) -> Goal:
        """What is still to be done: each predicate with how many are missing."""
        missing = ((watch.predicate, watch.wanted - watch.count) for watch in self.watches)
        return Goal(tuple((predicate, number) for predicate, number in missing if number > 0))


def _updated(watch: _Watch, world: World, touched: set[tuple[str, int]]) -> _Watch:
    names = _HANDS if watch.predicate.name == HOLDS else (watch.predicate.name,)
    candidates = watch.targets if watch.by_target else watch.subjects
    met = watch.met
    for name, i in touched:
        if name in names and candidates >> i & 1:
            met = met | 1 << i if _holds(watch, world, i) else met & ~(1 << i)
    return watch if met == watch.met else replace(watch, met=met)


def _touched(change: Change, home: Home) -> Iterator[tuple[str, int]]:
    """(relation or state, node's index) of everything a change is about; both ends of an edge."""
    for edge in (*change.added, *change.removed):
        yield edge.relation, home.index[edge.source]
        yield edge.relation, home.index[edge.target]
    for node, state in (*change.set_states, *change.cleared_states):
        yield state, home.index[node]


def _watch(predicate: Predicate, wanted: int, home: Home) -> _Watch:
    subjects = _nodes(predicate, predicate.subject, home)
    if predicate.target is None:
        if predicate.name not in STATE_ID:
            raise _fault(Code.SYNTAX, predicate, f"{predicate.name} is no state")
        return _Watch(predicate, wanted, subjects, 0, by_target=False)
    if predicate.name not in (*RELATIONS, HOLDS):
        raise _fault(Code.SYNTAX, predicate, f"{predicate.name} is no relation")
    about_agent = isinstance(predicate.subject, str) and predicate.subject.startswith("agent")
    return _Watch(predicate, wanted, subjects, _nodes(predicate, predicate.target, home), by_target=about_agent)


def _nodes(predicate: Predicate, name: str | int, home: Home) -> int:
    """The nodes that a class, an id, `agent` or `agent:1` stands for."""
    if isinstance(name, int):
        if name not in home.index:
            raise _fault(Code.UNKNOWN_OBJECT, predicate, f"the home has no node {name}")
        return 1 << home.index[name]
    if name == "agent":
        return home.characters
    if name.startswith("agent:"):
        number = name.removeprefix("agent:")
        if not number.isdigit() or int(number) >= len(home.agents):
            raise _fault(Code.UNKNOWN_AGENT, predicate, f"the home has no {name}")
        return 1 << home.agents[int(number)]
    found = next((mask for other in home.knowledge.same_class(name) if (mask := home.by_class.get(other, 0))), 0)
    if not found and home.knowledge.object_class(name) is None:
        raise _fault(Code.UNKNOWN_OBJECT, predicate, f"`{name}` is no class")
    return found


def _fault(code: Code, predicate: Predicate, message: str) -> HearthError:
    return HearthError.of(code, f"goal {predicate}: {message}")


def _holds(watch: _Watch, world: World, i: int) -> bool:
    """Whether the thing i counts: as a target of some subject, or as a subject with some target."""
    name = watch.predicate.name
    if watch.predicate.target is None:
        return bool(world.states[STATE_ID[name]] >> i & 1)
    if watch.by_target:
        return any(_of_agent(agent, name) >> i & 1 for agent in world.agents if watch.subjects & agent.bit)
    return bool(_row(world, name, i) & watch.targets)


def _of_agent(agent: Agent, name: str) -> int:
    """What a character stands in a relation to."""
    return {
        "ON": agent.on,
        "INSIDE": agent.inside,
        "CLOSE": agent.close,
        "FACING": agent.facing,
        "HOLDS_RH": agent.right,
        "HOLDS_LH": agent.left,
        HOLDS: agent.held,
    }.get(name, 0)


def _row(world: World, name: str, i: int) -> int:
    """What a node stands in a relation to, characters included."""
    agent = next((a for a in world.agents if a.index == i), None)
    if agent is not None:
        return _of_agent(agent, name)
    if name == "BETWEEN":
        return world.home.between[i]
    read = {"ON": rows.on, "INSIDE": rows.inside, "CLOSE": rows.close, "FACING": rows.facing}.get(name)
    if read is None:
        return 0
    back = {"ON": "worn", "INSIDE": "contents", "CLOSE": "close", "FACING": "faced"}[name]
    return reduce(or_, (a.bit for a in world.agents if getattr(a, back) >> i & 1), read(world, i))
