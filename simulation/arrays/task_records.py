"""A task as a record: the world in which it starts, its sets of nodes, and its goal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.literals import HOLDS
from hearth.schemas.vocabulary import EVERY_STATE_ID, STATES
from hearth.simulation.arrays.home_records import HomeShape, words
from hearth.simulation.arrays.kernels.goals import IS_HELD, IS_INSIDE, IS_ON
from hearth.simulation.arrays.kernels.set_words import INSIDE, NEXT_TO, ON, ROOM
from hearth.simulation.arrays.record_types import ADDED, MOST_LITERALS, Bucket, task_type
from hearth.simulation.goals import Progress, check
from hearth.simulation.literal_truth import candidates
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices, lowest, mask_of
from hearth.simulation.world.home import Home
from hearth.simulation.world.states import LYING, SITTING
from hearth.simulation.world.world import World

RELATIONS = {"ON": IS_ON, "INSIDE": IS_INSIDE, HOLDS: IS_HELD}
"""The relations of goals that kernels count."""

REMEDY = "Env, HomeEnv or TextHomes, which play it"


class Begin(NamedTuple):
    """The start of a task.

    Attributes:
        name: of the task, for messages.
        world: in which it starts.
        goal: its goal.
    """

    name: str
    world: World
    goal: Goal


def base_of(home: Home) -> Home:
    """Return the home whose record a task uses: without the nodes that the task adds, where they were just added."""
    if home.base is None or len(home) - len(home.base[0]) > ADDED or _differs(home, home.base[0]):
        return home
    return home.base[0]


def _differs(home: Home, base: Home) -> bool:
    """Return whether a home differs from its base in more than added nodes and their edges."""
    first = len(base)
    old = (1 << first) - 1
    touched = indices(home.base[1] & old) if home.base else iter(())
    return home.absent != base.absent or any(
        row[i] & old != before[i] for i in touched for row, before in zip(home.rows, base.rows, strict=True)
    )


def index_in_record(home: Home, shape: HomeShape, bucket: Bucket, i: int) -> int:
    """Return the index that a node of a task's home has in records."""
    first = len(shape.home)
    return i if i < first else bucket.first_added + i - first


def task_record(begin: Begin, number: int, shape: HomeShape, bucket: Bucket, sets: Sequence[str]) -> Any:
    """Return the record of a task in a home.

    Args:
        begin: its start.
        number: of its home's record.
        shape: its home.
        bucket: the sizes.
        sets: names of the sets that its record has.

    Raises:
        HearthError: BAD_ARGUMENT: its goal or its start is out of scope.
    """
    world = begin.world
    home, first = world.home, len(shape.home)
    record = np.zeros(1, task_type(bucket))[0]
    record["home"], record["agents"] = number, len(world.agents)
    record["agent"] = -1
    for k, agent in enumerate(world.agents):
        record["agent"][k] = index_in_record(home, shape, bucket, agent.index)
    for i in range(first, len(home)):
        record["added_limits"][i - first] = home.limit(i), home.limit(i, lying=True)
    for place, name in enumerate(sets):
        record["sets"][place] = words(_set(name, home, shape), first, bucket)
    _start(record, begin, shape, bucket)
    _goal(record, begin, first, bucket)
    return record


def _set(name: str, home: Home, shape: HomeShape) -> int:
    """Return a set of nodes by the name that tables of actions have."""
    kind, _, rest = name.partition("_")
    if kind == "able":
        action, _, position = rest.rpartition("_")
        return home.able(action, int(position))
    if kind == "property":
        return home.properties[rest]
    if name == "off_the_floor":
        here = ground_of(home)
        assert here is not None
        return here.elsewhere
    if name == "holders":
        return mask_of(i for i, base in enumerate(shape.home.bears) if base | shape.home.contents[i])
    if name == "movable":
        return mask_of(shape.movable) | home.everything & ~home.characters & -1 << len(shape.home)
    if name == "carriers":
        return _set("holders", home, shape) & mask_of(shape.movable)
    if name == "rests":
        known = home.knowledge
        return mask_of(i for action in known.group("rests") for i in indices(home.able(action)))
    if name == "seats":
        return edge_rows.seats(home)
    found: int = getattr(home, name)
    return found


