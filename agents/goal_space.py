"""The possible goals of an agent, as arrays over the things of a home, for inference and helping."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.agents.belief import Place, place_of
from hearth.schemas.goals import Goal
from hearth.schemas.literals import HOLDS, Literal, Name
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.states import CLOSED
from hearth.simulation.world.world import World

Floats = NDArray[np.floating[Any]]
Numbers = NDArray[np.integer[Any]]
Flags = NDArray[np.bool_]


class Scene(NamedTuple):
    """An agent's knowledge of a home.

    Attributes:
        places: where each thing of a space is.
        closed: the set of closed nodes.
    """

    places: list[Place]
    closed: int


class Edge(NamedTuple):
    """An edge of the graph that an agent brings about.

    Attributes:
        relation: `ON` or `INSIDE` furniture; HOLDS for a thing that a character is to have; "" for taking a thing
            along, without knowing where to.
        thing: index of the thing that is carried.
        target: index of the furniture or character; -1 for taking it along.
    """

    relation: str
    thing: int
    target: int = -1


Counts = tuple[int, ...]
"""The number of things that a goal wants for each predicate of a space."""

Places = list[Place]
"""The place of each thing of a space."""


GoalsIn = Callable[[Home], Mapping[Goal, float]]
"""The goals that there may be in a home, naming its furniture by id, with their probabilities."""


@dataclass(frozen=True, eq=False)
class GoalSpace:
    """Goals over a home. G goals, P predicates `relation(class, furniture)`, T movable things that these count.

    Attributes:
        goals: all of them.
        prior: (G,) their probabilities.
        predicates: (P) the counted literals of goals, naming furniture of the home.
        targets: (P,) index of the furniture of each.
        counts: (G, P) how many are wanted.
        things: indices of the things.
        fits: (P, T) whether a thing counts for a predicate, once it is there.
    """

    goals: tuple[Goal, ...]
    prior: Floats
    predicates: tuple[Literal[Name], ...]
    targets: Numbers
    counts: Numbers
    things: tuple[int, ...]
    fits: Flags

    @classmethod
    def of(cls, goals: Mapping[Goal, float], home: Home) -> GoalSpace:
        """Return the goals of a home; literals about characters are left out."""
        places = {
            literal: home.index[literal.target]
            for goal in goals
            for literal, _ in goal
            if isinstance(literal.target, int) and isinstance(literal.subject, str) and ":" not in literal.subject
        }
        predicates = list(places)
        numbers = {literal: number for number, literal in enumerate(predicates)}
        counts = np.zeros((len(goals), len(predicates)), np.int32)
        for row, goal in enumerate(goals):
            for literal, wanted in goal:
                if literal in numbers:
                    counts[row, numbers[literal]] = wanted
        masks = [home.instances(str(literal.subject)) & home.properties["GRABBABLE"] for literal in predicates]
        every = 0
        for mask in masks:
            every |= mask
        things = tuple(indices(every))
        fits = np.array([[bool(mask >> thing & 1) for thing in things] for mask in masks], np.bool_)
        prior = np.array(list(goals.values()), np.float64)
        return cls(
            tuple(goals),
            prior / prior.sum(),
            tuple(predicates),
            np.array(list(places.values()), np.int64),
            counts,
            things,
            fits.reshape(len(predicates), len(things)),
        )

    @cached_property
    def relations(self) -> tuple[str, ...]:
        """Return the relation of each predicate."""
        return tuple(each.name for each in self.predicates)

    @cached_property
    def classes(self) -> tuple[str, ...]:
        """Return the classes of the things that each predicate counts."""
        return tuple(str(each.subject) for each in self.predicates)

    @cached_property
    def wanted(self) -> tuple[Counts, ...]:
        """Return (G) how many each goal wants of each predicate."""
        return tuple(map(tuple, self.counts.tolist()))

    def goal(self, counts: Counts) -> Goal:
        """Return the goal of some counts of predicates."""
        return Goal(tuple((each, count) for each, count in zip(self.predicates, counts, strict=True) if count))

    @cached_property
    def rows_of(self) -> tuple[tuple[int, ...], ...]:
        """Return (T) the predicates that each thing may count for."""
        return tuple(tuple(np.flatnonzero(column).tolist()) for column in self.fits.T)

    @cached_property
    def number(self) -> dict[int, int]:
        """Return the number of each thing, by its index."""
        return {thing: number for number, thing in enumerate(self.things)}

    @cached_property
    def row_at(self) -> dict[Edge, int]:
        """Return the predicate that each thing counts for at each place."""
        pairs = zip(self.things, self.rows_of, strict=True)
        return {Edge(self.relations[r], thing, int(self.targets[r])): r for thing, rows in pairs for r in rows}

    def counts_at(self, row: int, relation: str, node: int) -> bool:
        """Return whether a thing that fits a predicate counts for it in some place."""
        return bool(self.targets[row] == node) and self.relations[row] == relation

    def places(self, world: World) -> Places:
        """Return (T) the place of each thing now: the node it is on or in, its holder, or its room."""
        return [place_of(world, thing) for thing in self.things]

    def scene(self, world: World) -> Scene:
        """Return the scene of a whole world, for an observer that sees everything."""
        return Scene(self.places(world), world.states[CLOSED])

    def counted(self, places: Places) -> Flags:
        """Return (P, T) whether a thing counts for a predicate where it is."""
        inside = np.array([relation == "INSIDE" for relation, _ in places], np.bool_)
        nodes = np.array([-1 if relation == HOLDS else node for relation, node in places], np.int64)
        here: Flags = self.fits & (self.targets[:, None] == nodes) & (self._inside[:, None] == inside)
        return here

    @cached_property
    def _inside(self) -> Flags:
        """Return (P,) whether things are wanted in the furniture, not on it."""
        return np.array([relation == "INSIDE" for relation in self.relations], np.bool_)

    def missing(self, counted: Flags) -> Numbers:
        """Return (G, P) how many of each predicate a goal still lacks."""
        found: Numbers = np.maximum(0, self.counts - counted.sum(axis=1, dtype=np.int32))
        return found
