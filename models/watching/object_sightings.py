"""A demonstration as states show it: where each thing that goals are about was seen, one place after the other.

Only things in the watcher's view count. The watcher goes where the character goes, and sees the things in its room that
are not inside a closed container. Instructions and failures are never read.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from hearth.schemas.literals import AGENT, HOLDS, Literal, Name
from hearth.simulation.env import Tick
from hearth.simulation.literal_truth import nodes
from hearth.simulation.observation import containment, visible_nodes
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

Predicate = Literal[Name]

Site = Callable[[World, Agent], int]
"""The nodes that are at a place."""

ELSEWHERE, HELD = 0, 1
"""Places that are not of predicates."""


class Seen(NamedTuple):
    """A thing that was seen to change its place.

    Attributes:
        kind: index of its class among those that predicates count.
        places: where it was seen, in order, each other than the one before: `ELSEWHERE`, `HELD`, or 2 and more for the
            places of predicates.
        times: when, from 0 at the start to 1 at the end.
    """

    kind: int
    places: tuple[int, ...]
    times: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Layout:
    """The terms of predicates, independent of the home.

    Attributes:
        kinds: number of classes of things.
        places: number of places, with `ELSEWHERE` and `HELD`.
        cells: kind and place of each predicate.
    """

    kinds: int
    places: int
    cells: tuple[tuple[int, int], ...]

    @classmethod
    def of(cls, predicates: Sequence[Predicate]) -> Layout:
        """Return the layout of predicates with names, as a grammar writes them, or with nodes: both are equal."""
        kinds: dict[Name | None, int] = {}
        places: dict[tuple[str, Name | None], int] = {}
        cells = []
        for each in predicates:
            thing, place = _parts(each)
            at = HELD if each.name == HOLDS else places.setdefault(place, len(places) + 2)
            cells.append((kinds.setdefault(thing, len(kinds)), at))
        return cls(len(kinds), len(places) + 2, tuple(cells))


def _parts(predicate: Predicate) -> tuple[Name | None, tuple[str, Name | None]]:
    """Return the thing that a predicate counts, and its place; of a character's, the thing that it holds or uses."""
    subject, target = predicate.subject, predicate.target
    return (target, (predicate.name, subject)) if _mine(predicate) else (subject, (predicate.name, target))


def _mine(predicate: Predicate) -> bool:
    """Return whether a predicate is about a thing that a character holds or uses."""
    subject = predicate.subject
    return isinstance(subject, str) and subject.partition(":")[0] == AGENT


def sightings(ticks: Sequence[Tick], predicates: Sequence[Predicate], agent: int = 0) -> tuple[Seen, ...]:
    """Return the things that were seen to change their places while a character acted, in the order of their nodes.

    Args:
        ticks: of a demonstration.
        predicates: with the nodes of furniture of its home.
        agent: the character; the watcher stands next to it.

    Returns:
        Of each thing its kind and its places (see `Layout`).
    """
    if not ticks:
        return ()
    home = ticks[0].before.home
    kinds, sites = _kinds(predicates, home), _sites(predicates, home)
    things = sum(kinds)
    known = [0] * len(sites)
    found: dict[int, list[tuple[int, float]]] = {}
    for number, world in enumerate((ticks[0].before, *(tick.world for tick in ticks))):
        me = world.agents[agent]
        rest = seen = visible_nodes.visible(world, me) & things
        for place in reversed(range(len(sites))):
            here = sites[place](world, me) & rest
            rest &= ~here
            for i in indices(here & ~known[place]):
                found.setdefault(i, []).append((place, number / len(ticks)))
            known[place] = known[place] & ~seen | here
    moved = {i: events for i, events in sorted(found.items()) if len(events) > 1}
    which = {i: kind for kind, mask in enumerate(kinds) for i in indices(mask)}
    return tuple(Seen(which[i], *zip(*events, strict=True)) for i, events in moved.items())


def _kinds(predicates: Sequence[Predicate], home: Home) -> list[int]:
    """Return the nodes of each kind."""
    found: dict[Name | None, int] = {}
    for each in predicates:
        thing = _parts(each)[0]
        found[thing] = 0 if thing is None else nodes(thing, home)
    return list(found.values())


def _sites(predicates: Sequence[Predicate], home: Home) -> list[Site]:
    """Return for each place a function that gives the nodes at that place."""
    found: dict[tuple[str, Name | None], Site] = {}
    for each in predicates:
        if each.name != HOLDS:
            site = _used if _mine(each) else _site(each.name, nodes(each.terms[1], home))
            found.setdefault(_parts(each)[1], site)
    return [lambda world, me: -1, lambda world, me: me.held, *found.values()]


def _used(world: World, me: Agent) -> int:
    return me.on


def _site(relation: str, targets: int) -> Site:
    at = containment.upon if relation == "ON" else containment.contained
    return lambda world, me: at(world, targets)
