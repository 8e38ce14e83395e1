"""The best of some scores, where rounding decides nothing.

Nodes that nothing distinguishes have the same score but for rounding, which differs with the batch and the machine.
"""

import numpy as np

SAME = 1e-4
"""Scores that differ by no more are equal. Single precision errs by some 1e-6 here."""


def best_places(values: np.ndarray, most: int = 1) -> list[int]:
    """Return the places of the `most` greatest values.

    Of equal values the first is taken. -inf is taken only if all values are -inf.

    Args:
        values: scores, (N,), N > 0.
        most: places at most.
    """
    left = values.astype(np.float64)
    found: list[int] = []
    for _ in range(min(most, len(left))):
        best = left.max()
        if found and best == -np.inf:
            break
        found.append(int(np.argmax(left >= best - SAME)))
        left[found[-1]] = -np.inf
    return found
