"""How sure a mean is: percentile bootstrap intervals, reproducible from a seed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from hearth.schemas.rng import derive

RESAMPLES = 1_000
LEVEL = 0.95
_CHUNK = 2_000_000
"""Draws held in memory at a time."""


class Interval(NamedTuple):
    """A mean and the interval its bootstrap resamples fall into."""

    mean: float
    low: float
    high: float


def interval(
    values: Sequence[float], seed: int, name: str = "", *, resamples: int = RESAMPLES, level: float = LEVEL
) -> Interval:
    """The mean of values and its percentile bootstrap interval.

    Equal values in equal order give equal bytes, whatever else was drawn before.

    Args:
        values: at least one.
        seed: of the run.
        name: what the values are, so that two scores of one run are resampled independently.
        resamples: how many means are drawn.
        level: how many of them lie inside.

    Raises:
        ValueError: there are no values.
    """
    import numpy as np

    if not values:
        raise ValueError("no values to resample")
    data = np.asarray(values, dtype=np.float64)
    generator = np.random.Generator(np.random.PCG64(derive(seed, "bootstrap", name)))
    rows = max(1, _CHUNK // len(data))
    means = np.concatenate(
        [
            data[generator.integers(len(data), size=(min(rows, resamples - done), len(data)))].mean(axis=1)
            for done in range(0, resamples, rows)
        ]
    )
    tail = (1 - level) / 2
    low, high = np.quantile(means, [tail, 1 - tail]).tolist()
    return Interval(float(data.mean()), low, high)
