"""The best sequence of shots: which camera to show at each moment, so that acts are seen and no shot is too short."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Worths = NDArray[np.float64]
States = NDArray[np.int64]


class Acts(NamedTuple):
    """Acts that are seen if some moment of their tick shows them.

    Attributes:
        ticks: (moments,) the tick of each moment.
        shown: (rows, moments) the acts that a row shows at a moment: bit k for the act of the tick's k-th agent.
        gains: value of seeing the act of each of these agents, once a tick.
    """

    ticks: States
    shown: States
    gains: Sequence[float] = ()


def best_cut(worth: Worths, shortest: int, cost: float, acts: Acts | None = None) -> list[int]:
    """Return the row to show at each moment: the greatest sum of values and gains, less the cost of cuts.

    Dynamic programming over the row, the length of its run so far, and the acts of the tick seen so far.

    Args:
        worth: (rows, moments) the values.
        shortest: least moments of a run; where there are fewer in all, one row is shown.
        cost: of changing the row.
        acts: what is seen when; None counts the values alone.

    Returns:
        A row for each moment.
    """
    rows, moments = worth.shape
    acts = acts or Acts(np.zeros(moments, np.int64), np.zeros((rows, moments), np.int64))
    lengths, masks = max(min(shortest, moments), 1), 1 << len(acts.gains)
    gained = np.array([sum(gain for k, gain in enumerate(acts.gains) if mask >> k & 1) for mask in range(masks)])
    best = np.full((masks, lengths, rows), -np.inf)
    best[0, 0] = 0.0
    origins: list[States] = []
    for t in range(moments):
        moved, origin = _moved(best, cost) if t else (best, np.zeros(best.shape, np.int64))
        if t and acts.ticks[t] != acts.ticks[t - 1]:
            moved, origin = _forgotten(moved, origin)
        best, origin = _seen(moved, origin, acts.shown[:, t], gained)
        best += worth[:, t]
        origins.append(origin)
    mask, row = divmod(int(best[:, -1].argmax()), rows)
    state = (mask * lengths + lengths - 1) * rows + row
    found: list[int] = []
    for origin in reversed(origins):
        found.append(int(state % rows))
        state = int(origin.flat[state])
    return found[::-1]


def _moved(best: Worths, cost: float) -> tuple[Worths, States]:
    """Values of states at the next moment before it is shown, and the states that they come from."""
    masks = len(best)
    every = np.arange(best.size).reshape(best.shape)
    moved, origin = np.full(best.shape, -np.inf), np.zeros(best.shape, np.int64)
    moved[:, 1:], origin[:, 1:] = best[:, :-1], every[:, :-1]
    stays = best[:, -1] > moved[:, -1]
    moved[:, -1] = np.where(stays, best[:, -1], moved[:, -1])
    origin[:, -1] = np.where(stays, every[:, -1], origin[:, -1])
    last = best[:, -1].argmax(axis=1)
    cut = best[np.arange(masks), -1, last][:, None] - cost
    begins = cut > moved[:, 0]
    moved[:, 0] = np.where(begins, cut, moved[:, 0])
    origin[:, 0] = np.where(begins, every[np.arange(masks), -1, last][:, None], origin[:, 0])
    return moved, origin


def _forgotten(moved: Worths, origin: States) -> tuple[Worths, States]:
    """States at the start of a tick, of which no act has been seen."""
    which = moved.argmax(axis=0)[None]
    fresh, of = np.full(moved.shape, -np.inf), origin.copy()
    fresh[:1], of[:1] = np.take_along_axis(moved, which, 0), np.take_along_axis(origin, which, 0)
    return fresh, of


def _seen(moved: Worths, origin: States, shown: States, gained: Worths) -> tuple[Worths, States]:
    """States after a moment has been shown."""
    best, of = np.full(moved.shape, -np.inf), origin.copy()
    for mask in range(len(moved)):
        now = mask | shown
        value = moved[mask] + gained[now] - gained[mask]
        for after in range(len(moved)):
            better = (now == after) & (value > best[after])
            best[after], of[after] = np.where(better, value, best[after]), np.where(better, origin[mask], of[after])
    return best, of
