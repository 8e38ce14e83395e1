"""The goals of a challenge: listed, drawn, weighed, written and read (thesis tables B.1 and C.2).

A goal of a grammar names furniture as the thesis does, `ON(plate, dinnertable)`; `in_home` gives the goal that names
the home's instance of it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, pairwise, product
from random import Random

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.literals import AGENT, HOLDS, Literal, Name
from hearth.simulation.world.bits import lowest
from hearth.simulation.world.home import Home

Counts = tuple[tuple[str, int], ...]
"""Classes with how many things of each are wanted."""

TRIES = 1_000
"""Draws of several sets at once, until their predicates are few enough."""


@dataclass(frozen=True)
class GoalSet:
    """A kind of activity: the predicates that its goals are made of.

    Exactly one of `most`, `each` and `pool` gives the wanted things.

    Attributes:
        name: its identifier.
        title: its name in the thesis.
        asked: the instruction for people.
        relation: of things to the target.
        targets: classes of furniture; one of them is chosen.
        most: class -> most wanted of it; `total` things in all, every goal equally probable.
        each: classes, or choices of one, of which as many are wanted as there are `people`.
        pool: classes, of which `total` things are wanted in all; how many classes, which and how many of each are
            drawn one after the other.
        total: fewest and most things.
        people: fewest and most.
        always: wanted each time, once.
        free: of these, the literals that are not counted among a goal's predicates.
    """

    name: str
    title: str
    asked: str
    relation: str
    targets: tuple[str, ...]
    most: Mapping[str, int]
    each: tuple[tuple[str, ...], ...]
    pool: tuple[str, ...]
    total: tuple[int, int]
    people: tuple[int, int]
    always: tuple[Literal[Name], ...] = ()
    free: tuple[Literal[Name], ...] = ()

    @cached_property
    def classes(self) -> tuple[str, ...]:
        """Return the classes of things that its goals count, but not those of `always`."""
        return (*self.most, *self.pool, *(name for choice in self.each for name in choice))

    @cached_property
    def predicates(self) -> tuple[Literal[Name], ...]:
        """Return every predicate of its goals."""
        pairs = product(self.classes, self.targets)
        return (*self.always, *(Literal.of(self.relation, name, target) for name, target in pairs))

    @cached_property
    def goals(self) -> Mapping[Goal, float]:
        """Return its goals with their probabilities, which sum to 1, in a fixed order."""
        wanted = dict(self._wanted())
        share = 1 / (sum(wanted.values()) * len(self.targets))
        always = tuple((literal, 1) for literal in self.always)
        return {
            Goal((*always, *((Literal.of(self.relation, name, target), n) for name, n in counts))): weight * share
            for target in self.targets
            for counts, weight in wanted.items()
        }

    @cached_property
    def most_of(self) -> Mapping[str, int]:
        """Class -> most things of it in a goal, those of `always` too."""
        found: dict[str, int] = {}
        for goal in self.goals:
            for name, number in wanted_things(goal).items():
                found[name] = max(found.get(name, 0), number)
        return {name: number for name, number in found.items() if name not in self.furniture}

    @cached_property
    def furniture(self) -> frozenset[str]:
        """Return the furniture that its predicates name."""
        named = {str(literal.target) for literal in self.always if literal.name != HOLDS}
        return frozenset({*self.targets, *named})

    def _wanted(self) -> Iterator[tuple[Counts, float]]:
        if self.most:
            numbers = product(*(range(most + 1) for most in self.most.values()))
            lists = (tuple((name, n) for name, n in zip(self.most, each, strict=True) if n) for each in numbers)
            yield from ((counts, 1.0) for counts in lists if self.total[0] <= _sum(counts) <= self.total[1])
        for people in range(self.people[0], self.people[1] + 1) if self.each else ():
            yield from ((tuple((name, people) for name in names), 1.0) for names in product(*self.each))
        for total in range(self.total[0], self.total[1] + 1) if self.pool else ():
            yield from _of_pool(self.pool, total)


def _of_pool(pool: tuple[str, ...], total: int) -> Iterator[tuple[Counts, float]]:
    """Yield the multisets of a size: the number of classes is uniform, then which, then how many of each."""
    kinds = range(1, min(len(pool), total) + 1)
    for number in kinds:
        ways = math.comb(len(pool), number) * math.comb(total - 1, number - 1)
        for names in combinations(pool, number):
            for cuts in combinations(range(1, total), number - 1):
                edges = (0, *cuts, total)
                counts = tuple(after - before for before, after in pairwise(edges))
                yield tuple(zip(names, counts, strict=True)), 1 / (len(kinds) * ways)


def _sum(counts: Counts) -> int:
    return sum(number for _, number in counts)


def _is_agent(term: Name | None) -> bool:
    return isinstance(term, str) and (term == AGENT or term.startswith(f"{AGENT}:"))


def _thing(literal: Literal[Name]) -> str:
    return str(literal.target if _is_agent(literal.subject) else literal.subject)


def wanted_things(goal: Goal) -> dict[str, int]:
    """Class -> how many things of it a goal counts in all; furniture that a character uses counts as such, too."""
    found: dict[str, int] = {}
    for literal, number in goal:
        found[_thing(literal)] = found.get(_thing(literal), 0) + number
    return found


@dataclass(frozen=True)
class Grammar:
    """The goals of a challenge.

    Attributes:
        sets: by name.
        most_predicates: of a goal made of several sets.
    """

    sets: Mapping[str, GoalSet]
    most_predicates: int

    @cached_property
    def predicates(self) -> tuple[Literal[Name], ...]:
        """Return every predicate of any goal, each once, in a fixed order: 30 of Watch-And-Help."""
        return tuple(dict.fromkeys(each for one in self.sets.values() for each in one.predicates))

    @cached_property
    def goals(self) -> Mapping[Goal, float]:
        """Return every goal of a single set with its probability, all sets being equally probable.

        1,123 of Watch-And-Help, 661 of Online Watch-And-Help.
        """
        found: dict[Goal, float] = {}
        for one in self.sets.values():
            for goal, probability in one.goals.items():
                found[goal] = found.get(goal, 0.0) + probability / len(self.sets)
        return found

    @cached_property
    def most_of(self) -> Mapping[str, int]:
        """Class -> most things of it in a goal of one set."""
        found: dict[str, int] = {}
        for one in self.sets.values():
            for name, number in one.most_of.items():
                found[name] = max(found.get(name, 0), number)
        return found

    @cached_property
    def furniture(self) -> frozenset[str]:
        """Return all furniture that predicates name; a task's home has all of it."""
        return frozenset(name for one in self.sets.values() for name in one.furniture)

    @cached_property
    def names(self) -> frozenset[str]:
        """Return every name of a class in its predicates."""
        terms = (term for literal in self.predicates for term in literal.terms)
        return frozenset(term for term in terms if isinstance(term, str) and not _is_agent(term))

    @cached_property
    def _free(self) -> frozenset[Literal[Name]]:
        return frozenset(literal for one in self.sets.values() for literal in one.free)

    @cached_property
    def _by_text(self) -> dict[str, Literal[Name]]:
        return {_squeezed(str(literal)): literal for literal in self.predicates}

    def sample(self, chooser: Random, sets: int = 1) -> tuple[Goal, tuple[str, ...]]:
        """Return a goal of some sets, and their names; errors as of `sample_of`."""
        some = tuple(chooser.choice(list(combinations(self.sets, sets)) or [()]))
        return self.sample_of(some, chooser), some

    def sample_of(self, sets: Sequence[str], chooser: Random) -> Goal:
        """Return a goal of some sets at once, drawn anew until it has few enough predicates.

        Raises:
            HearthError: BAD_ARGUMENT: there are no sets, or all goals drawn are too large.
        """
        for _ in range(TRIES if sets else 0):
            goal = self.joined(self._one(name, chooser) for name in sets)
            if self.size(goal) <= self.most_predicates:
                return goal
        raise HearthError.of(Code.BAD_ARGUMENT, f"no goal of {len(sets)} sets has {self.most_predicates} predicates")

    def _one(self, name: str, chooser: Random) -> Goal:
        goals = self.sets[name].goals
        return chooser.choices(tuple(goals), tuple(goals.values()))[0]

    def joined(self, goals: Iterator[Goal]) -> Goal:
        """Return all of these goals at once."""
        found: dict[Literal[Name], int] = {}
        for goal in goals:
            for literal, number in goal:
                found[literal] = found.get(literal, 0) + number
        return Goal(tuple(found.items()))

    def size(self, goal: Goal) -> int:
        """Return how many predicates a goal has, with their counts."""
        return sum(number for literal, number in goal if literal not in self._free)

    def prior(self, goal: Goal) -> float:
        """Return the probability of a goal of a single set; 0 of any other."""
        return self.goals.get(goal, 0.0)

    def counts(self, goal: Goal) -> tuple[int, ...]:
        """Return how often each of `predicates` is wanted: the output of goal inference (appendix B.3.1)."""
        wanted = dict(goal)
        return tuple(wanted.get(literal, 0) for literal in self.predicates)

    def written(self, goal: Goal) -> dict[str, int]:
        """Return a goal as data: its predicates' texts with their counts."""
        return {str(literal): number for literal, number in goal}

    def read(self, given: Mapping[str, int] | str) -> Goal:
        """Invert `written`; also read text, `ON(plate, dinnertable): 2 and INSIDE(wine, fridge)`.

        Names may be as in the thesis: `IN`, `HOLD(Alice, book)`, `SIT(Alice, sofa)`; `;` and `,` may stand for `and`.

        Raises:
            HearthError: SYNTAX; UNKNOWN_OBJECT for a literal that is not a predicate of the grammar.
        """
        pairs = list(given.items()) if isinstance(given, Mapping) else _pairs(given)
        found: dict[Literal[Name], int] = {}
        for text, number in pairs:
            literal = self._by_text.get(_squeezed(text) if isinstance(text, str) else "")
            if literal is None or literal in found:
                message = f"`{str(text)[:60]}` is {'repeated' if literal else 'not a predicate of the challenge'}"
                raise HearthError.of(Code.UNKNOWN_OBJECT, message, suggestion=f"as in `{self.predicates[0]}`")
            if not isinstance(number, int) or isinstance(number, bool) or not 0 < number <= self.most_predicates:
                message = f"`{text}` is wanted {str(number)[:20]} times"
                raise HearthError.of(Code.SYNTAX, message, suggestion=f"a number from 1 to {self.most_predicates}")
            found[literal] = number
        if not found:
            raise HearthError.of(Code.SYNTAX, "a goal without predicates")
        return Goal(tuple((literal, found[literal]) for literal in self.predicates if literal in found))

    def in_home(self, goal: Goal, home: Home) -> Goal:
        """Return the goal that names the home's instances of furniture (the first by id), and things by their classes.

        Raises:
            HearthError: UNKNOWN_OBJECT: the home lacks furniture.
        """
        return Goal(tuple((literal._replace(terms=self._terms(literal, home)), number) for literal, number in goal))

    def _terms(self, literal: Literal[Name], home: Home) -> tuple[Name, ...]:
        return tuple(instance(str(term), home) if term in self.furniture else term for term in literal.terms)


