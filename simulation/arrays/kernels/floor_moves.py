"""The floor: cells, ways to things, strides. They read as `motion.navigation.Ways` and `motion.ground.Ground` do.

While doors are closed a way is the open one where that is free, which `distance_pool` checks; so a field belongs to a
target, and to a set of closed doors only where they turn some way.
"""

from __future__ import annotations

import math

import numpy as np

from hearth.simulation.arrays.kernels.places import holder, room_of, standing
from hearth.simulation.arrays.kernels.set_words import DOORS, ELSEWHERE, NONE, bit, has, hypot, kernel, lowest


@kernel
def cell_number(home, row, column):
    """Return the number of the walkable cell at a place of the grid with its border, or -1."""
    if 0 <= row < home.grid.shape[0] and 0 <= column < home.grid.shape[1]:
        return np.int64(home.grid[row, column])
    return np.int64(-1)


@kernel
def cell_at(home, x, z):
    """Return the number of the walkable cell that a point lies in, or -1."""
    size = home.origin[2]
    row = int(math.floor((x - home.origin[0]) / size)) + 1
    return cell_number(home, row, int(math.floor((z - home.origin[1]) / size)) + 1)


@kernel
def cells_around(home, x, z, cells):
    """Write the cells to whose middles one can go straight from a point, as `Ways.around` lists them; their number."""
    size = home.origin[2]
    u, v = (x - home.origin[0]) / size + 0.5, (z - home.origin[1]) / size + 0.5
    i, j = int(math.floor(u + 1e-6)), int(math.floor(v + 1e-6))
    right, up = u - i > 1e-6, v - j > 1e-6
    here = cell_number(home, i, j)
    beside = cell_number(home, i + 1, j) if right else np.int64(-1)
    above = cell_number(home, i, j + 1) if up else np.int64(-1)
    if right and up:
        far = cell_number(home, i + 1, j + 1)
        if far < 0 or here < 0 or beside < 0 or above < 0:  # only those that share a side with the point's own cell
            own = cell_at(home, x, z)
            if own < 0:
                return 0
            straight = own == here or own == far
            return _kept(cells, own, beside if straight else here, above if straight else far)
        cells[0], cells[1], cells[2], cells[3] = here, beside, above, far
        return 4
    return _kept(cells, here, beside, above)


@kernel
def _kept(cells, one, two, three):
    """Write those of three cells that there are, in order; their number."""
    found = 0
    for cell in (one, two, three):
        if cell >= 0:
            cells[found] = cell
            found += 1
    return found


@kernel
def closed_doors(home, task, world, keep):
    """Return the closed doors among some nodes, as bits of their numbers."""
    found = np.int64(0)
    for w in range(keep.shape[0]):
        rest = task.sets[DOORS, w] & world.states[0, w] & keep[w]
        while rest:
            found |= np.int64(1) << home.door_number[w * 64 + lowest(rest)]
            rest &= rest - np.uint64(1)
    return found


@kernel
def target_of(home, task, world, node):
    """Return (key of the field to a node, the node at whose places it ends); the key is -1 where no place is known.

    Keys below the number of targets are of things at places; others are of one cell, in which an agent stands.
    """
    agent = holder(task, world, node)
    if agent >= 0:
        x, z = world.pose[agent, 0], world.pose[agent, 1]
        cell = cell_at(home, x, z)
        if cell < 0:
            nearest = np.inf
            for number in range(home.cells):
                far = hypot(home.middle[number, 0] - x, home.middle[number, 1] - z)
                if home.main[number] and far < nearest:
                    nearest, cell = far, np.int64(number)
        return home.first_stand.shape[0] - 1 + cell, np.int64(-1)
    place = standing(home, task, world, node)
    return (np.int64(home.target[place]), place) if place >= 0 else (np.int64(-1), place)


@kernel
def leads(home, key, place, doors, cell):
    """Return whether a way leads from a cell to a target while some doors are closed."""
    region = home.region[doors, cell]
    if place >= 0:
        return has(home.reached[doors, region], place)
    return region > 0 and region == home.region[doors, key - (home.first_stand.shape[0] - 1)]


@kernel
def way_to(home, key, place, doors, x, z, cells):
    """Return whether a way leads from a point to a target."""
    for number in range(cells_around(home, x, z, cells)):
        if leads(home, key, place, doors, cells[number]):
            return True
    return False


