"""Legal actions: the programs of masks (see `mask_tracing`), run over the sets of a situation.

`fill_all` computes these sets for all nodes as an agent sees the world, `fill_one` for one node in the world as it is.
Both readings of a set stand together, as in `actions.common`.
"""

from __future__ import annotations

import numpy as np

from hearth.simulation.arrays.instruction_table import (
    FIRST,
    HAND,
    HELD,
    LAST,
    NEEDS,
    PLANE,
    RESULT,
)
from hearth.simulation.arrays.kernels.floor_moves import (
    ahead,
    cells_around,
    closed_doors,
    leads,
    target_of,
    walkable,
    walked_to,
)
from hearth.simulation.arrays.kernels.nearness import close_to
from hearth.simulation.arrays.kernels.places import container
from hearth.simulation.arrays.kernels.set_words import (
    ALL,
    BEDDING,
    LIEABLE,
    NONE,
    ON,
    ONE,
    RESTS,
    SEATS,
    WORN,
    bit,
    count,
    has,
    kernel,
    lowest,
    put,
)
from hearth.simulation.arrays.kernels.sight import hidden_one
from hearth.simulation.arrays.mask_tracing import AND, DYNAMIC, NOT
from hearth.simulation.world.states import LYING, SITTING

(
    _ZERO, _ONES, _ME, _WORN, _ROOM_TO_SIT, _ROOM_TO_LIE, _FREE_HAND, _SITTING, _LYING, _RESTING, _AHEAD, _CLOSE,
    _HIDDEN, _HELD, _WALKABLE, _WALKED_TO, _HELD_BY_OTHERS, _FULL_HANDED, _IN_USE, _STATES,
) = (*range(19), 19)  # fmt: skip
assert DYNAMIC[_STATES] == "state_CLOSED" and DYNAMIC[_IN_USE] == "in_use" and DYNAMIC[_AHEAD] == "ahead"

_OWN = len(DYNAMIC)
"""The first register of a task's sets."""

UPRIGHT = 0
"""The posture of an agent that neither sits nor lies; the others are the numbers of the states."""


@kernel
def _something_put_on_seats(home, task, world):
    """Return whether any lifted thing is on something to sit or lie on."""
    for w in range(world.lifted.shape[0]):
        rest = world.lifted[w]
        while rest:
            node = w * 64 + lowest(rest)
            rest &= rest - np.uint64(1)
            if has(task.sets[RESTS], np.int64(world.place[home.slot[node], ON])):
                return True
    return False


@kernel
def seat_taken(home, task, world, keep, node, made_bed, lifted_too):
    """Return how many things and agents take room on a seat or bed: `edge_rows.taking_room`."""
    found = 0
    plain = not (made_bed and has(task.sets[LIEABLE], node))
    if node < home.bears.shape[0] and not has(world.lifted, node):
        for w in range(world.lifted.shape[0]):
            on_it = home.bears[node, w] & ~world.lifted[w]
            found += count(on_it if plain else on_it & ~task.sets[BEDDING, w])
    for w in range(world.lifted.shape[0] if lifted_too else 0):
        rest = world.lifted[w] if plain else world.lifted[w] & ~task.sets[BEDDING, w]
        while rest:
            other = w * 64 + lowest(rest)
            rest &= rest - np.uint64(1)
            if world.place[home.slot[other], ON] == node:
                found += 1
    for agent in range(task.agents):
        me = np.int64(task.agent[agent])
        if has(keep, me) and has(world.rows[agent, SEATS], node):
            found += 1
    return found


@kernel
def _limit(home, task, node, lying):
    """Return how many things a seat or bed has room for."""
    first = home.close.shape[0]
    if node >= first:
        return np.int64(task.added_limits[node - first, lying])
    return np.int64(home.limits[node, lying])


@kernel
def _flag(row, first, last, holds):
    """Fill the words of a register with all bits or none."""
    for w in range(first, last):
        row[w] = ALL if holds else NONE


