"""Cells of a home's floor, and the things that block them."""

import numpy as np
from numpy.typing import NDArray

from hearth.schemas.graph import Box, Node, Spot

CELL = 0.1
BODY = 2
"""Cells that a standing character needs on each side of the middle one."""
HEADROOM = 1.7
STEP_OVER = 0.06
IGNORED = frozenset({"floor", "ceiling", "mat", "carpet", "doorjamb", "window", "curtain", "blinds", "doormat"})
"""Classes that do not block the floor."""


def is_in_the_way(node: Node, floor: float) -> bool:
    """Return whether a thing with a box blocks the floor of that height."""
    assert node.box is not None
    low, high = node.box.center[1] - node.box.size[1] / 2 - floor, node.box.center[1] + node.box.size[1] / 2 - floor
    return node.class_name not in IGNORED and low < HEADROOM and high > STEP_OVER and node.category not in (
        "Rooms", "Characters", "BodyParts"
    )  # fmt: skip


def cells_of(box: Box, origin: Spot) -> tuple[slice, slice]:
    """Cells with their middle in a box."""

    def part(center: float, size: float, start: float) -> slice:
        first = int(np.ceil((center - size / 2 - start) / CELL - 0.5))
        last = int(np.floor((center + size / 2 - start) / CELL - 0.5)) + 1
        return slice(max(first, 0), max(last, 0))

    return part(box.center[0], box.size[0], origin[0]), part(box.center[2], box.size[2], origin[1])


def eroded(free: NDArray[np.bool_], reach: int = BODY) -> NDArray[np.bool_]:
    """Cells with `reach` free cells on every side."""
    padded = np.pad(free, reach)
    kept = free.copy()
    for i in range(-reach, reach + 1):
        for j in range(-reach, reach + 1):
            if i * i + j * j <= reach * reach + 1:
                kept &= padded[reach + i : reach + i + free.shape[0], reach + j : reach + j + free.shape[1]]
    return kept