_OTHER_NAMES = {"in": "inside", "hold": "holds", "alice": f"{AGENT}:0"}
_PAIR = re.compile(r"\s*(\w+\s*\([^()]*\))\s*(?::\s*(\d{1,3}))?\s*(?:and\b|;|,|$)", re.IGNORECASE)


def _squeezed(text: str) -> str:
    """Return a predicate's text in one spelling."""
    words = [_OTHER_NAMES.get(word, word) for word in re.findall(r"[\w:]+", text.lower())]
    return " ".join(["on", *words[1:]] if words[:1] == ["sit"] else words)


def _pairs(text: str) -> list[tuple[str, int]]:
    found, place = [], 0
    while place < len(text):
        match = _PAIR.match(text, place)
        if match is None:
            message = f"expected a predicate but found `{text[place : place + 20]}`"
            raise HearthError.of(Code.SYNTAX, message, suggestion="as in `ON(plate, dinnertable): 2 and ...`")
        found.append((match[1], int(match[2] or 1)))
        place = match.end()
    return found


def instance(name: str, home: Home) -> int:
    """Id of a home's first instance of some furniture.

    Raises:
        HearthError: UNKNOWN_OBJECT: there is none.
    """
    mask = home.instances(name)
    if not mask:
        raise HearthError.of(Code.UNKNOWN_OBJECT, f"the home {home.name} has no {name}")
    return home.ids[lowest(mask)]
