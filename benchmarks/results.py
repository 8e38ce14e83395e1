"""All figures: `make bench` runs each `*_speed.py`, writes RESULTS.md and results.json, and compares.

    python benchmarks/results.py [--only NAME] [--check]
    python benchmarks/results.py --take NAME=FILE    (what a benchmark outside `make bench` wrote with --json)

A ratio to plain reference code (`plain_reference.py`, `tests/oracles`), measured in the same run, holds on any machine:
one that has fallen by a third against the results.json that is committed fails the run (status 1). With `--check`
nothing is written. Each section has the day of its run and the load of the machine: sections may differ in age.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

from measurement import stalls

HERE = Path(__file__).resolve().parent
TABLE, STORED = HERE / "RESULTS.md", HERE / "results.json"
WORST = 2 / 3
"""Least share of a stored ratio that must remain."""

LIBRARIES = ("numpy", "pyarrow", "duckdb", "open3d-cpu", "opencv-python-headless", "numba", "rapidfuzz")
HEAD = (
    "| figure | measured | spread | undisturbed | asked | to the plain reference |",
    "|---|---:|---:|---:|---:|---:|",
)
Row = dict[str, Any]
Section = dict[str, Any]
"""`day`, `machine`, `load` and `still` (percent of the time) of a benchmark's run, and its `figures`."""


def section(name: str) -> Section:
    """The section of one benchmark, with the machine's load."""
    before = stalls().value
    figures = measured(HERE / f"{name}_speed.py")
    still = (before + stalls().value) / 2
    return {
        "day": datetime.now(UTC).date().isoformat(),
        "load": round(os.getloadavg()[0], 1),
        "still": round(still),
        "machine": machine(),
        "figures": figures,
    }


def of_file(file: Path) -> Section:
    """The section of a benchmark that takes hours, from the figures that it wrote; how busy the machine was, nobody
    measured.
    """
    day = datetime.fromtimestamp(file.stat().st_mtime, UTC).date().isoformat()
    return {
        "day": day,
        "load": None,
        "still": None,
        "machine": machine(),
        "figures": json.loads(file.read_text("utf-8")),
    }


def measured(script: Path) -> list[Row]:
    """The figures of one benchmark, run in a separate process.

    Raises:
        SystemExit: it failed.
    """
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "figures.json")
        status = subprocess.run([sys.executable, str(script), "--json", str(file)], check=False).returncode
        if status or not file.exists():
            raise SystemExit(f"{script.name} failed with status {status}")
        return list(json.loads(file.read_text("utf-8")))


def machine() -> str:
    """A description of the machine."""
    names = (line.split(":", 1)[1].strip() for line in _lines("/proc/cpuinfo") if line.startswith("model name"))
    memory = next((int(line.split()[1]) for line in _lines("/proc/meminfo") if line.startswith("MemTotal")), 0)
    processor = next(names, platform.processor() or "unknown processor")
    return f"{os.cpu_count()} cores ({processor}), {memory / 2**20:.0f} GiB, {platform.system()} {platform.release()}"


def _lines(path: str) -> list[str]:
    try:
        return Path(path).read_text("utf-8").splitlines()
    except OSError:
        return []


def document(found: Mapping[str, Section]) -> str:
    """RESULTS.md."""
    libraries = ", ".join(f"{name} {version(name)}" for name in LIBRARIES)
    lines = [
        "# Results",
        "",
        "Written by `make bench`; not edited by hand. Medians of several runs, with the distance of the quartiles.",
        "`undisturbed` adds up the least time of each item of the work, over several passes: what a machine takes, at",
        "the least, whose processors are not taken away meanwhile. What cannot be timed in parts has no such figure.",
        "The plain reference does the heart of the same work in plain Python (`plain_reference.py`,",
        "`tests/oracles`), often less than we do; ratios compare the least times. One that falls by a third fails",
        "`make bench`. `asked` is what we aim at; a figure may miss it.",
        "",
        f"- Python {platform.python_version()}, {libraries}",
    ]
    for name, one in found.items():
        busy = f", at load {one['load']}; the machine stood still {one['still']}% of the time"
        where = f", on {one['machine']}" if one.get("machine") else ""
        head = f"Measured on {one['day']}{where}{busy if one['load'] is not None else ''}."
        lines += [
            "",
            f"## {name}",
            "",
            head,
            "",
            "| figure | measured | spread | undisturbed | asked | to the plain reference |",
        ]
        lines += ["|---|---:|---:|---:|---:|---:|", *map(_line, one["figures"])]
    return "\n".join(lines) + "\n"


def _line(row: Row) -> str:
    target = "" if row["target"] is None else f"{row['target']:,g} {row['unit']}"
    ratio = "" if row["ratio"] is None else f"{row['ratio']:,.1f} x"
    best = "" if row.get("undisturbed") is None else f"{row['undisturbed']:,.4g}"
    return f"| {row['name']} | {row['value']:,.4g} {row['unit']} | {row['spread']:.0%} | {best} | {target} | {ratio} |"


def fallen(found: Mapping[str, Section], stored: Mapping[str, Section]) -> list[str]:
    """Ratios that have fallen by a third, or that a figure has lost."""
    return [
        f"{name}: {figure}: {before:,.1f} times the plain reference before, {now:,.1f} now"
        for name, figure, before, now in _before_and_now(found, stored)
        if now is not None and now < WORST * before
    ]


def unmeasured(found: Mapping[str, Section], stored: Mapping[str, Section]) -> list[str]:
    """Ratios that were not measured this time, for example because their data are missing."""
    return [
        f"{name}: {figure}: {before:,.1f} times the plain reference before, not measured now"
        for name, figure, before, now in _before_and_now(found, stored)
        if now is None
    ]


def _before_and_now(
    found: Mapping[str, Section], stored: Mapping[str, Section]
) -> Iterator[tuple[str, str, float, float | None]]:
    now = _ratios(found)
    for (name, figure), before in _ratios(stored).items():
        if name in found and before:
            yield name, figure, before, (now[name, figure] or 0.0) if (name, figure) in now else None


def _ratios(sections: Mapping[str, Section]) -> dict[tuple[str, str], float | None]:
    return {(name, row["name"]): row["ratio"] for name, one in sections.items() for row in one["figures"]}


def _stored() -> dict[str, Section]:
    return dict(json.loads(STORED.read_text("utf-8"))) if STORED.exists() else {}


def main(words: Iterable[str] | None = None) -> int:
    """Run, write, compare."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", metavar="NAME", action="append", help="this benchmark only; may be given again")
    parser.add_argument("--take", metavar="NAME=FILE", action="append", default=[], help="figures that are there")
    parser.add_argument("--check", action="store_true", help="compare only")
    asked = parser.parse_args(list(words) if words is not None else None)
    taken = dict(each.split("=", 1) for each in asked.take)
    every = [path.stem.removesuffix("_speed") for path in sorted(HERE.glob("*_speed.py"))]
    names = asked.only or ([] if taken else every)
    found = {name: of_file(Path(file)) for name, file in taken.items()}
    for name in names:
        print(f"--- {name}", flush=True)
        found[name] = section(name)
    stored = _stored()
    worse = fallen(found, stored)
    if not asked.check and not worse:
        whole = dict(sorted({**stored, **found}.items()))
        STORED.write_text(json.dumps(whole, indent=1) + "\n", encoding="utf-8")
        TABLE.write_text(document(whole), encoding="utf-8")
    print(*unmeasured(found, stored), *worse, sep="\n")
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main())
