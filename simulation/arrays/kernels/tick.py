"""One tick of many worlds: `engine.tick`, then the goal, the reward, and the observations of the agents."""

from __future__ import annotations

from typing import Any

import numpy as np

from hearth.simulation.arrays.instruction_table import (
    ARGUMENT,
    BECOMES,
    EFFECT,
    FIRST_NODE_NUMBER,
    HAND,
    LIFT,
    MOVING,
    NEEDS,
    PUT_INSIDE,
    PUT_ON,
    RISE,
    ROTATE,
    SETTLE,
    STRIDE_AHEAD,
    STRIDE_TOWARDS,
)
from hearth.simulation.arrays.kernels.effects import (
    become,
    lift,
    put_down,
    rise,
    rotate,
    settle,
    stride_ahead,
    stride_towards,
)
from hearth.simulation.arrays.kernels.floor_moves import cell_at, closed_doors, target_of
from hearth.simulation.arrays.kernels.goals import count_goal
from hearth.simulation.arrays.kernels.masks import allowed, fill_all, legal
from hearth.simulation.arrays.kernels.observations import observe
from hearth.simulation.arrays.kernels.set_words import ALL, EVERYTHING, entry, kernel, sources
from hearth.simulation.arrays.kernels.sight import hidden, visible

STEP, LOOK = range(2)
"""Tasks of `advance`."""

REWARDS, SIGHT, ARRAYS = 1, 2, 3
"""Levels of a step: the goal and the reward; masks, too; arrays, too."""

REFUSED, CONFLICT, MISSING = 1, 16, 256
"""Bits of a world's status: for each agent whether it was refused, and whether another's act is the reason; a distance
field is missing, so that the tick waits."""


@kernel
def row_and_node(number, nodes, first_plane):
    """Return the row of a number in the action table, and its node."""
    if number < FIRST_NODE_NUMBER:
        return np.int64(number), np.int64(0)
    rest = number - FIRST_NODE_NUMBER
    return first_plane + rest // nodes, rest % nodes


@kernel
def _is_action(number, first_plane):
    """Return whether a number is an action at all; those between both kinds are refused, as illegal ones are."""
    return number < first_plane or number >= FIRST_NODE_NUMBER


@kernel
def _field_row(home, task, world, field_rows, agent, node, doors, missing):
    """Return (number of the field of a walk, the only cell that it is about); the number is -1 where it is missing."""
    key, _ = target_of(home, task, world, node)
    cell = key - (home.first_stand.shape[0] - 1)
    if cell >= 0 and cell == cell_at(home, world.pose[agent, 0], world.pose[agent, 1]):
        return np.int64(0), cell
    row = np.int64(field_rows[task.home, key, doors])
    if row == 0:
        missing[0], missing[1], missing[2] = task.home, key, doors
        return np.int64(-1), np.int64(-1)
    return row, np.int64(-1)


@kernel
def _act(home, task, world, agent, row, node, everything, fields, missing, near, cells):
    """Do an action that is possible; return False where a distance field is missing."""
    effect, argument = row[EFFECT], row[ARGUMENT]
    if effect == BECOMES:
        become(world, argument, node)
        world.restated = 1
    elif effect == LIFT:
        lift(home, task, world, agent, node)
    elif effect == PUT_ON or effect == PUT_INSIDE:
        put_down(home, task, world, agent, row[HAND], node, effect)
    elif effect == SETTLE:
        settle(home, task, world, agent, node, argument)
        world.restated = 1
    elif effect == RISE:
        rise(home, task, world, agent)
        world.restated = 1
    elif effect == ROTATE:
        rotate(task, world, agent, argument)
    elif effect == STRIDE_AHEAD:
        doors = closed_doors(home, task, world, everything)
        stride_ahead(home, task, world, agent, doors, near)
    elif effect == STRIDE_TOWARDS:
        doors = closed_doors(home, task, world, everything)
        field_rows, distance, following = fields
        found, only = _field_row(home, task, world, field_rows, agent, node, doors, missing)
        if found < 0:
            return False
        stride_towards(home, task, world, agent, node, doors, distance[found], following[found], only, near, cells)
    return True