def _start(record: Any, begin: Begin, shape: HomeShape, bucket: Bucket) -> None:
    """Fill the record of the world in which a task starts."""
    world, first = begin.world, len(shape.home)
    home, moved = world.home, begin.world.moved
    start = record["start"]
    if not moved.on == moved.inside == moved.close:
        raise _unfit(begin, "its start has single edges that came or went")
    lifted = moved.on | home.everything & ~home.characters & -1 << first
    for state in range(SITTING):
        start["states"][state] = words(world.states[state], first, bucket)
    start["lifted"], start["place"] = words(lifted, first, bucket), -1
    start["carried"] = words(moved.facing, first, bucket)
    slots = {i: number for number, i in enumerate(shape.movable)}
    fresh = _fresh(record, begin, first, bucket)
    for i in indices(lifted):
        slot = slots[i] if i in slots else bucket.movable + i - first if i >= first else None
        if slot is None:
            raise _unfit(begin, f"its start has moved {home.classes[i]} ({home.ids[i]}), which nobody can grab")
        start["place"][slot] = _place(begin, shape, bucket, i, fresh)
    _unmoved(begin, lifted)
    for number, agent in enumerate(world.agents):
        if agent.pose is None or agent.faced or agent.inside & ~home.rooms or agent.held & ~lifted:
            raise _unfit(begin, f"its agent {number} is not in a room, or holds a thing that it did not grab")
        start["pose"][number], start["stride"][number] = agent.pose, agent.stride
        start["room"][number] = lowest(agent.inside)
        for hand, thing in enumerate((agent.right, agent.left)):
            held = lowest(thing)
            start["hands"][number, hand] = -1 if held < 0 else index_in_record(home, shape, bucket, held)
        for row, edges in enumerate((agent.close, agent.facing, agent.on, agent.worn, agent.contents)):
            start["rows"][number, row] = words(edges, first, bucket)
        resting = [state for state in (SITTING, LYING) if world.states[state] & agent.bit]
        start["posture"][number] = resting[0] if resting else 0


def _fresh(record: Any, begin: Begin, first: int, bucket: Bucket) -> int:
    """Fill the CLOSE edges of added things, where some of them have several; return those that have not moved."""
    home = begin.world.home
    added = home.everything & ~home.characters & -1 << first & ~begin.world.moved.on
    if all(home.close[i].bit_count() < 2 for i in indices(added)):
        return 0
    for i in indices(added):
        record["added_close"][i - first] = words(home.close[i] & ~home.characters, first, bucket)
    record["start"]["fresh"] = np.uint64(added >> first)
    return added


def _place(begin: Begin, shape: HomeShape, bucket: Bucket, i: int, fresh: int) -> tuple[int, ...]:
    """Return the places of a moved or added thing: ON, in, its room, CLOSE to."""
    world = begin.world
    inside = edge_rows.inside(world, i)
    rows = {
        ON: edge_rows.on(world, i), INSIDE: inside & ~world.home.rooms, ROOM: inside & world.home.rooms,
        NEXT_TO: 0 if fresh >> i & 1 else edge_rows.close(world, i) & ~fresh,
    }  # fmt: skip
    turned = i >= len(shape.home) and world.home.facing[i] | world.home.faced[i]
    if any(row.bit_count() > 1 for row in rows.values()) or turned:
        raise _unfit(begin, f"its {world.home.classes[i]} ({world.home.ids[i]}) is at several places")
    return tuple(
        index_in_record(world.home, shape, bucket, lowest(rows[k])) if rows[k] else -1
        for k in (ON, INSIDE, ROOM, NEXT_TO)
    )


def _unmoved(begin: Begin, lifted: int) -> None:
    """Refuse a start in which a thing that did not move has new edges to another such thing."""
    for key, row in begin.world.moved.extra.items():
        if not lifted >> (key >> 3) & 1 and row & ~lifted:
            name = begin.world.home.classes[key >> 3]
            raise _unfit(begin, f"its start has new edges of {name} ({begin.world.home.ids[key >> 3]})")


def _goal(record: Any, begin: Begin, first: int, bucket: Bucket) -> None:
    """Fill the goal of a task."""
    home, goal = begin.world.home, begin.goal
    if goal.parts or len(goal.counts) > MOST_LITERALS or not goal.counts:
        what = "joins goals by words" if goal.parts else f"has {len(goal.counts)} literals of 1 to {MOST_LITERALS}"
        raise _unfit(begin, f"its goal {what}")
    record["literals"] = len(goal.counts)
    for k, (literal, wanted) in enumerate(goal):
        if fault := check(literal, home):
            raise HearthError.of(fault[1], f"task {begin.name}: goal {literal}: {fault[0]}", suggestion=fault[2])
        some = candidates(literal, home)
        things = some.subjects & ~home.characters
        state = len(literal.terms) == 1 and EVERY_STATE_ID.get(literal.name, len(STATES)) < len(STATES)
        related = len(literal.terms) > 1 and literal.name in RELATIONS and (some.by_target or literal.name != HOLDS)
        if not (state or related) or (not some.by_target and not state and things != some.subjects):
            raise _unfit(begin, f"its goal has {literal}, which is not about a state, ON, INSIDE or hands")
        record["kind"][k] = EVERY_STATE_ID[literal.name] if state else RELATIONS[literal.name]
        record["wanted"][k], record["negated"][k] = some.needed(wanted), literal.negated
        record["by_target"][k], record["rewarded"][k] = some.by_target, wanted
        record["subjects"][k] = words(some.subjects, first, bucket)
        record["targets"][k] = words(some.targets, first, bucket)
    progress = Progress.at(goal, begin.world)
    record["start"]["counts"][: len(goal.counts)] = progress.counts
    record["start"]["total"] = sum(
        min(found, wanted) for found, (_, wanted) in zip(progress.counts, goal.counts, strict=True)
    )
    record["start"]["met"] = progress.satisfied


def _unfit(begin: Begin, what: str) -> HearthError:
    return HearthError.of(Code.BAD_ARGUMENT, f"task {begin.name}: {what}, which arrays do not have", suggestion=REMEDY)
