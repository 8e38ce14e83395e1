"""Statistics equal values computed by hand, from the definitions."""

import math

import pytest

from hearth.studies.statistical_tests import compare, effect_interval, interval, normality, rank_correlation

ONE = {"a": 5.0, "b": 7.0, "c": 8.0, "d": 6.0, "e": 9.0}
OTHER = {"a": 4.0, "b": 5.0, "c": 8.0, "d": 3.0, "e": 5.0, "alone": 1.0}
# Differences 1, 2, 0, 3, 4: mean 2; squares about it 1 + 0 + 4 + 1 + 4 = 10, variance 10 / 4 = 2.5.


def test_a_paired_t_test_by_hand():
    found = compare("ticks", ("one", "other"), ONE, OTHER, "t(4) = 2.83")
    assert (found.pairs, found.freedom, found.difference) == (5, 4, 2.0)
    error = math.sqrt(2.5 / 5)  # .7071
    assert found.t == pytest.approx(2 / error)  # 2.8284
    # Student's t with 4 degrees of freedom: P(|T| > t) = 1 - x (1.5 - .5 x^2), x = t / sqrt(t^2 + 4).
    x = found.t / math.sqrt(found.t**2 + 4)
    assert found.p == pytest.approx(1 - x * (1.5 - 0.5 * x**2))  # .0474
    assert found.effect == pytest.approx(2 / math.sqrt(2.5))  # 1.2649
    critical = 2.7764451052  # of 4 degrees of freedom at 95 %
    assert (found.low, found.high) == pytest.approx((2 - critical * error, 2 + critical * error))
    # Signed ranks of 1, 2, 3, 4 (the 0 is left out) are all positive: p = 2 / 2^4.
    assert found.signed_p == pytest.approx(2 / 2**4)
    assert (found.normality, found.normality_p) == (None, None), "fewer than eight residuals"
    assert found.thesis == "t(4) = 2.83"


def test_the_interval_of_an_effect_is_where_the_noncentral_t_puts_it():
    from scipy import stats

    low, high = effect_interval(2.0, 16)
    assert stats.nct.sf(2.0, 15, low * 4) == pytest.approx(0.025, abs=1e-6)
    assert stats.nct.cdf(2.0, 15, high * 4) == pytest.approx(0.025, abs=1e-6)
    assert low < 0.5 < high
    for t, pairs in ((15.6, 10), (-8.8, 10), (0.0, 3), (40.0, 30)):
        low, high = effect_interval(t, pairs)
        assert low < t / math.sqrt(pairs) < high


def test_effects_that_no_distribution_tells_and_differences_that_are_rounding():
    assert effect_interval(2_000.0, 6) == (None, None)
    found = compare("reward", ("a", "b"), dict(enumerate([1.0] * 5 + [1.001])), dict.fromkeys(range(6), 0.0))
    assert found.difference == pytest.approx(1.0, abs=1e-3) and found.effect_low is None
    one = {n: 1 - 0.004 * n for n in range(6)}
    other = {n: 1 - 0.004 * (n + 25) for n in range(6)}
    assert compare("reward", ("a", "b"), one, other).t is None


def test_normality_is_of_skewness_and_kurtosis_by_hand():
    values = [2.0, 3.0, 5.0, 6.0, 9.0, 4.0, 4.5, 7.5, 5.5, 20.0]
    count, mean = len(values), math.fsum(values) / len(values)
    m2, m3, m4 = (math.fsum((each - mean) ** power for each in values) / count for power in (2, 3, 4))
    # D'Agostino's Z of skewness (1970), Anscombe and Glynn's of kurtosis (1983).
    y = m3 / m2**1.5 * math.sqrt((count + 1) * (count + 3) / (6.0 * (count - 2)))
    beta = 3.0 * (count**2 + 27 * count - 70) * (count + 1) * (count + 3)
    beta /= (count - 2) * (count + 5) * (count + 7) * (count + 9)
    w2 = -1 + math.sqrt(2 * (beta - 1))
    alpha = math.sqrt(2 / (w2 - 1))
    z1 = math.asinh(y / alpha) / math.sqrt(0.5 * math.log(w2))
    expected = 3 * (count - 1) / (count + 1)
    spread = 24.0 * count * (count - 2) * (count - 3) / ((count + 1) ** 2 * (count + 3) * (count + 5))
    x = (m4 / m2**2 - expected) / math.sqrt(spread)
    root = 6.0 * (count**2 - 5 * count + 2) / ((count + 7) * (count + 9))
    root *= math.sqrt(6.0 * (count + 3) * (count + 5) / (count * (count - 2) * (count - 3)))
    a = 6.0 + 8.0 / root * (2.0 / root + math.sqrt(1 + 4.0 / root**2))
    term = (1 - 2.0 / a) / (1 + x * math.sqrt(2 / (a - 4.0)))
    z2 = (1 - 2 / (9.0 * a) - math.copysign(abs(term) ** (1 / 3), term)) / math.sqrt(2 / (9.0 * a))
    k2, p = normality(values)
    assert k2 == pytest.approx(z1**2 + z2**2)
    assert p == pytest.approx(math.exp(-k2 / 2)), "chi-squared with two degrees of freedom"


def test_values_that_do_not_differ_have_no_test():
    same = compare("ticks", ("one", "other"), ONE, ONE)
    assert (same.t, same.p, same.effect) == (None, None, None)
    assert compare("ticks", ("one", "other"), {"a": 1.0}, {"a": 2.0}).pairs == 1
    assert compare("ticks", ("one", "other"), {}, {}).difference is None


def test_an_interval_of_a_mean_by_hand():
    found, half = interval([1.0, 2.0, 3.0])
    assert (found.value, found.error) == pytest.approx((2.0, 1 / math.sqrt(3)))
    assert half == pytest.approx(4.3026527297 / math.sqrt(3))


def test_a_rank_correlation_by_hand():
    # Ranks 1, 2, 3, 4 and 1, 3, 2, 4: rho = 1 - 6 (0 + 1 + 1 + 0) / (4 (16 - 1)) = .8
    rho, _ = rank_correlation([(0.1, 1.0), (0.2, 3.0), (0.3, 2.0), (0.4, 4.0)])
    assert rho == pytest.approx(0.8)
    assert rank_correlation([(0.1, 1.0), (0.1, 2.0), (0.1, 3.0)]) is None
