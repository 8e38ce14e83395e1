"""Scores of predictions with intervals by activity: activities are drawn with replacement, not programs."""

from collections.abc import Mapping, Sequence

import numpy as np

from hearth.schemas.rng import derive
from hearth.scoring.bootstrap import DIGITS, LEVEL, RESAMPLES, Interval
from hearth.scoring.prediction_scores import METRICS, Scored


def means(found: Sequence[Scored], seed: int = 0) -> dict[str, Interval]:
    """Return the means of all scores, with bootstrap intervals by activity.

    Args:
        found: scores with their activities.
        seed: of the drawing.
    """
    columns = {name: [metric(each) for each in found] for name, metric in METRICS.items()}
    return by_group(columns, [str(each.pair.more["activity"]) for each in found], seed)


def by_group(
    columns: Mapping[str, Sequence[float | None]], groups: Sequence[str], seed: int, resamples: int = RESAMPLES
) -> dict[str, Interval]:
    """Return the means of some scores of the same rows, with percentile intervals where whole groups are drawn.

    Args:
        columns: values by name, one a row; None where a row lacks the score. A column of only None is omitted.
        groups: the group of each row.
        seed: of the drawing.
        resamples: number of resamples.
    """
    columns = {name: values for name, values in columns.items() if any(value is not None for value in values)}
    if not columns:
        return {}
    names, place = np.unique(np.array(groups), return_inverse=True)
    generator = np.random.Generator(np.random.PCG64(derive(seed, "bootstrap by group")))
    drawn = generator.integers(len(names), size=(resamples, len(names)), dtype=np.int64)
    times = np.stack([np.bincount(draw, minlength=len(names)) for draw in drawn]).astype(np.float64)  # (R, G)
    tail = (1 - LEVEL) / 2
    intervals = {}
    for name, column in columns.items():
        values = np.array([np.nan if value is None else value for value in column], dtype=np.float64)
        given = ~np.isnan(values)
        sums = np.bincount(place[given], values[given], len(names))
        counts = np.bincount(place[given], minlength=len(names)).astype(np.float64)
        with np.errstate(invalid="ignore", divide="ignore"):
            low, high = np.nanquantile((times @ sums) / (times @ counts), [tail, 1 - tail]).round(DIGITS).tolist()
        intervals[name] = Interval(round(float(sums.sum() / counts.sum()), DIGITS), low, high)
    return intervals