@kernel
def _fill_agents(task, world, agent, keep, first, last, registers):
    """Fill the registers about agents and the states of things, in some words."""
    posture = np.int64(world.posture[agent])
    _flag(registers[_ZERO], first, last, False)
    _flag(registers[_ONES], first, last, True)
    _flag(registers[_FREE_HAND], first, last, world.hands[agent, 0] < 0 or world.hands[agent, 1] < 0)
    _flag(registers[_SITTING], first, last, posture == SITTING)
    _flag(registers[_LYING], first, last, posture == LYING)
    _flag(registers[_RESTING], first, last, posture != UPRIGHT)
    for w in range(first, last):
        registers[_ME, w] = registers[_HELD, w] = registers[_HELD_BY_OTHERS, w] = NONE
        registers[_FULL_HANDED, w] = registers[_IN_USE, w] = NONE
        registers[_WORN, w] = world.rows[agent, WORN, w] & keep[w]
        for state in range(8):
            registers[_STATES + state, w] = world.states[state, w] & keep[w]
        registers[_STATES + SITTING, w] = registers[_STATES + LYING, w] = NONE
    for other in range(task.agents):
        node = np.int64(task.agent[other])
        if not has(keep, node):
            continue
        held = 0
        for hand in range(2):
            thing = np.int64(world.hands[other, hand])
            if thing >= 0:
                held += 1
                if first <= thing >> 6 < last:
                    put(registers[_HELD if other == agent else _HELD_BY_OTHERS], thing)
        if first <= node >> 6 < last:
            if other == agent:
                put(registers[_ME], node)
            elif held == 2:
                put(registers[_FULL_HANDED], node)
            if world.posture[other] != UPRIGHT:
                put(registers[_STATES + np.int64(world.posture[other])], node)
        if world.posture[other] != UPRIGHT:
            for w in range(first, last):
                registers[_IN_USE, w] |= world.rows[other, SEATS, w] & keep[w]


@kernel
def _own_sets(task, read, first, last, registers):
    """Copy the task's own sets that programs read."""
    for k in range(read.shape[0]):
        for w in range(first, last):
            registers[_OWN + read[k], w] = task.sets[read[k], w]


@kernel
def fill_all(home, task, world, agent, keep, inner, needs, read, made_bed, cells, registers):
    """Fill all registers for all nodes, as an agent sees the world; `inner` has the things directly in closed ones."""
    words = keep.shape[0]
    _fill_agents(task, world, agent, keep, 0, words, registers)
    _own_sets(task, read, 0, words, registers)
    if needs >> _CLOSE & 1:
        close_to(home, task, world, agent, keep, 0, words, registers[_CLOSE])
    if needs >> _HIDDEN & 1:
        for w in range(words):
            found = inner[w]
            rest = inner[w] & keep[w]
            while rest:  # a container that is not seen may be open
                node = w * 64 + lowest(rest)
                rest &= rest - np.uint64(1)
                if not has(keep, container(home, world, node)):
                    found &= ~bit(node)
            registers[_HIDDEN, w] = found
    some = _something_put_on_seats(home, task, world)
    for lying in range(2):
        if needs >> (_ROOM_TO_SIT + lying) & 1:
            for w in range(words):
                rest, found = registers[_CLOSE, w] & keep[w] & task.sets[RESTS, w], NONE
                while rest:
                    node = w * 64 + lowest(rest)
                    rest &= rest - np.uint64(1)
                    if seat_taken(home, task, world, keep, node, made_bed, some) < _limit(home, task, node, lying):
                        found |= bit(node)
                registers[_ROOM_TO_SIT + lying, w] = found
    if needs >> _AHEAD & 1 or needs >> _WALKED_TO & 1:
        doors = closed_doors(home, task, world, keep)
        free, _, _ = ahead(home, world.pose[agent], world.stride[agent], doors)
        _flag(registers[_AHEAD], 0, words, free)
        if world.posture[agent] == UPRIGHT:
            walkable(home, task, world, agent, keep, doors, 0, words, registers[_WALKABLE])
            walked_to(home, task, world, agent, keep, doors, 0, words, cells, registers[_WALKED_TO])


