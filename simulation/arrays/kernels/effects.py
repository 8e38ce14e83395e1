"""The effects of actions that literals do not say: grabbing, putting, resting, rising, turning and walking.

Each follows its record in `simulation.actions`; the tests of exactness hold the two together.
"""

from __future__ import annotations

import math

import numpy as np

from hearth.simulation.arrays.instruction_table import PUT_ON
from hearth.simulation.arrays.kernels.floor_moves import ahead, destination, stepped, target_of, turned_to
from hearth.simulation.arrays.kernels.nearness import add_arrival, fresh_row, near_point
from hearth.simulation.arrays.kernels.places import agent_of, container, spot, support
from hearth.simulation.arrays.kernels.set_words import (
    CLOSE,
    CONTENTS,
    FACING,
    FURNITURE,
    INSIDE,
    LEFT,
    NEXT_TO,
    NONE,
    ON,
    ROOM,
    SEATS,
    WORN,
    bit,
    has,
    hypot,
    kernel,
    lowest,
    put,
    take,
)
from hearth.simulation.world.states import SITTING


@kernel
def become(world, state, node):
    """Let a thing enter a state and leave the opposite: `Becomes`."""
    put(world.states[state], node)
    take(world.states[state ^ 1], node)


@kernel
def meet(task, world, agent):
    """Let the others be close to an agent where it is close to them, and only there: `agent.replaced`."""
    me = np.int64(task.agent[agent])
    for other in range(task.agents):
        if other != agent:
            if has(world.rows[agent, CLOSE], np.int64(task.agent[other])):
                put(world.rows[other, CLOSE], me)
            else:
                take(world.rows[other, CLOSE], me)


@kernel
def part(home, world, node, also_on):
    """Let nothing be in or CLOSE to a node any more, nor ON it where that is asked."""
    for w in range(world.lifted.shape[0]):
        rest = world.lifted[w]
        while rest:
            place = world.place[home.slot[w * 64 + lowest(rest)]]
            rest &= rest - np.uint64(1)
            if also_on and place[ON] == node:
                place[ON] = -1
            if place[INSIDE] == node:
                place[INSIDE] = -1
            if place[NEXT_TO] == node:
                place[NEXT_TO] = -1


@kernel
def origin_of(home, task, world, node):
    """Return the thing from which a node is grabbed, to which the agent is then close: `origins.remembered`."""
    found = support(home, world, node)
    if found >= 0 and home.room_number[found] < 0:
        return found
    found = container(home, world, node)
    if found >= 0 and home.room_number[found] < 0:
        return found
    slot = home.slot[node]
    lifted = has(world.lifted, node)
    beside = np.int64(world.place[slot, NEXT_TO]) if lifted else np.int64(-1)
    for w in range(world.lifted.shape[0]):
        some = NONE
        if not lifted and node < home.close.shape[0]:
            some = home.close[node, w] & ~world.lifted[w]
        rest = world.lifted[w]
        while rest:
            other = w * 64 + lowest(rest)
            rest &= rest - np.uint64(1)
            if world.place[home.slot[other], NEXT_TO] == node:
                some |= bit(other)
        if beside >= 0 and beside >> 6 == w:
            some |= bit(beside)
        some |= _fresh_beside(task, world, node, w)
        some &= task.sets[FURNITURE, w]
        if some:
            return w * 64 + lowest(some)
    return np.int64(-1)


@kernel
def _fresh_beside(task, world, node, w):
    """Return a word of the things to which a node is CLOSE since the start because one of both was added."""
    base, found = 64 * (world.lifted.shape[0] - 1), NONE
    own = np.uint64(0) if node < base else world.fresh & bit(node)
    if own:
        found |= fresh_row(task, world, node - base, w)
    if w == world.lifted.shape[0] - 1 and (own or (node < base and not has(world.lifted, node))):
        rest = world.fresh
        while rest:
            k = lowest(rest)
            rest &= rest - np.uint64(1)
            if has(task.added_close[k], node):
                found |= bit(k)
    return found


@kernel
def lift(home, task, world, agent, node):
    """Take a thing into the free hand, right first: `hands._grab`."""
    origin = origin_of(home, task, world, node)
    part(home, world, node, True)
    place = world.place[home.slot[node]]
    place[ON] = place[INSIDE] = place[NEXT_TO] = -1
    place[ROOM] = world.room[agent]
    put(world.lifted, node)
    if node >> 6 == world.lifted.shape[0] - 1:
        world.fresh &= ~bit(node)
    for other in range(task.agents):
        if other != agent:
            take(world.rows[other, CLOSE], node)
        for row in (SEATS, WORN, CONTENTS):
            take(world.rows[other, row], node)
    put(world.rows[agent, CLOSE], node)
    if origin >= 0:
        put(world.rows[agent, CLOSE], origin)
    world.hands[agent, 0 if world.hands[agent, 0] < 0 else 1] = node


@kernel
def put_down(home, task, world, agent, hand, node, effect):
    """Leave a thing on or in a node; on another agent it is handed over: `hands.put_back`, `hands.put_in`."""
    thing = np.int64(world.hands[agent, hand])
    for each in range(2):
        if world.hands[agent, each] == thing:
            world.hands[agent, each] = -1
    put(world.rows[agent, CLOSE], node)
    other = agent_of(task, world, node)
    meet(task, world, agent)
    if other < 0:
        place = world.place[home.slot[thing]]
        place[NEXT_TO] = node
        place[ON if effect == PUT_ON else INSIDE] = node
        return
    put(world.rows[other, CLOSE], thing)
    if other != agent and effect == PUT_ON:
        world.hands[other, 0 if world.hands[other, 0] < 0 else 1] = thing
        put(world.rows[other, CLOSE], np.int64(task.agent[agent]))
    else:
        put(world.rows[other, WORN if effect == PUT_ON else CONTENTS], thing)
    meet(task, world, other)


