"""Random legal numbers, each equally probable: for random play, tests and benchmarks."""

from __future__ import annotations

from typing import Any

import numpy as np

from hearth.simulation.arrays.instruction_table import FIRST_NODE_NUMBER
from hearth.simulation.arrays.kernels.set_words import count, entry, kernel, lowest, sources


@kernel
def _mixed(x):
    """Return a number that looks random."""
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


@kernel
def _of_rank(planes, rank):
    """Return the legal number of a rank: those of planes first, then those below 64."""
    last = planes.shape[0] - 1
    for plane in range(last + 1):
        for w in range(planes.shape[1]):
            word = planes[plane, w]
            here = count(word)
            if rank >= here:
                rank -= here
                continue
            for _ in range(rank):
                word &= word - np.uint64(1)
            node = w * 64 + lowest(word)
            return node if plane == last else FIRST_NODE_NUMBER + plane * 64 * planes.shape[1] + node
    return 0


def _compiled(sources: int) -> Any:
    """Return `random_legal`; the digest of the sources is part of the key under which it is cached."""

    @entry
    def random_legal(planes, numbers, seed):
        """Write a random legal number for each agent of each world."""
        for i in range(planes.shape[0]):
            for agent in range(planes.shape[1]):
                total = 0
                for plane in range(planes.shape[2]):
                    for w in range(planes.shape[3]):
                        total += count(planes[i, agent, plane, w])
                drawn = _mixed(np.uint64(seed) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(i * planes.shape[1] + agent))
                numbers[i, agent] = _of_rank(planes[i, agent], np.int64(drawn % np.uint64(total)))
        return sources

    return random_legal


random_legal = _compiled(sources())
