"""Waste of an execution: things that were opened, moved, or left on or open, and that nothing needed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import reduce
from itertools import pairwise
from operator import or_

from hearth.schemas.goals import Goal
from hearth.simulation.goals import Progress
from hearth.simulation.lasting_changes import Lasting, left_among
from hearth.simulation.literal_truth import nodes
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.states import OPEN
from hearth.simulation.world.world import World

OPENED, MOVED = "OPENED", "MOVED"
"""Kinds of waste besides the states ON and OPEN in which things are left."""


def wasted_among(worlds: Sequence[World], goal: Goal | None = None) -> tuple[Lasting, ...]:
    """Return the waste of worlds that follow each other, in the order of steps; each thing once for each kind.

    - `ON`, `OPEN`: it was switched on or opened and is so at the end, and the goal does not ask for it.
    - `OPENED`: a container that was opened and closed again, and nothing was put in or taken out between.
    - `MOVED`: it was carried elsewhere, and the goal does not count it. A program without a goal wastes none of these:
      what it moves is all that is known of its purpose.

    Args:
        worlds: the first is the start.
        goal: what was to be reached; None where nothing is known of it.
    """
    needed = goal_nodes(goal, worlds[-1]) if goal is not None else 0
    index = worlds[0].home.index
    found = [each for each in left_among(worlds) if not needed >> index[each.thing] & 1]
    found += (each for each in _opened_in_vain(worlds) if not needed >> index[each.thing] & 1)
    if goal is not None:
        found += (each for each in _moved(worlds) if not needed >> index[each.thing] & 1)
    return tuple(sorted(found, key=lambda each: (each.step, each.thing, each.state)))


def goal_nodes(goal: Goal, last: World) -> int:
    """Return the nodes that a goal needs as they are in the last world.

    Of counted literals these are the nodes that count; of other goals, all that its literals are about.
    """
    progress = Progress.at(goal, last)
    if progress.watches or not goal.parts:
        return reduce(or_, (mask for watch in progress.watches for mask in watch.met), 0)
    terms = (term for literal, _, aims in goal.aims() if aims for term in literal.terms)
    return reduce(or_, (nodes(term, last.home) for term in terms), 0)


def _opened_in_vain(worlds: Sequence[World]) -> Iterator[Lasting]:
    """Yield the containers that were opened and closed again while nothing went in or out."""
    home = worlds[0].home
    boxes = home.properties["CONTAINERS"]
    since: dict[int, tuple[int, int]] = {}
    for step, (before, now) in enumerate(pairwise(worlds), 1):
        if before.states is now.states:
            continue
        was, is_now = before.states[OPEN] & boxes, now.states[OPEN] & boxes
        for i in indices(is_now & ~was):
            since[i] = (step, edge_rows.contents(before, i))
        for i in indices(was & ~is_now):
            opened, contents = since.pop(i, (0, 0))
            if opened and not _used(worlds[opened : step + 1], i, contents):
                yield Lasting(home.ids[i], home.classes[i], OPENED, opened)


def _used(worlds: Sequence[World], i: int, contents: int) -> bool:
    return any(edge_rows.contents(world, i) != contents for world in worlds)


def _moved(worlds: Sequence[World]) -> Iterator[Lasting]:
    """Yield the things that somebody carried and that are elsewhere at the end, with the step that let them go."""
    first, last = worlds[0], worlds[-1]
    carried = reduce(or_, (agent.held for world in worlds for agent in world.agents), 0)
    held = reduce(or_, (agent.held for agent in last.agents), 0)
    for i in indices(carried & ~held):
        if _place(first, i) != _place(last, i):
            step = max(k for k, world in enumerate(worlds) if any(agent.held >> i & 1 for agent in world.agents)) + 1
            yield Lasting(first.home.ids[i], first.home.classes[i], MOVED, step)


def _place(world: World, i: int) -> int:
    """Return the things that a thing lies on and in; its room where there are none."""
    places = edge_rows.on(world, i) | edge_rows.inside(world, i)
    return places & ~world.home.rooms or places
