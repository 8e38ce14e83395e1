"""Tests of a study, as the thesis has them (6.6, B.4.4, C.5.2).

These are paired two-tailed t-tests and the normality of their residuals. Differences, effect sizes and intervals of 95
% are added; the thesis lacks them.

scipy has all of it. statsmodels was weighed and left out: the thesis does not report its addition, mixed models, and
pairs by task account for tasks that differ.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from hearth.challenges.metrics import Mean, mean, paired

CONFIDENCE = 0.95
FEWEST_NORMAL = 8
"""Values of which D'Agostino and Pearson's test can be computed."""


@dataclass(frozen=True, slots=True)
class Comparison:
    """A paired comparison over tasks or films.

    Attributes:
        metric: the compared metric.
        one, other: the two sides of the comparison.
        pairs: how many.
        difference, low, high: mean of one less other, and its interval.
        t, freedom, p: of the paired two-tailed t-test.
        effect, effect_low, effect_high: mean difference in its standard deviations (Cohen's d of pairs), and its
            interval by the noncentral t distribution.
        normality, normality_p: D'Agostino and Pearson's K2 of the residuals, which are the differences, and its p.
        signed_p: of Wilcoxon's signed-rank test, for residuals that are not normal.
        thesis: the thesis's report on the same comparison.
    """

    metric: str
    one: str
    other: str
    pairs: int
    difference: float | None = None
    low: float | None = None
    high: float | None = None
    t: float | None = None
    freedom: int = 0
    p: float | None = None
    effect: float | None = None
    effect_low: float | None = None
    effect_high: float | None = None
    normality: float | None = None
    normality_p: float | None = None
    signed_p: float | None = None
    thesis: str = ""


def compare(
    metric: str, names: tuple[str, str], one: Mapping[Any, float], other: Mapping[Any, float], thesis: str = ""
) -> Comparison:
    """Compare two values of each task or film that has both.

    Args:
        metric: the metric of the values.
        names: of the two.
        one, other: the values by task or film.
        thesis: the thesis's report.
    """
    from scipy import stats

    keys = [key for key in one if key in other]
    test = paired(one, other)
    differences = [one[key] - other[key] for key in keys]
    if len(keys) < 2 or test.t is None:
        average = mean(differences).value if differences else None
        return Comparison(metric, *names, len(keys), average, freedom=test.freedom, thesis=thesis)
    found = mean(differences)
    assert found.error is not None and test.effect is not None
    half = float(stats.t.ppf((1 + CONFIDENCE) / 2, test.freedom)) * found.error
    low, high = effect_interval(test.t, len(keys))
    k2, k2_p = normality(differences)
    return Comparison(
        metric, *names, len(keys), found.value, found.value - half, found.value + half, test.t, test.freedom, test.p,
        test.effect, low, high, k2, k2_p, signed_rank(differences), thesis,
    )  # fmt: skip


LARGEST_T = 200.0
"""Beyond it scipy's noncentral distribution is not reliable."""


def effect_interval(t: float, pairs: int) -> tuple[float | None, float | None]:
    """Return the interval of Cohen's d of pairs: of which true values the observed t is neither too high nor too low.

    None for both where t is beyond `LARGEST_T`.
    """
    from scipy import optimize, stats

    if abs(t) > LARGEST_T:
        return None, None
    root, freedom, tail = math.sqrt(pairs), pairs - 1, (1 - CONFIDENCE) / 2

    def end(share: float, step: float) -> float:
        def far(shift: float) -> float:
            return float(stats.nct.cdf(t, freedom, shift)) - share

        other = t + step
        while far(other) * step > 0:  # far off, scipy's distribution is not a number
            other += step
        return float(optimize.brentq(far, *sorted((t, other)))) / root

    return end(1 - tail, -0.5), end(tail, 0.5)


def normality(values: Sequence[float]) -> tuple[float | None, float | None]:
    """D'Agostino and Pearson's K2 and its p; None of fewer than eight values, or of equal ones."""
    from scipy import stats

    if len(values) < FEWEST_NORMAL or max(values) - min(values) < 1e-12:
        return None, None
    found = stats.normaltest(values)
    return float(found.statistic), float(found.pvalue)


def signed_rank(values: Sequence[float]) -> float | None:
    """Return the p of Wilcoxon's signed-rank test, two-tailed."""
    from scipy import stats

    return float(stats.wilcoxon(values).pvalue) if any(values) else None


def interval(values: Sequence[float]) -> tuple[Mean, float]:
    """Return the mean with its standard error, and half the width of its interval by the t distribution.

    The width is 0 for one value.
    """
    from scipy import stats

    found = mean(values)
    if found.error is None:
        return found, 0.0
    return found, float(stats.t.ppf((1 + CONFIDENCE) / 2, len(values) - 1)) * found.error


def rank_correlation(pairs: Sequence[tuple[float, float]]) -> tuple[float, float] | None:
    """Spearman's rho and its p; None where one side is constant."""
    from scipy import stats

    if len(pairs) < 3 or any(len({pair[side] for pair in pairs}) < 2 for side in (0, 1)):
        return None
    found = stats.spearmanr([one for one, _ in pairs], [other for _, other in pairs])
    return float(found.statistic), float(found.pvalue)
