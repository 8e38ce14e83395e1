"""Lets the benchmarks import their modules, and prints rates and ratios beside pytest-benchmark's own table."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
if str(HERE) not in sys.path:
    sys.path.insert(0, str(HERE))


def pytest_terminal_summary(terminalreporter: Any, config: Any) -> None:
    """One line per benchmark: median time of a unit, units per second, and speed relative to its yardstick."""
    session = getattr(config, "_benchmarksession", None)
    found = {b.name: b for b in session.benchmarks if b.stats} if session else {}
    if not found:
        return
    terminalreporter.section("rates (medians)")
    for name, bench in found.items():
        each = bench.stats.median / bench.extra_info.get("units", 1)
        unit = bench.extra_info.get("unit", "run")
        line = f"{name:<58} {each * 1e6:>11,.2f} us a {unit:<12} {1 / each:>13,.0f} a second"
        yardstick = found.get(bench.extra_info.get("against", ""))
        if yardstick is not None:
            other = yardstick.stats.median / yardstick.extra_info.get("units", 1)
            line += f"   {other / each:,.1f} times {yardstick.name}"
        terminalreporter.write_line(line)
