"""The edges among seen nodes as arrays: those of the start that still count, and those that came since."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from hearth.schemas.vocabulary import RELATION_ID, RELATIONS
from hearth.simulation.world.agent import AGENT_IN, AGENT_OUT
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.moved_edges import CLOSE, FACING, INSIDE, ON, Moved
from hearth.simulation.world.world import World

Edges = NDArray[np.int64]
"""(edges, 3): index of the source, relation id, index of the target."""

_OUTWARD = {ON: "ON", INSIDE: "INSIDE", CLOSE: "CLOSE", FACING: "FACING"}
"""The relation of each kind of row of `Moved` that begins at its node."""

_REMOVED = np.array([Moved._fields.index(n.lower()) if n.lower() in Moved._fields else -1 for n in RELATIONS])
"""By relation id, the field of `Moved` with the nodes removed from the relation; -1 of BETWEEN and the hands."""


def bits(mask: int, count: int) -> NDArray[np.bool_]:
    """Return a set of the first `count` nodes as bool (count)."""
    packed = np.frombuffer((mask & (1 << count) - 1).to_bytes(count + 7 >> 3, "little"), np.uint8)
    return np.unpackbits(packed, count=count, bitorder="little").astype(bool)


def start_edges(home: Home, relations: Iterable[str]) -> Edges:
    """Return the edges between things at the start, for `seen_edges`."""
    found = []
    for name in relations:
        rows: Sequence[int] = home.tables[name][0] if name in home.tables else home.between if name == "BETWEEN" else ()
        found += [(i, RELATION_ID[name], j) for i, row in enumerate(rows) for j in indices(row)]
    return np.array(found, np.int64).reshape(-1, 3)


def seen_edges(world: World, mask: int, relations: frozenset[str], start: Edges) -> Edges:
    """Return the edges among some nodes, sorted.

    Args:
        world: now.
        mask: the nodes.
        relations: of the edges.
        start: `start_edges` of the home and these relations.
    """
    wanted = relations
    count = len(world.home)
    removed = np.stack([bits(removed, count) for removed in world.moved[:4]])
    seen = bits(mask, count)
    keep = seen[start[:, 0]] & seen[start[:, 2]]
    start = start[keep]
    table = _REMOVED[start[:, 1]]
    counts = (table < 0) | ~(removed[table, start[:, 0]] | removed[table, start[:, 2]])
    extra: list[tuple[int, int, int]] = []
    for key, row in world.moved.extra.items():
        name = _OUTWARD.get(key & 7)
        if name in wanted and mask >> (key >> 3) & 1:
            extra += [(key >> 3, RELATION_ID[name], j) for j in indices(row & mask)]
    extra += _characters_edges(world, mask, wanted)
    found = np.concatenate([start[counts], np.array(extra, np.int64).reshape(-1, 3)])
    # One number an edge: rows are sorted and made distinct thirty times slower.
    keys = np.sort((found[:, 0] * len(RELATIONS) + found[:, 1]) * count + found[:, 2])
    keys = keys[np.append(True, keys[1:] != keys[:-1])[: len(keys)]]
    rest, targets = np.divmod(keys, count)
    return np.stack([*np.divmod(rest, len(RELATIONS)), targets], 1)


def _characters_edges(world: World, mask: int, relations: frozenset[str]) -> list[tuple[int, int, int]]:
    found = []
    for agent in world.agents:
        if mask & agent.bit:
            for fields, outwards in ((AGENT_OUT, True), (AGENT_IN, False)):
                for name in relations & fields.keys():
                    number = RELATION_ID[name]
                    others = indices(getattr(agent, fields[name]) & mask)
                    found += [(agent.index, number, j) if outwards else (j, number, agent.index) for j in others]
    return found