@kernel
def fill_one(home, task, world, agent, keep, node, needs, read, made_bed, cells, registers):
    """Fill the registers that a program needs for one node, in the world as it is; `keep` has all nodes."""
    first = node >> 6
    last = first + 1
    _fill_agents(task, world, agent, keep, first, last, registers)
    _own_sets(task, read, first, last, registers)
    if needs >> _CLOSE & 1:
        close_to(home, task, world, agent, keep, first, last, registers[_CLOSE])
    if needs >> _HIDDEN & 1:
        _flag(registers[_HIDDEN], first, last, hidden_one(home, task, world, node))
    for lying in range(2):
        if needs >> (_ROOM_TO_SIT + lying) & 1:
            taken = seat_taken(home, task, world, keep, node, made_bed, True)
            _flag(registers[_ROOM_TO_SIT + lying], first, last, taken < _limit(home, task, node, lying))
    if needs >> _AHEAD & 1 or needs >> _WALKED_TO & 1 or needs >> _WALKABLE & 1:
        doors = closed_doors(home, task, world, keep)
        if needs >> _AHEAD & 1:
            free, _, _ = ahead(home, world.pose[agent], world.stride[agent], doors)
            _flag(registers[_AHEAD], first, last, free)
        if needs >> _WALKABLE & 1:
            walkable(home, task, world, agent, keep, doors, first, last, registers[_WALKABLE])
        if needs >> _WALKED_TO & 1:
            found = False
            key, place = target_of(home, task, world, node)
            if key >= 0:
                for number in range(cells_around(home, world.pose[agent, 0], world.pose[agent, 1], cells)):
                    if leads(home, key, place, doors, cells[number]):
                        found = True
            _flag(registers[_WALKED_TO], first, last, found)


@kernel
def run(program, start, end, first, last, registers):
    """Run the operations of a mask on some words."""
    for k in range(start, end):
        kind, a, b, c = program[k, 0], program[k, 1], program[k, 2], program[k, 3]
        if kind == AND:
            for w in range(first, last):
                registers[c, w] = registers[a, w] & registers[b, w]
        elif kind == NOT:
            for w in range(first, last):
                registers[c, w] = ~registers[a, w]
        else:
            for w in range(first, last):
                registers[c, w] = registers[a, w] | registers[b, w]


@kernel
def legal(world, agent, keep, rows, program, registers, planes):
    """Write the legal numbers as words: a row a plane, and the numbers below 64 in the first word of the last row."""
    words = keep.shape[0]
    last = planes.shape[0] - 1
    for w in range(words):
        planes[last, w] = NONE
    for k in range(rows.shape[0]):
        row = rows[k]
        run(program, row[FIRST], row[LAST], 0, words, registers)
        result, plane, hand = registers[row[RESULT]], row[PLANE], row[HAND]
        if plane < 0:
            if result[0]:
                planes[last, 0] |= ONE << np.uint64(k)
            continue
        thing = np.int64(-1) if hand < 0 else np.int64(world.hands[agent, hand])
        able = hand < 0 or (has(registers[row[HELD]], thing) and has(keep, thing))
        for w in range(words):
            planes[plane, w] = result[w] & keep[w] if able else NONE
        if thing >= 0:
            planes[plane, thing >> 6] &= ~bit(thing)


@kernel
def allowed(home, task, world, agent, keep, row, node, read, program, made_bed, cells, registers):
    """Return whether the engine would not refuse the action of a row about a node."""
    if row[PLANE] >= 0 and not has(task.sets[0], node):
        return False
    at = node if row[PLANE] >= 0 else np.int64(0)
    thing = np.int64(-1)
    if row[HAND] >= 0:
        thing = np.int64(world.hands[agent, row[HAND]])
        if thing < 0 or thing == node:
            return False
    fill_one(home, task, world, agent, keep, at, row[NEEDS], read, made_bed, cells, registers)
    first = at >> 6
    run(program, row[FIRST], row[LAST], first, first + 1, registers)
    return has(registers[row[RESULT]], at)
