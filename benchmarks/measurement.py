"""Shared code of the benchmarks: several runs, their median and spread, and the rows that `make bench` gathers.

A benchmark calls `rate` or `seconds` (or makes its `Figure` itself), prints each with `as_line`, and passes all of them
to `finish`, which writes the file of `--json FILE`. A figure with a plain reference has a ratio, which is comparable
across machines.

Virtual processors stop for tenths of a second while others run, which clocks of processor time count as work. `passes`
therefore times every item of the work separately, several times: the sum of each item's least time estimates an
undisturbed machine with warm caches, and is reported beside the median as `undisturbed`.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median, quantiles
from time import perf_counter, process_time
from typing import TypeVar

RUNS = 5
T = TypeVar("T")


@dataclass(frozen=True)
class Figure:
    """One measured number: `target` in the same unit, `ratio` to the plain reference measured in the same run."""

    name: str
    value: float
    unit: str
    target: float | None = None
    ratio: float | None = None
    spread: float = 0.0
    """Interquartile range over the median; 0 for one run."""
    undisturbed: float | None = None
    """The value from each item's least time, if items were timed separately."""


def runs(work: Callable[[], object], times: int = RUNS, clock: Callable[[], float] = process_time) -> list[float]:
    """Processor seconds of each of several calls."""
    taken = []
    for _ in range(times):
        began = clock()
        work()
        taken.append(clock() - began)
    return taken


@dataclass(frozen=True)
class Passes:
    """Seconds of each pass over all items, and the sum of each item's least."""

    totals: list[float]
    least: float


def passes(
    work: Callable[[T], object], items: Sequence[T], times: int = RUNS, clock: Callable[[], float] = perf_counter
) -> Passes:
    """Time every item of the work separately, in several passes over all of them."""
    least = [float("inf")] * len(items)
    totals = []
    for _ in range(times):
        total = 0.0
        for number, item in enumerate(items):
            began = clock()
            work(item)
            taken = clock() - began
            total += taken
            least[number] = min(least[number], taken)
        totals.append(total)
    return Passes(totals, sum(least))


def stalls(seconds: float = 3.0) -> Figure:
    """Share of time that the machine takes from a busy loop; above some percent medians are unreliable."""
    began = last = perf_counter()
    lost = 0.0
    while last - began < seconds:
        now = perf_counter()
        if now - last > STALL:
            lost += now - last
        last = now
    return Figure("this machine stands still", 100 * lost / seconds, "% of the time")


STALL = 0.003
"""Seconds between two readings of the clock that count as a stall."""


def spread(values: list[float]) -> float:
    """Interquartile range over the median."""
    if len(values) < 3:
        return 0.0
    low, _, high = quantiles(values, n=4)
    return (high - low) / median(values) if median(values) else 0.0


Taken = list[float] | Passes


def least(taken: Taken) -> float:
    """The least seconds: summed over items if these were timed separately, else of a run."""
    return taken.least if isinstance(taken, Passes) else min(taken)


def seconds(
    name: str, taken: Taken, unit: str = "s", target: float | None = None, ratio: float | None = None
) -> Figure:
    """The median of `taken` (seconds) in `unit`: s, ms or us."""
    factor = {"s": 1.0, "ms": 1e3, "us": 1e6}[unit]
    return _figure(name, unit, target, ratio, taken, lambda each: each * factor)


def rate(
    name: str, units: float, taken: Taken, unit: str, target: float | None = None, ratio: float | None = None
) -> Figure:
    """`units` of work over the median of `taken` (seconds)."""
    return _figure(name, unit, target, ratio, taken, lambda each: units / each)


def _figure(
    name: str, unit: str, target: float | None, ratio: float | None, taken: Taken, value: Callable[[float], float]
) -> Figure:
    totals, least = (taken.totals, taken.least) if isinstance(taken, Passes) else (taken, None)
    undisturbed = None if least is None else value(least)
    return Figure(name, value(median(totals)), unit, target, ratio, spread(totals), undisturbed)


def as_line(figure: Figure) -> str:
    """A figure as one line of text."""
    goal = "" if figure.target is None else f"  (asked: {figure.target:,g})"
    ratio = "" if figure.ratio is None else f"  {figure.ratio:,.1f} times the plain reference"
    best = "" if figure.undisturbed is None else f"  undisturbed {figure.undisturbed:,.4g}"
    return f"{figure.name:<58} {figure.value:>12,.4g} {figure.unit:<16} +-{figure.spread:4.0%}{best}{goal}{ratio}"


def parser(about: str | None) -> argparse.ArgumentParser:
    """The arguments every benchmark takes."""
    found = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    found.add_argument("--json", type=Path, metavar="FILE", help="write the figures here, too")
    return found


def finish(figures: Iterable[Figure], file: Path | None) -> None:
    """Write the rows to the file, if any."""
    if file is not None:
        file.write_text(json.dumps([asdict(figure) for figure in figures], indent=1) + "\n", encoding="utf-8")
