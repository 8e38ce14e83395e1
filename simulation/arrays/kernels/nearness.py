"""The nodes that an agent is close to, and those that it comes close to where it walks.

They read as `observation.reach` and `motion.positions` do. CLOSE differs from distance: an agent's row stays as it is
until the agent walks.
"""

from __future__ import annotations

import numpy as np

from hearth.homes.plans.walkable_floor import REACH
from hearth.simulation.arrays.kernels.floor_moves import cell_at
from hearth.simulation.arrays.kernels.places import agent_of, container, displaced
from hearth.simulation.arrays.kernels.set_words import (
    CLOSE,
    CONTENTS,
    ELSEWHERE,
    EVERYTHING,
    NEXT_TO,
    NONE,
    ON,
    SEATS,
    SURFACES,
    WORN,
    bit,
    has,
    hypot,
    kernel,
    lowest,
    put,
    take,
)
from hearth.simulation.motion.navigation import BODY_RADIUS

MEETING = REACH + BODY_RADIUS
"""Metres within which two agents in one room are close."""


@kernel
def close_to(home, task, world, agent, keep, first, last, out):
    """Write the nodes of some words to which an agent is close, directly or by one hop; `keep` shows other agents."""
    mine = world.rows[agent, CLOSE]
    base = home.close.shape[0]
    for w in range(first, last):
        out[w] = mine[w] & keep[w]
    for v in range(mine.shape[0]):
        rest = mine[v] & keep[v] & ~world.lifted[v]
        while rest:
            node = v * 64 + lowest(rest)
            rest &= rest - np.uint64(1)
            if node < base:
                for w in range(first, last):
                    out[w] |= (home.close[node, w] | home.bears[node, w]) & ~world.lifted[w]
    for v in range(mine.shape[0]):
        rest = world.lifted[v]
        while rest:
            node = v * 64 + lowest(rest)
            rest &= rest - np.uint64(1)
            place = world.place[home.slot[node]]
            on, beside = np.int64(place[ON]), np.int64(place[NEXT_TO])
            if first <= v < last and (_near(mine, keep, on) or _near(mine, keep, beside)):
                put(out, node)
            if beside >= 0 and first <= beside >> 6 < last and _near(mine, keep, node):
                put(out, beside)
    _add_fresh(task, world, mine, keep, first, last, out)
    for other in range(task.agents):
        node = np.int64(task.agent[other])
        if not has(keep, node):
            continue
        meets = False
        for w in range(mine.shape[0]):
            if mine[w] & keep[w] & (world.rows[other, CLOSE, w] | world.rows[other, SEATS, w]):
                meets = True
        if has(mine, node):
            for w in range(first, last):
                out[w] |= (world.rows[other, CLOSE, w] | world.rows[other, WORN, w]) & keep[w]
        if meets and first <= node >> 6 < last:
            put(out, node)


@kernel
def _near(mine, keep, node):
    """Return whether a node is in an agent's row and shown; agents' edges to others are no hops for things."""
    return node >= 0 and (mine[node >> 6] & keep[node >> 6] & bit(node)) != 0


@kernel
def fresh_row(task, world, k, w):
    """Return a word of the things to which an added thing is CLOSE, while it is where it was at the start."""
    last = world.lifted.shape[0] - 1
    return task.added_close[k, w] & (world.fresh if w == last else ~world.lifted[w])


@kernel
def _add_fresh(task, world, mine, keep, first, last, out):
    """Add the hops over added things that are where they were at the start."""
    base = 64 * (world.lifted.shape[0] - 1)
    rest = world.fresh
    while rest:
        k = lowest(rest)
        rest &= rest - np.uint64(1)
        hop, meets = _near(mine, keep, base + k), False
        for w in range(mine.shape[0]):
            row = fresh_row(task, world, k, w)
            meets = meets or (mine[w] & keep[w] & row) != 0
            if hop and first <= w < last:
                out[w] |= row
        if meets and first <= (base + k) >> 6 < last:
            put(out, base + k)


@kernel
def near_point(home, task, world, agent, x, z, out):
    """Write the things and agents within reach of a point; return the room that the point is in, or -1."""
    words = world.lifted.shape[0]
    cell = cell_at(home, x, z)
    room = np.int64(-1) if cell < 0 else np.int64(home.cell_room[cell])
    for w in range(words):
        out[w] = NONE
    if cell >= 0:
        for w in range(words):
            here = home.near[cell, w] & task.sets[EVERYTHING, w] & ~(task.sets[ELSEWHERE, w] & ~world.lifted[w])
            rest = here & world.lifted[w]
            while rest:
                node = w * 64 + lowest(rest)
                rest &= rest - np.uint64(1)
                if displaced(home, task, world, node):
                    here &= ~bit(node)
            out[w] = here
        for other in range(task.agents):
            for hand in range(2):
                if world.hands[other, hand] >= 0:
                    take(out, np.int64(world.hands[other, hand]))
    for other in range(task.agents):
        if other != agent and room >= 0 and world.room[other] == room:
            if hypot(world.pose[other, 0] - x, world.pose[other, 1] - z) <= MEETING:
                put(out, np.int64(task.agent[other]))
    return room


@kernel
def add_arrival(home, task, world, node, out):
    """Add the nodes to which a walk to a node brings an agent: it, its container, things on it, agents at it."""
    put(out, node)
    if agent_of(task, world, node) >= 0:
        return
    inside = container(home, world, node)
    if inside >= 0 and home.room_number[inside] < 0:
        put(out, inside)
    surface = has(task.sets[SURFACES], node)
    if surface:
        if node < home.bears.shape[0] and not has(world.lifted, node):
            for w in range(out.shape[0]):
                out[w] |= home.bears[node, w] & ~world.lifted[w]
        for w in range(out.shape[0]):
            rest = world.lifted[w]
            while rest:
                other = w * 64 + lowest(rest)
                rest &= rest - np.uint64(1)
                if world.place[home.slot[other], ON] == node:
                    put(out, other)
    for number in range(task.agents):
        if has(world.rows[number, CONTENTS], node) or (surface and has(world.rows[number, SEATS], node)):
            put(out, np.int64(task.agent[number]))
