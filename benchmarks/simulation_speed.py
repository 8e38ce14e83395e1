"""Run the simulation's benchmarks: `python benchmarks/simulation_speed.py`, three times over `pytest benchmarks`.

Where a process happens to have its sets and states in memory makes half as much again of a difference; so each run is a
process of its own, with its own order of sets, and a figure is the median of theirs, `undisturbed` the least.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Any

from measurement import Figure, as_line, finish, parser

PROCESSES = 3

TARGETS = {
    "test_steps_bare[release]": 250_000,
    "test_steps_keeping_every_state[release]": 200_000,
    "test_bind_and_run": 2_000,
    "test_world_from_known_home": 1 / 20e-6,
    "test_parse_and_build_release_graph": 1 / 3e-3,
}
"""Target rates, units per second."""


def figures(reports: Sequence[dict[str, Any]]) -> list[Figure]:
    """The measurements of pytest-benchmark in each process as rates, with the ratio to their yardstick, if any."""
    found: dict[str, list[dict[str, Any]]] = {}
    for report in reports:
        for bench in report["benchmarks"]:
            found.setdefault(bench["name"], []).append(bench)
    return [_figure(name, found) for name in found if "reference" not in name]


def _figure(name: str, found: dict[str, list[dict[str, Any]]]) -> Figure:
    info = found[name][0]["extra_info"]
    medians = [bench["stats"]["median"] for bench in found[name]]
    spread = max(bench["stats"]["iqr"] / bench["stats"]["median"] for bench in found[name])
    other = found.get(info.get("against", ""))
    best = 1 / _least(found[name])
    unit = f"{info.get('unit', 'run')}s/s"
    ratio = other and _least(other) * best
    return Figure(name, info.get("units", 1) / median(medians), unit, TARGETS.get(name), ratio, spread, best)


def _least(benches: Sequence[dict[str, Any]]) -> float:
    """Seconds a unit."""
    least: float = min(bench["stats"]["min"] for bench in benches)
    return least / benches[0]["extra_info"].get("units", 1)


def measured(file: Path, more: Sequence[str]) -> dict[str, Any]:
    """All benchmarks in a process of their own.

    Raises:
        SystemExit: it failed.
    """
    options = ["--benchmark-only", "--benchmark-disable-gc", "--benchmark-columns=median,iqr,rounds", "-q"]
    command = [sys.executable, "-m", "pytest", Path(__file__).parent, *options, f"--benchmark-json={file}", *more]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stdout + done.stderr)
    return dict(json.loads(file.read_text("utf-8")))


def main() -> None:
    """Run them all."""
    asked, more = parser(__doc__).parse_known_args()
    with tempfile.TemporaryDirectory() as folder:
        found = figures([measured(Path(folder, "report.json"), more) for _ in range(PROCESSES)])
    print(*map(as_line, found), sep="\n")
    finish(found, asked.json)


if __name__ == "__main__":
    main()
