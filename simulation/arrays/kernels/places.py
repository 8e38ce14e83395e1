"""Places of things: the supports, containers and rooms of nodes, and their points of the floor.

They read as `world.edge_rows` and `motion.positions` do: an edge of the home counts while neither end is lifted.
"""

from __future__ import annotations

import math

import numpy as np

from hearth.simulation.arrays.kernels.set_words import (
    CONTENTS,
    ELSEWHERE,
    INSIDE,
    ON,
    ROOM,
    has,
    kernel,
)


@kernel
def support(home, world, node):
    """Return what a thing is ON."""
    if has(world.lifted, node):
        return np.int64(world.place[home.slot[node], ON])
    found = np.int64(home.on[node])
    return np.int64(-1) if has(world.lifted, found) else found


@kernel
def container(home, world, node):
    """Return what a thing is in; a room, where it was put into one as into a box."""
    if has(world.lifted, node):
        return np.int64(world.place[home.slot[node], INSIDE])
    found = np.int64(home.inside[node])
    return np.int64(-1) if has(world.lifted, found) else found


@kernel
def agent_of(task, world, node):
    """Return the number of the agent that a node is, or -1."""
    for number in range(task.agents):
        if task.agent[number] == node:
            return number
    return -1


@kernel
def holder(task, world, node):
    """Return the number of the first agent that a node is or that holds it, or -1."""
    for number in range(task.agents):
        if task.agent[number] == node or world.hands[number, 0] == node or world.hands[number, 1] == node:
            return number
    return -1


@kernel
def room_of(home, task, world, node):
    """Return the room that a node is, or is in, directly or through its containers."""
    for _ in range(8):
        if home.room_number[node] >= 0:
            return node
        agent = agent_of(task, world, node)
        if agent >= 0:
            return np.int64(world.room[agent])
        if not has(world.lifted, node):
            return np.int64(home.room[node])
        slot = home.slot[node]
        room, outer = np.int64(world.place[slot, ROOM]), np.int64(world.place[slot, INSIDE])
        if outer >= 0 and home.room_number[outer] >= 0 and (room < 0 or outer < room):
            room = outer
        if room >= 0:
            return room
        if outer < 0:
            for number in range(task.agents):
                if has(world.rows[number, CONTENTS], node):
                    return np.int64(world.room[number])
            return np.int64(-1)
        node = outer
    return np.int64(-1)


@kernel
def displaced(home, task, world, node):
    """Return whether a node is elsewhere than when the floor was measured."""
    if not has(world.lifted, node):
        return has(task.sets[ELSEWHERE], node)
    slot = home.slot[node]
    inside, room = world.place[slot, INSIDE], world.place[slot, ROOM]
    if inside >= 0 and home.room_number[inside] >= 0:  # a room as a box; two rooms are never as measured
        if room >= 0 and room != inside:
            return True
        room, inside = inside, np.int16(-1)
    measured = home.measured[node]
    same = world.place[slot, ON] == measured[ON] and inside == measured[INSIDE] and room == measured[ROOM]
    return not same


@kernel
def standing(home, task, world, node):
    """Return the node that keeps its place, at which another is: itself, what it is on or in, or else its room."""
    for _ in range(8):
        if not displaced(home, task, world, node):
            return node
        on, inside = support(home, world, node), container(home, world, node)
        if on >= 0 and (home.room_number[on] >= 0 or on == node):
            on = np.int64(-1)
        if inside >= 0 and (home.room_number[inside] >= 0 or inside == node):
            inside = np.int64(-1)
        if on < 0 and inside < 0:
            break
        node = inside if on < 0 else on if inside < 0 else min(on, inside)
    return room_of(home, task, world, node)


@kernel
def spot(home, task, world, node):
    """Return whether a node's point of the floor is known, and the point."""
    agent = holder(task, world, node)
    if agent >= 0:
        return True, world.pose[agent, 0], world.pose[agent, 1]
    place = standing(home, task, world, node)
    if place < 0 or math.isnan(home.box[place, 0]):
        return False, 0.0, 0.0
    return True, home.box[place, 0], home.box[place, 1]
