"""The nodes that an agent sees, and those inside closed containers, as `observation.visible_nodes` has them."""

from __future__ import annotations

import numpy as np

from hearth.simulation.arrays.kernels.places import agent_of
from hearth.simulation.arrays.kernels.set_words import (
    CARRIERS,
    CONTENTS,
    HOLDERS,
    INSIDE,
    NONE,
    ON,
    ROOM,
    ROOMS,
    SEATS,
    WORN,
    bit,
    has,
    kernel,
    lowest,
    put,
)


@kernel
def hidden(home, task, world, keep, out):
    """Write the things directly in something closed other than a room, as far as `keep` shows that it is closed."""
    words = world.lifted.shape[0]
    base = home.contents.shape[0]
    for w in range(words):
        out[w] = NONE
    for w in range(words):
        rest = world.states[0, w] & keep[w] & task.sets[HOLDERS, w] & ~task.sets[ROOMS, w] & ~world.lifted[w]
        while rest:
            node = w * 64 + lowest(rest)
            rest &= rest - np.uint64(1)
            if node < base:
                for v in range(words):
                    out[v] |= home.contents[node, v]
    for w in range(words):
        out[w] &= ~world.lifted[w]
        rest = world.lifted[w]
        while rest:
            node = w * 64 + lowest(rest)
            rest &= rest - np.uint64(1)
            inside = np.int64(world.place[home.slot[node], INSIDE])
            if inside >= 0 and home.room_number[inside] < 0 and has(world.states[0], inside) and has(keep, inside):
                put(out, node)


@kernel
def _spread(home, task, world, found, frontier):
    """Add everything in or on the frontier, directly or not; `frontier` is used up."""
    words = world.lifted.shape[0]
    base = home.contents.shape[0]
    growing = True
    while growing:
        growing = False
        for w in range(words):  # things that stand as at the start
            rest = frontier[w] & task.sets[HOLDERS, w] & ~world.lifted[w]
            while rest:
                node = w * 64 + lowest(rest)
                rest &= rest - np.uint64(1)
                if node < base:
                    for v in range(words):
                        more = (home.bears[node, v] | home.contents[node, v]) & ~world.lifted[v] & ~found[v]
                        if more:
                            found[v] |= more
                            frontier[v] |= more
                            growing = True
                frontier[w] &= ~bit(node)
        if _spread_lifted(home, world, found, frontier) or _spread_agents(task, world, found, frontier):
            growing = True


@kernel
def _spread_lifted(home, world, found, frontier):
    """Add lifted things that are on or in a found one; return whether others may be on or in these."""
    grown, nested = False, False
    for w in range(found.shape[0]):
        rest = world.lifted[w] & ~found[w]
        while rest:
            node = w * 64 + lowest(rest)
            rest &= rest - np.uint64(1)
            place = world.place[home.slot[node]]
            on, inside = np.int64(place[ON]), np.int64(place[INSIDE])
            nested = nested or has(world.lifted, on) or has(world.lifted, inside)
            if has(found, on) or has(found, inside) or has(found, np.int64(place[ROOM])):
                put(found, node)
                put(frontier, node)
                grown = True
    return grown and nested


@kernel
def _spread_agents(task, world, found, frontier):
    """Add agents in a found room or on a found seat, and their things; return whether there were any."""
    grown = False
    for number in range(task.agents):
        node = np.int64(task.agent[number])
        if not has(found, node):
            at = has(found, np.int64(world.room[number]))
            for w in range(found.shape[0]):
                if world.rows[number, SEATS, w] & found[w]:
                    at = True
            if at:
                put(found, node)
                grown = True
        if has(found, node):
            for w in range(found.shape[0]):
                more = (world.rows[number, WORN, w] | world.rows[number, CONTENTS, w]) & ~found[w]
                if more:
                    found[w] |= more
                    frontier[w] |= more
                    grown = True
    return grown


@kernel
def _in_room(home, task, world, room, found, frontier):
    """Write the room and everything in it, directly or not, and on that."""
    words = world.lifted.shape[0]
    carried = False
    for w in range(words):
        if world.lifted[w] & task.sets[CARRIERS, w]:
            carried = True
    for w in range(words):
        found[w] = NONE if carried else home.room_nodes[home.room_number[room], w] & ~world.lifted[w]
        frontier[w] = NONE
    put(found, room)
    if carried:  # what stood on something lifted may stand nowhere now, so the room is searched
        put(frontier, room)
    _spread(home, task, world, found, frontier)


@kernel
def visible(home, task, world, agent, out, inner, scratch):
    """Write the nodes that an agent sees into `out`, and the things directly in something closed into `inner`."""
    words = world.lifted.shape[0]
    frontier, unseen = scratch[0], scratch[1]
    for w in range(words):
        out[w] = ~NONE
    hidden(home, task, world, out, inner)
    room = np.int64(world.room[agent])
    for w in range(words):
        out[w] = NONE
    if room >= 0:
        for w in range(words):
            unseen[w] = inner[w]
            frontier[w] = inner[w]
        _spread(home, task, world, unseen, frontier)
        _in_room(home, task, world, room, out, frontier)
        for w in range(words):
            out[w] = (out[w] | home.room_doors[home.room_number[room], w]) & ~unseen[w]
    put(out, np.int64(task.agent[agent]))
    for w in range(words):
        out[w] |= task.sets[ROOMS, w]
    for other in range(task.agents):
        if has(out, np.int64(task.agent[other])):
            for hand in range(2):
                if world.hands[other, hand] >= 0:
                    put(out, np.int64(world.hands[other, hand]))
            for w in range(words):
                out[w] |= world.rows[other, WORN, w]


@kernel
def hidden_one(home, task, world, node):
    """Return whether a node is directly in something closed other than a room."""
    if agent_of(task, world, node) >= 0:
        return False
    if has(world.lifted, node):
        inside = np.int64(world.place[home.slot[node], INSIDE])
    else:
        inside = np.int64(home.inside[node])
        if has(world.lifted, inside):
            return False
    return inside >= 0 and home.room_number[inside] < 0 and has(world.states[0], inside)
