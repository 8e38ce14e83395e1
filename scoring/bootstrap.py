"""Percentile bootstrap intervals of means, reproducible from a seed."""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from hearth.schemas.rng import derive

RESAMPLES = 1_000
LEVEL = 0.95
DIGITS = 9
"""Decimals of results, so that the order of additions on a machine has no influence."""

_CHUNK = 2_000_000
"""Draws held in memory at a time."""


class Interval(NamedTuple):
    """A mean and its bootstrap interval."""

    mean: float
    low: float
    high: float


def intervals(
    columns: Mapping[str, Sequence[float | None]], seed: int, *, resamples: int = RESAMPLES, level: float = LEVEL
) -> dict[str, Interval]:
    """Return the means of several scores of the same rows, with percentile bootstrap intervals.

    Rows are drawn with replacement, the same for every column. Equal input gives equal output on every machine.

    Args:
        columns: values by name, one per row; None if a row lacks the score. A column of only None is omitted.
        seed: of the run.
        resamples: number of resamples.
        level: share of the resampled means inside the interval.

    Raises:
        ValueError: the columns differ in length.
    """
    import numpy as np

    columns = {name: values for name, values in columns.items() if any(value is not None for value in values)}
    if not columns:
        return {}
    data = np.array([[math.nan if v is None else v for v in values] for values in columns.values()], dtype=np.float64).T
    given = (~np.isnan(data)).astype(np.float64)
    data = np.nan_to_num(data)
    rows = len(data)
    generator = np.random.Generator(np.random.PCG64(derive(seed, "bootstrap")))
    size = max(1, _CHUNK // rows)
    means = []
    for done in range(0, resamples, size):
        drawn = generator.integers(rows, size=(min(size, resamples - done), rows), dtype=np.int64)
        times = np.stack([np.bincount(draw, minlength=rows) for draw in drawn]).astype(np.float64)
        with np.errstate(invalid="ignore"):
            means.append((times @ data) / (times @ given))
    tail = (1 - level) / 2
    low, high = np.nanquantile(np.concatenate(means), [tail, 1 - tail], axis=0).round(DIGITS).tolist()
    return {name: Interval(_mean(values), low[n], high[n]) for n, (name, values) in enumerate(columns.items())}


def _mean(values: Sequence[float | None]) -> float:
    given = [value for value in values if value is not None]
    return round(math.fsum(given) / len(given), DIGITS)
