"""What every benchmark shares: several runs, their median and spread, and the rows that `make bench` gathers.

A benchmark calls `rate` or `seconds` (or makes its `Figure` itself), prints each with `tell`, and hands all of them to
`finish`, which writes the file that `--json FILE` names. A figure that compares with a plain reference carries the
ratio: it holds on other machines, where the figure itself does not.

Virtual processors stand still for tenths of a second while others have their turn, which clocks of processor time count
as work. `passes` therefore times every item of the work by itself, several times over: the sum of each item's least is
what an undisturbed machine takes at the least (caches are warm by then), given beside the median as `undisturbed`.
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
    """Distance of the quartiles over the median; 0 for one run."""
    undisturbed: float | None = None
    """The same from each item's least time, where items were timed by themselves."""


def runs(work: Callable[[], object], times: int = RUNS, clock: Callable[[], float] = process_time) -> list[float]:
    """Seconds of processor of each of several calls."""
    taken = []
    for _ in range(times):
        began = clock()
        work()
        taken.append(clock() - began)
    return taken


@dataclass(frozen=True)
class Passes:
    """Seconds that each pass over all items took, and the sum of each item's least."""

    totals: list[float]
    least: float


def passes(
    work: Callable[[T], object], items: Sequence[T], times: int = RUNS, clock: Callable[[], float] = perf_counter
) -> Passes:
    """Time every item of the work by itself, in several passes over all of them."""
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
    """How much of its time a loop that only looks at the clock does not get: above some percent, trust no median."""
    began = last = perf_counter()
    lost = 0.0
    while last - began < seconds:
        now = perf_counter()
        if now - last > STALL:
            lost += now - last
        last = now
    return Figure("this machine stands still", 100 * lost / seconds, "% of the time")


STALL = 0.003
"""Seconds between two looks at the clock beyond which the processor was elsewhere."""


def spread(values: list[float]) -> float:
    """Distance of the quartiles over the median."""
    if len(values) < 3:
        return 0.0
    low, _, high = quantiles(values, n=4)
    return (high - low) / median(values) if median(values) else 0.0


Taken = list[float] | Passes


def least(taken: Taken) -> float:
    """The least seconds: of each item, where items were timed by themselves, else of a run."""
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


def tell(figure: Figure) -> str:
    """One line for people."""
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
    """Write the rows where asked for."""
    if file is not None:
        file.write_text(json.dumps([asdict(figure) for figure in figures], indent=1) + "\n", encoding="utf-8")
