"""Verify and query kept builds: `python benchmarks/scale_checks.py FOLDER [FOLDER ...] [--workers 2] [--json FILE]`.

A folder is that of one size below `--keep` of `build_scale.py`. Printed are for each build: wall and processor seconds
of `hearth verify`, which does every execution again, its largest process, and the same of five queries (`QUERIES`),
each asked by a process of its own.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from statistics import median

from build_scale import Watch, augmented, growth, run
from measurement import Figure, as_line, finish

QUERIES = (
    "SELECT split, count(*) FROM programs GROUP BY 1 ORDER BY 1",
    "SELECT a.title, count(*) FROM programs JOIN activities a USING (activity_id) GROUP BY 1 ORDER BY 2, 1 LIMIT 3",
    "SELECT home, avg(executable::int) FROM executions GROUP BY 1 ORDER BY 1",
    "SELECT part, count(DISTINCT program_id) FROM splits WHERE split = 'homes_1_4' GROUP BY 1 ORDER BY 1",
    "SELECT action, count(*) FROM steps GROUP BY 1 ORDER BY 2 DESC, 1 LIMIT 9",
)
"""Over programs, activities, executions, splits and steps."""


def main() -> None:
    """Verify, query and report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", type=Path, nargs="+", metavar="FOLDER")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--json", type=Path, metavar="FILE")
    asked = parser.parse_args()
    figures: list[Figure] = []
    before: list[Figure] = []
    for folder in asked.folders:
        found = checked(folder / "out", asked.workers)
        found += growth(before, found)
        print(*map(as_line, found), sep="\n", flush=True)
        before, figures = found, figures + found
    finish(figures, asked.json)


def checked(out: Path, workers: int) -> list[Figure]:
    """One build's figures."""
    count = augmented(out)
    name = f"{count:,} programs"
    with Watch() as watch:
        run("verify", out, "--workers", workers)
    verified = watch.between(0, float("inf"))
    each: list[float] = []
    most = 0
    for query in QUERIES:
        began = time.perf_counter()
        with Watch(0.02) as watch:
            run("query", out, query)
        each.append(time.perf_counter() - began)
        most = max(most, watch.between(0, float("inf")).bytes)
    return [
        Figure(f"{name}: verified by {workers} workers", verified.seconds, "s"),
        Figure(f"{name}: verified, processor a program", 1e3 * verified.spent / count, "ms"),
        Figure(f"{name}: verified, largest process", verified.bytes / 1e6, "MB", 2_000),
        Figure(f"{name}: a query, median of {len(QUERIES)}", median(each), "s", 10),
        Figure(f"{name}: queried, largest process", most / 1e6, "MB", 2_000),
    ]


if __name__ == "__main__":
    main()