@kernel
def settle(home, task, world, agent, node, posture):
    """Sit or lie on something, turned as it is: `posture._settle`, `positions.resting`."""
    for w in range(world.lifted.shape[0]):
        world.rows[agent, SEATS, w] &= ~task.sets[LEFT, w]
    put(world.rows[agent, SEATS], node)
    if posture == SITTING and node < home.facing.shape[0] and not has(world.carried, node):
        for w in range(world.lifted.shape[0]):
            world.rows[agent, FACING, w] |= home.facing[node, w] & ~world.carried[w]
    world.posture[agent] = posture
    meet(task, world, agent)
    known, x, z = spot(home, task, world, node)
    if known:
        world.pose[agent, 0], world.pose[agent, 1] = x, z
        if not math.isnan(home.box[node, 2]):
            world.pose[agent, 2] = home.box[node, 2]


@kernel
def rise(home, task, world, agent):
    """Stand up next to the seat, which is free then: `posture.stand_up`, `positions.risen`."""
    seat = np.int64(-1)
    for w in range(world.lifted.shape[0]):
        if seat < 0 and world.rows[agent, SEATS, w]:
            seat = w * 64 + lowest(world.rows[agent, SEATS, w])
    if seat >= 0:
        x, z = world.pose[agent, 0], world.pose[agent, 1]
        key, _ = target_of(home, task, world, seat)
        targets = home.first_stand.shape[0] - 1
        if key >= targets:
            cell = key - targets
            world.pose[agent, 0], world.pose[agent, 1] = home.middle[cell, 0], home.middle[cell, 1]
        elif key >= 0:
            nearest = np.inf
            for k in range(home.first_stand[key], home.first_stand[key + 1]):
                cell = home.stands[k]
                far = hypot(home.middle[cell, 0] - x, home.middle[cell, 1] - z)
                if far < nearest:
                    nearest = far
                    world.pose[agent, 0], world.pose[agent, 1] = home.middle[cell, 0], home.middle[cell, 1]
    world.posture[agent] = 0
    for w in range(world.lifted.shape[0]):
        world.rows[agent, SEATS, w] &= ~task.sets[LEFT, w]
    meet(task, world, agent)


@kernel
def rotate(task, world, agent, degrees):
    """Turn about oneself; the agent faces nothing named then: `metric_checks.turn`."""
    world.pose[agent, 2] = (world.pose[agent, 2] + degrees) % 360.0
    for w in range(world.lifted.shape[0]):
        world.rows[agent, FACING, w] = NONE
    meet(task, world, agent)


@kernel
def _gone(home, task, world, agent, near, room, x, z, yaw):
    """Move an agent with the things in its hands: `locomotion.gone`."""
    me = np.int64(task.agent[agent])
    for hand in range(2):
        thing = np.int64(world.hands[agent, hand])
        if thing >= 0:
            part(home, world, thing, False)
            place = world.place[home.slot[thing]]
            place[INSIDE] = place[NEXT_TO] = -1
            place[ROOM] = room
            put(world.carried, thing)
            put(near, thing)
    for w in range(near.shape[0]):
        world.rows[agent, CLOSE, w] = near[w]
        world.rows[agent, FACING, w] = world.rows[agent, CONTENTS, w] = NONE
    world.room[agent] = room
    world.pose[agent, 0], world.pose[agent, 1], world.pose[agent, 2] = x, z, yaw
    for other in range(task.agents):
        if other == agent:
            continue
        for row in (CLOSE, FACING, CONTENTS):
            take(world.rows[other, row], me)
            for hand in range(2):
                if world.hands[agent, hand] >= 0:
                    take(world.rows[other, row], np.int64(world.hands[agent, hand]))
        if has(near, np.int64(task.agent[other])):
            put(world.rows[other, CLOSE], me)


@kernel
def stride_ahead(home, task, world, agent, doors, near):
    """Walk straight on, which is possible: `metric_checks.walk_forward`."""
    _, x, z = ahead(home, world.pose[agent], world.stride[agent], doors)
    room = near_point(home, task, world, agent, x, z, near)
    _gone(home, task, world, agent, near, room, x, z, world.pose[agent, 2])


@kernel
def stride_towards(home, task, world, agent, node, doors, distance, following, only, near, cells):
    """Make a stride along the way to a node, which is possible: `metric_checks.walk_towards`."""
    key, place = target_of(home, task, world, node)
    pose = world.pose[agent]
    x, z, cell = stepped(home, distance, following, only, key, place, doors, pose, world.stride[agent], cells)
    if cell >= 0:
        yaw = turned_to(pose[0], pose[1], pose[2], x, z)
        room = near_point(home, task, world, agent, x, z, near)
        _gone(home, task, world, agent, near, room, x, z, yaw)
        return
    room = destination(home, task, world, agent, node, doors)
    known, to_x, to_z = spot(home, task, world, node)
    yaw = turned_to(x, z, pose[2], to_x, to_z) if known else pose[2]
    near_point(home, task, world, agent, x, z, near)
    add_arrival(home, task, world, node, near)
    _gone(home, task, world, agent, near, room, x, z, yaw)
