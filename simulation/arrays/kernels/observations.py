"""The arrays that an agent observes: legal numbers, nodes, places of things, and agents. Nothing unseen is in them."""

from __future__ import annotations

import math

import numpy as np

from hearth.simulation.arrays.kernels.places import container, support
from hearth.simulation.arrays.kernels.set_words import MOVABLE, NONE, bit, has, kernel, lowest
from hearth.simulation.arrays.mask_tracing import DYNAMIC
from hearth.simulation.world.states import LYING, SITTING

SPREAD = np.array([sum((byte >> k & 1) << 8 * k for k in range(8)) for byte in range(256)], np.uint64)
"""The bits of a byte, each in a byte of its own."""

AGENT_COLUMNS = (
    "seen", "x", "z", "sine", "cosine", "sitting", "lying", "right", "left", "room", "last", "done",
)  # fmt: skip
"""Columns of `agents`: position in metres, direction, posture; nodes in hands + 1; room + 1; the last number tried
and whether it was done. All are 0 of an agent that is not seen; only an agent itself knows its last number."""

_CLOSE = DYNAMIC.index("close")


@kernel
def _bytes_of(word, out, first):
    """Write the bits of a word as bytes, eight to a word."""
    if word == NONE:
        for k in range(8):
            out[first + k] = NONE
        return
    for k in range(8):
        out[first + k] = SPREAD[(word >> np.uint64(8 * k)) & np.uint64(255)]


@kernel
def observe(home, task, world, agent, keep, planes, registers, shown, i, limit):
    """Write the arrays of an agent of world `i` from the sets that `look` has left."""
    _, _, mask, nodes, places, agents, time = shown
    words = keep.shape[0]
    last = planes.shape[0] - 1
    _bytes_of(planes[last, 0], mask[i, agent], 0)
    for plane in range(last):
        for w in range(words):
            _bytes_of(planes[plane, w], mask[i, agent], 8 * (1 + plane * words + w))
    _nodes(task, world, agent, keep, registers[_CLOSE], nodes[i, agent])
    for slot in range(places.shape[2]):
        places[i, agent, slot] = 0
    for w in range(words):
        rest = keep[w] & task.sets[MOVABLE, w]
        while rest:
            node = w * 64 + lowest(rest)
            rest &= rest - np.uint64(1)
            place = support(home, world, node)
            if place < 0:
                place = container(home, world, node)
            places[i, agent, home.slot[node]] = place + 1
    for other in range(task.agents):
        _agent(home, task, world, agent, other, keep, agents[i, agent, other])
    time[i, agent] = np.float32(world.tick / limit)


@kernel
def _nodes(task, world, agent, keep, close, out):
    """Write a byte a node: seen, close, OPEN, CLOSED, ON, in one's hands, a subject of the goal, a target of it."""
    for w in range(keep.shape[0]):
        seen, held, subjects, targets = keep[w], NONE, NONE, NONE
        if seen == NONE:
            for k in range(8):
                out[w * 8 + k] = NONE
            continue
        for k in range(task.literals):
            subjects |= task.subjects[k, w]
            targets |= task.targets[k, w]
        for hand in range(2):
            thing = np.int64(world.hands[agent, hand])
            if thing >= 0 and thing >> 6 == w:
                held |= bit(thing)
        for k in range(8):
            shift, byte = np.uint64(8 * k), np.uint64(255)
            out[w * 8 + k] = (
                SPREAD[seen >> shift & byte]
                | SPREAD[(close[w] & seen) >> shift & byte] << np.uint64(1)
                | SPREAD[(world.states[1, w] & seen) >> shift & byte] << np.uint64(2)
                | SPREAD[(world.states[0, w] & seen) >> shift & byte] << np.uint64(3)
                | SPREAD[(world.states[3, w] & seen) >> shift & byte] << np.uint64(4)
                | SPREAD[held >> shift & byte] << np.uint64(5)
                | SPREAD[(subjects & seen) >> shift & byte] << np.uint64(6)
                | SPREAD[(targets & seen) >> shift & byte] << np.uint64(7)
            )


@kernel
def _agent(home, task, world, agent, other, keep, out):
    """Write the columns of an agent."""
    for k in range(out.shape[0]):
        out[k] = 0.0
    if not has(keep, np.int64(task.agent[other])):
        return
    yaw = world.pose[other, 2] * (math.pi / 180.0)
    out[0], out[1], out[2] = 1.0, world.pose[other, 0], world.pose[other, 1]
    out[3], out[4] = math.sin(yaw), math.cos(yaw)
    out[5], out[6] = world.posture[other] == SITTING, world.posture[other] == LYING
    out[7], out[8] = world.hands[other, 0] + 1, world.hands[other, 1] + 1
    room = np.int64(world.room[other])
    out[9] = home.room_number[room] + 1 if room >= 0 else 0
    if other == agent:
        out[10], out[11] = world.last[other, 0], world.last[other, 1]
