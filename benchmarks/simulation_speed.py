"""Run the simulation's benchmarks: `python benchmarks/simulation_speed.py`, the same as `pytest benchmarks`."""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path
from typing import Any

import pytest
from measuring import Figure, finish, parser

TARGETS = {
    "test_steps_bare[release]": 250_000,
    "test_steps_keeping_every_state[release]": 200_000,
    "test_bind_and_run": 2_000,
    "test_world_from_known_home": 1 / 20e-6,
    "test_parse_and_build_release_graph": 1 / 3e-3,
}
"""Units a second that were asked for."""


def figures(report: dict[str, Any]) -> list[Figure]:
    """What pytest-benchmark measured, as rates; those with a yardstick with their ratio to it."""
    found = {bench["name"]: bench for bench in report["benchmarks"]}
    return [_figure(bench, found) for name, bench in found.items() if "reference" not in name]


def _figure(bench: dict[str, Any], found: dict[str, Any]) -> Figure:
    info, stats = bench["extra_info"], bench["stats"]
    each = stats["median"] / info.get("units", 1)
    other = found.get(info.get("against", ""))
    best = info.get("units", 1) / stats["min"]
    ratio = other and other["stats"]["min"] / other["extra_info"].get("units", 1) * best
    unit = f"{info.get('unit', 'run')}s/s"
    target = TARGETS.get(bench["name"])
    return Figure(bench["name"], 1 / each, unit, target, ratio, stats["iqr"] / stats["median"], best)


def main() -> int:
    """Run them all."""
    asked, more = parser(__doc__).parse_known_args()
    options = ["--benchmark-only", "--benchmark-disable-gc", "--benchmark-columns=median,iqr,rounds", "-q"]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "report.json")
        status = pytest.main([str(Path(__file__).parent), *options, f"--benchmark-json={file}", *more])
        if not status:
            finish(figures(json.loads(file.read_text("utf-8"))), asked.json)
    return int(status)


if __name__ == "__main__":
    sys.exit(main())