@kernel
def tick(home, task, world, numbers, table, fields, missing, scratch, registers, cells):
    """Run one tick by the rule of `engine.tick`, or go on with one that waited; return its status."""
    rows, program, read, first_plane, made_bed = table
    agents, nodes = task.agents, 64 * world.lifted.shape[0]
    everything, near = scratch[2], scratch[3]
    for w in range(everything.shape[0]):
        everything[w] = ALL
    if world.waiting == 0:
        world.restated = 0
        for agent in range(agents):  # each must be possible as the tick begins
            row, node = row_and_node(np.int64(numbers[agent]), nodes, first_plane)
            world.possible[agent] = _is_action(np.int64(numbers[agent]), first_plane) and allowed(
                home, task, world, agent, everything, rows[row], node, read, program, made_bed, cells, registers
            )
    status = np.int64(world.waiting >> 8)
    for agent in range(world.waiting & 255, agents):
        number = np.int64(numbers[agent])
        if number == 0:
            continue
        row, node = row_and_node(number, nodes, first_plane)
        now = world.possible[agent] != 0
        if agent > 0:
            now = _is_action(number, first_plane) and allowed(
                home, task, world, agent, everything, rows[row], node, read, program, made_bed, cells, registers
            )
            stays = rows[row, MOVING] and not world.restated  # see `engine._only_moves`
            if now and not world.possible[agent] and not stays:
                now = False
        if now and not _act(home, task, world, agent, rows[row], node, everything, fields, missing, near, cells):
            world.waiting = agent | status << 8
            return np.int64(MISSING)
        if not now:
            status |= REFUSED << agent
            if world.possible[agent]:
                status |= CONFLICT << agent
        world.last[agent, 0], world.last[agent, 1] = number, now
    world.waiting = 0
    world.tick += 1
    return status


@kernel
def look(home, task, world, agent, table, partial, keep, planes, scratch, registers, cells):
    """Write the nodes that an agent sees and its legal numbers."""
    rows, program, read, _, made_bed = table
    inner = scratch[4]
    if partial:
        visible(home, task, world, agent, keep, inner, scratch)
    else:
        for w in range(keep.shape[0]):
            scratch[2, w] = ALL
        hidden(home, task, world, scratch[2], inner)
        for w in range(keep.shape[0]):
            keep[w] = task.sets[EVERYTHING, w]
    needs = np.int64(0)
    for k in range(rows.shape[0]):
        needs |= rows[k, NEEDS]
    fill_all(home, task, world, agent, keep, inner, needs, read, made_bed, cells, registers)
    legal(world, agent, keep, rows, program, registers, planes)


def _compiled(sources: int) -> Any:
    """Return `advance`; the digest of the sources is part of the key under which it is cached."""

    @entry
    def advance(
        job, level, homes, tasks, worlds, which, numbers, table, fields, rules, shown, results, missing, scratch
    ):
        """Run a job for some worlds: `STEP` them, or `LOOK` at them as they are.

        Args:
            job, level: see above.
            homes, tasks, worlds: records.
            which: numbers of the worlds.
            numbers: actions by world and agent.
            table: rows, program, read sets and first plane of the actions, and the rule `made_bed`.
            fields: rows of distance fields by home, key and closed doors; distances; following cells.
            rules: ticks of an episode, rewards of success, a tick and a predicate, whether sight is partial.
            shown: arrays that observations are written into.
            results: status, rewards, whether the goal is reached, whether the time is over.
            missing: home, key and doors of a missing field, by world.
            scratch: words for intermediate sets and registers, and four cells; of one thread.
        """
        keep, planes = shown[0], shown[1]
        status, reward, reached, over = results
        limit, success, per_tick, per_predicate, partial = rules
        sets, registers, cells = scratch
        for k in range(which.shape[0]):
            i = which[k]
            world = worlds[i]
            task = tasks[world.task]
            home = homes[task.home]
            if job == STEP:
                status[i] = tick(home, task, world, numbers[i], table, fields, missing[i], sets, registers, cells)
                if status[i] & MISSING:
                    continue
                if level >= REWARDS:
                    met, before = world.met, world.total
                    now, total = count_goal(home, task, world)
                    world.met, world.total = now, total
                    reward[i] = per_tick + (success if now and not met else 0.0) + per_predicate * (total - before)
                    reached[i] = now
                    over[i] = world.tick >= limit and not now
            if level >= SIGHT:
                for agent in range(task.agents):
                    seen, legal_now = keep[i, agent], planes[i, agent]
                    look(home, task, world, agent, table, partial, seen, legal_now, sets, registers, cells)
                    if level >= ARRAYS:
                        observe(home, task, world, agent, seen, legal_now, registers, shown, i, limit)
        return sources

    return advance


advance = _compiled(sources())
