"""The report of `make bench` on ratios that fall, and the files that it writes."""

from __future__ import annotations

import pytest


@pytest.fixture(scope="module")
def results(module):
    return module("benchmarks/results.py")


def row(name, ratio=None, value=1.0, target=None):
    return {"name": name, "value": value, "unit": "steps/s", "target": target, "ratio": ratio, "spread": 0.1}


def section(*figures):
    return {"day": "2026-01-02", "load": 0.5, "still": 3, "machine": "2 cores", "figures": figures}


def test_a_ratio_that_fell_by_a_third_is_named(results):
    stored = {"engine": section(row("run", 9.0), row("kept", 9.0), row("rate")), "other": section(row("x", 5.0))}
    found = {"engine": section(row("run", 6.1), row("kept", 5.9), row("rate", value=0.1))}
    (message,) = results.fallen(found, stored)
    assert "kept" in message and "9.0" in message and "5.9" in message


def test_a_ratio_that_a_figure_has_no_more_has_fallen(results):
    stored = {"engine": section(row("run", 9.0))}
    assert results.fallen({"engine": section(row("run"))}, stored)
    assert not results.unmeasured({"engine": section(row("run"))}, stored)


def test_what_was_not_measured_is_named_and_has_not_fallen(results):
    stored = {"engine": section(row("run", 9.0)), "other": section(row("x", 5.0))}
    assert not results.fallen({"engine": section()}, stored)
    (message,) = results.unmeasured({"engine": section()}, stored)
    assert "run" in message and "not measured" in message


def test_the_document_says_target_ratio_and_spread(results):
    text = results.document({"engine": section(row("run", 4.5, 290_000.0, 250_000))})
    assert "| run | 2.9e+05 steps/s | 10% |  | 250,000 steps/s | 4.5 x |" in text
    assert "Python 3" in text and "cores" in text
    assert "2026-01-02, on 2 cores, at load 0.5; the machine stood still 3% of the time" in text


@pytest.fixture(scope="module")
def alternate(module):
    return module("benchmarks/checkout_comparison.py")


def turns(alternate, *values, unit):
    """Runs of a benchmark of one row."""
    runs = (alternate.figures([{**row("x", value=value), "unit": unit}]) for value in values)
    return [{("kb", name): found for name, found in run.items()} for run in runs]


@pytest.mark.parametrize(
    ("old", "new", "unit", "verdict"),
    [
        ((100, 101, 102), (95, 94, 93), "steps/s", "ok"),
        ((100, 101, 102), (80, 81, 82), "steps/s", "worse"),
        ((100, 101, 102), (130, 131, 132), "steps/s", "ok"),
        ((100, 101, 102), (130, 131, 132), "ms", "worse"),
        ((100, 101, 102), (80, 81, 82), "MB", "ok"),
        ((100, 140, 70), (80, 81, 82), "steps/s", "ok"),
    ],
)
def test_a_row_is_worse_beyond_a_tenth_and_its_spread(alternate, old, new, unit, verdict):
    (found,) = alternate.compare(turns(alternate, *old, unit=unit), turns(alternate, *new, unit=unit))
    assert found.verdict == verdict
    assert f"| {verdict} |" in alternate.table([found])


def test_of_a_row_the_undisturbed_figure_is_compared_else_its_ratio(alternate):
    best = alternate.figures([{**row("x", 3.0, 7.0), "undisturbed": 9.0}])
    assert best == {"x": ("undisturbed", 9.0, False)}
    assert alternate.figures([{**row("x", 3.0, 7.0), "unit": "s"}]) == {"x": ("ratio", 3.0, False)}


def test_rows_are_found_again_though_their_names_vary(alternate):
    one, other = (
        alternate.figures([row(f"... over that of a tenth ({size} MB)"), row(f"... over that of a tenth ({size} MB)")])
        for size in (120, "1,121")
    )
    assert list(one) == list(other) == ["... over that of a tenth", "... over that of a tenth [2]"]
    assert one["... over that of a tenth"][2]
