"""Counts of a goal's literals, as `simulation.goals` counts them."""

from __future__ import annotations

import numpy as np

from hearth.simulation.arrays.kernels.places import agent_of, container, support
from hearth.simulation.arrays.kernels.set_words import (
    CONTENTS,
    NONE,
    ROOM,
    SEATS,
    WORN,
    bit,
    count,
    has,
    kernel,
    lowest,
)
from hearth.simulation.world.states import SITTING

STATE, IS_ON, IS_INSIDE, IS_HELD = 0, 16, 17, 18
"""Kinds of literals: a state's number, or a relation."""


@kernel
def count_goal(home, task, world):
    """Write how often each literal holds; return whether the goal is reached, and how many wanted counts hold."""
    reached, total = True, 0
    for k in range(task.literals):
        if task.by_target[k]:
            found = _of_agents(home, task, world, k)
        elif task.kind[k] < IS_ON:
            found = _in_state(task, world, k)
        else:
            found = _of_things(home, task, world, k)
        if task.negated[k]:
            found = task.wanted[k] - found  # wanted of all candidates, see `literal_truth.Candidates.needed`
        world.counts[k] = found
        total += min(found, np.int64(task.rewarded[k]))
        if found < task.wanted[k]:
            reached = False
    return reached, total


@kernel
def _in_state(task, world, k):
    """Count the subjects in a state."""
    kind, found = np.int64(task.kind[k]), 0
    for w in range(world.lifted.shape[0]):
        row = world.states[kind, w] if kind < SITTING else NONE
        for agent in range(task.agents):
            node = np.int64(task.agent[agent])
            if kind >= SITTING and np.int64(world.posture[agent]) == kind and node >> 6 == w:
                row |= bit(node)
        found += count(task.subjects[k, w] & row)
    return found


@kernel
def _of_agents(home, task, world, k):
    """Count, for each agent among the subjects, the targets of its edges."""
    kind, found = np.int64(task.kind[k]), 0
    for agent in range(task.agents):
        if not has(task.subjects[k], np.int64(task.agent[agent])):
            continue
        if kind == IS_ON:
            for w in range(world.lifted.shape[0]):
                found += count(world.rows[agent, SEATS, w] & task.targets[k, w])
        elif kind == IS_INSIDE:
            found += has(task.targets[k], np.int64(world.room[agent]))
        else:
            for hand in range(2):
                thing = np.int64(world.hands[agent, hand])
                if has(task.targets[k], thing) and (hand == 0 or thing != world.hands[agent, 0]):
                    found += 1
    return found


@kernel
def _of_things(home, task, world, k):
    """Count the things that are on or in one of the targets."""
    kind, found = np.int64(task.kind[k]), 0
    for w in range(world.lifted.shape[0]):
        rest = task.subjects[k, w]
        while rest:
            node = w * 64 + lowest(rest)
            rest &= rest - np.uint64(1)
            if agent_of(task, world, node) >= 0:
                continue
            if kind == IS_ON:
                holds = has(task.targets[k], support(home, world, node))
            else:
                holds = has(task.targets[k], container(home, world, node)) or has(
                    task.targets[k], _direct_room(home, world, node)
                )
            for agent in range(task.agents):
                if has(task.targets[k], np.int64(task.agent[agent])):
                    holds = holds or has(world.rows[agent, WORN if kind == IS_ON else CONTENTS], node)
            found += holds
    return found


@kernel
def _direct_room(home, world, node):
    """Return the room that a thing is directly INSIDE."""
    if has(world.lifted, node):
        return np.int64(world.place[home.slot[node], ROOM])
    return np.int64(home.room[node])