@kernel
def stepped(home, distance, following, only, key, place, doors, pose, stride, cells):
    """Return (x, z, the next cell) a stride along the way of a field, as `Ways.stepped` does: -1 at the end, -2 no way.

    `only` is the one cell at which the way begins and ends, or -1.
    """
    x, z = pose[0], pose[1]
    best, cell = np.inf, np.int64(-1)
    for number in range(cells_around(home, x, z, cells)):
        each = cells[number]
        if (only < 0 or each == only) and leads(home, key, place, doors, each):
            total = hypot(x - home.middle[each, 0], z - home.middle[each, 1]) + distance[each]
            if total < best:
                best, cell = total, each
    if cell < 0:
        return x, z, np.int64(-2)
    rest = best - stride
    here_x, here_z = x, z
    while distance[cell] > rest:
        here_x, here_z = home.middle[cell, 0], home.middle[cell, 1]
        cell = np.int64(following[cell])
        if cell < 0:
            return here_x, here_z, np.int64(-1)
    there_x, there_z = home.middle[cell, 0], home.middle[cell, 1]
    length = hypot(here_x - there_x, here_z - there_z)
    share = (rest - distance[cell]) / length if length else 0.0
    if share < 1e-9 and following[cell] < 0:
        return there_x, there_z, np.int64(-1)
    return there_x + (here_x - there_x) * share, there_z + (here_z - there_z) * share, cell


@kernel
def ahead(home, pose, stride, doors):
    """Return whether a stride straight ahead is free, and the point at its end."""
    angle = pose[2] * (math.pi / 180.0)
    step_x, step_z = math.sin(angle) * stride, math.cos(angle) * stride
    size = home.origin[2]
    parts = max(1, int(math.ceil(hypot(step_x, step_z) / (size / 2))))
    x, z = (pose[0] - home.origin[0]) / size + 1, (pose[1] - home.origin[1]) / size + 1
    dx, dz = step_x / size / parts, step_z / size / parts
    for part in range(1, parts + 1):
        cell = cell_number(home, int(math.floor(x + dx * part)), int(math.floor(z + dz * part)))
        if cell < 0 or not home.main[cell] or home.shut[cell] & doors:
            return False, pose[0], pose[1]
    return True, pose[0] + step_x, pose[1] + step_z


@kernel
def turned_to(x, z, yaw, to_x, to_z):
    """Return the direction from a point to another, in degrees; the old one where they are the same."""
    dx, dz = to_x - x, to_z - z
    if abs(dx) + abs(dz) < 1e-9:
        return yaw
    return (math.atan2(dx, dz) * (180.0 / math.pi)) % 360.0


@kernel
def destination(home, task, world, agent, node, doors):
    """Return the room in which a walk to a node ends, once it is known to be possible."""
    room = room_of(home, task, world, node)
    door, start = home.door_number[node], np.int64(world.room[agent])
    if door < 0 or start < 0:
        return room
    number = home.room_number[start]
    reached = np.int64(home.reached_rooms[number, doors])
    if room >= 0 and reached >> home.room_number[room] & 1:
        return room
    within = np.int64(home.between[door]) & reached
    if within >> number & 1:
        return start
    return np.int64(home.room_node[lowest(np.uint64(within))]) if within else room


@kernel
def walkable(home, task, world, agent, keep, doors, first, last, out):
    """Write the nodes that no closed door keeps an agent from, in some words: `reach.walkable`."""
    start = np.int64(world.room[agent])
    for w in range(first, last):
        if start >= 0:
            out[w] = home.walkable[home.room_number[start], doors, w] & ~world.lifted[w]
        else:
            out[w] = home.walkable[0, 0, w] & ~world.lifted[w]
        rest = world.lifted[w] & keep[w]
        for number in range(task.agents):
            node = np.int64(task.agent[number])
            if node >> 6 == w:
                out[w] &= ~bit(node)
                rest |= keep[w] & bit(node)
        while rest:
            node = w * 64 + lowest(rest)
            rest &= rest - np.uint64(1)
            room = room_of(home, task, world, node)
            if room >= 0 and (
                start < 0 or home.open_rooms[home.room_number[start], doors] >> home.room_number[room] & 1
            ):
                out[w] |= bit(node)


@kernel
def walked_to(home, task, world, agent, keep, doors, first, last, cells, out):
    """Write the nodes to which a way over the floor leads, in some words: `positions.walked_to`."""
    x, z = world.pose[agent, 0], world.pose[agent, 1]
    around = cells_around(home, x, z, cells)
    for w in range(first, last):
        out[w] = NONE
        for number in range(around):
            out[w] |= home.reached[doors, home.region[doors, cells[number]], w]
        rest = (world.lifted[w] | task.sets[ELSEWHERE, w]) & keep[w]
        for number in range(task.agents):
            node = np.int64(task.agent[number])
            if node >> 6 == w:
                rest |= keep[w] & bit(node)
        out[w] &= ~(world.lifted[w] | task.sets[ELSEWHERE, w])
        while rest:
            node = w * 64 + lowest(rest)
            rest &= rest - np.uint64(1)
            key, place = target_of(home, task, world, node)
            found = False
            if key >= 0:
                for number in range(around):
                    if leads(home, key, place, doors, cells[number]):
                        found = True
            if found:
                out[w] |= bit(node)
            else:
                out[w] &= ~bit(node)
