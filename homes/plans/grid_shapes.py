"""Shapes in a grid of cells, with numpy alone.

scipy.ndimage has the same three. Importing it takes as long as loading seven homes (0.7 s and 0.1 s a home), and every
process that loads a home would pay for it.
"""

import numpy as np


def eroded(free: np.ndarray, reach: int) -> np.ndarray:
    """Bool, same shape: cells with everything free within `reach` cells of them; beyond the grid nothing is free."""
    columns, rows = free.shape
    padded = np.zeros((columns + 2 * reach, rows + 2 * reach), bool)
    padded[reach : reach + columns, reach : reach + rows] = free
    found = np.ones_like(free)
    for i in range(-reach, reach + 1):
        for j in range(-reach, reach + 1):
            if i * i + j * j <= reach * reach:
                found &= padded[reach + i : reach + i + columns, reach + j : reach + j + rows]
    return found


def regions(mask: np.ndarray) -> np.ndarray:
    """Int32, same shape: cells that join side by side share a number, from 1 in the order of their first cells."""
    columns, rows = mask.shape
    edges = np.diff(np.pad(mask, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    starts, ends = np.argwhere(edges == 1), np.argwhere(edges == -1)
    column, low, high = starts[:, 0].tolist(), starts[:, 1].tolist(), ends[:, 1].tolist()
    parent = list(range(len(column)))

    def root(run: int) -> int:
        while parent[run] != run:
            parent[run] = run = parent[parent[run]]
        return run

    last = 0
    for run, here in enumerate(column):
        while last < run and column[last] < here - 1:
            last += 1
        for other in range(last, run):
            if column[other] == here - 1 and low[other] < high[run] and low[run] < high[other]:
                one, two = sorted((root(run), root(other)))
                parent[two] = one
    numbers: dict[int, int] = {}
    found = np.zeros((columns, rows), np.int32)
    for run, here in enumerate(column):
        found[here, low[run] : high[run]] = numbers.setdefault(root(run), len(numbers) + 1)
    return found


def clearance(free: np.ndarray) -> np.ndarray:
    """Int64, same shape: the squared distance in cells from each free cell to the nearest that is not; 0 where not.

    Cells beyond the grid do not count, as in a Euclidean distance transform; in a grid without obstacles all are far.
    """
    columns, rows = free.shape
    far = columns + rows
    along = np.where(free, far, 0).astype(np.int64)
    for j in range(1, rows):
        np.minimum(along[:, j], along[:, j - 1] + 1, out=along[:, j])
    for j in range(rows - 2, -1, -1):
        np.minimum(along[:, j], along[:, j + 1] + 1, out=along[:, j])
    squares = along**2
    found = squares.copy()
    for shift in range(1, columns):
        if shift * shift >= int(found.max()):
            break
        np.minimum(found[shift:], squares[:-shift] + shift * shift, out=found[shift:])
        np.minimum(found[:-shift], squares[shift:] + shift * shift, out=found[:-shift])
    return found
