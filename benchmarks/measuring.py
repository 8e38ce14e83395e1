"""What every benchmark shares: several runs, their median and spread, and the rows that `make bench` gathers.

A benchmark calls `rate` or `seconds` (or makes its `Figure` itself), prints each with `tell`, and hands all of them to
`finish`, which writes the file that `--json FILE` names. A figure that compares with a plain reference carries the
ratio: it holds on other machines, where the figure itself does not.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median, quantiles
from time import process_time

RUNS = 5


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


def runs(work: Callable[[], object], times: int = RUNS, clock: Callable[[], float] = process_time) -> list[float]:
    """Seconds of processor of each of several calls."""
    taken = []
    for _ in range(times):
        began = clock()
        work()
        taken.append(clock() - began)
    return taken


def spread(values: list[float]) -> float:
    """Distance of the quartiles over the median."""
    if len(values) < 3:
        return 0.0
    low, _, high = quantiles(values, n=4)
    return (high - low) / median(values) if median(values) else 0.0


def seconds(name: str, taken: list[float], unit: str = "s", target: float | None = None, **more: float) -> Figure:
    """The median of `taken` (seconds) in `unit`: s, ms or us."""
    factor = {"s": 1.0, "ms": 1e3, "us": 1e6}[unit]
    return Figure(name, median(taken) * factor, unit, target, more.get("ratio"), spread(taken))


def rate(name: str, units: float, taken: list[float], unit: str, target: float | None = None, **more: float) -> Figure:
    """`units` of work over the median of `taken` (seconds)."""
    return Figure(name, units / median(taken), unit, target, more.get("ratio"), spread(taken))


def tell(figure: Figure) -> str:
    """One line for people."""
    goal = "" if figure.target is None else f"  (asked: {figure.target:,g})"
    ratio = "" if figure.ratio is None else f"  {figure.ratio:,.1f} times the plain reference"
    return f"{figure.name:<58} {figure.value:>12,.4g} {figure.unit:<16} +-{figure.spread:4.0%}{goal}{ratio}"


def parser(about: str | None) -> argparse.ArgumentParser:
    """The arguments every benchmark takes."""
    found = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    found.add_argument("--json", type=Path, metavar="FILE", help="write the figures here, too")
    return found


def finish(figures: Iterable[Figure], file: Path | None) -> None:
    """Write the rows where asked for."""
    if file is not None:
        file.write_text(json.dumps([asdict(figure) for figure in figures], indent=1) + "\n", encoding="utf-8")
