"""Many episodes: `python benchmarks/challenge_scale.py [--sizes 10000 100000] [--workers 2] [--helper random]`.

Plays the tasks of Watch-And-Help's test-1, half of the episodes alone and half with a helper, writes and verifies the
results, and prints for each size: wall and processor seconds an episode, and the largest process. 100,000 take an hour
or two: with `--keep FOLDER` the results stay there, and the same command goes on after a stop (the times are then those
of the last run only).
"""

from __future__ import annotations

import argparse
from pathlib import Path

from build_scale import Watch, growth, place, run
from measurement import Figure, as_line, finish

from hearth.challenges.task_files import suite

EACH = 2 * len(suite("wah", "test-1").tasks)
"""Episodes of one seed: each task alone, and helped."""


def main() -> None:
    """Play, verify and report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--sizes", type=int, nargs="+", default=[1_000, 10_000], metavar="N", help="episodes of each run"
    )
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--helper", default="random")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="write the results below this folder")
    parser.add_argument("--json", type=Path, metavar="FILE")
    asked = parser.parse_args()
    figures: list[Figure] = []
    before: list[Figure] = []
    for size in asked.sizes:
        with place(asked.keep, size) as folder:
            found = measured(size, asked.workers, asked.helper, folder)
        found += growth(before, found)
        print(*map(as_line, found), sep="\n", flush=True)
        before, figures = found, figures + found
    finish(figures, asked.json)


def measured(size: int, workers: int, helper: str, folder: Path) -> list[Figure]:
    """One run of about `size` episodes."""
    tasks, out, seeds = folder / "tasks.json", folder / "results.jsonl", max(1, round(size / EACH))
    run("challenge", "tasks", "wah", "--split", "test-1", "--out", tasks)
    count, figures = seeds * EACH, []
    for how, words in {
        "played": ("run", tasks, "--helper", helper, "--seeds", seeds, "--out", out),
        "verified": ("verify", out),
    }.items():
        with Watch() as watch:
            run("challenge", *words, "--workers", workers)
        used, name = watch.between(0, float("inf")), f"{count:,} episodes: {how}"
        figures += [
            Figure(f"{name} by {workers} workers", used.seconds, "s"),
            Figure(f"{name}, processor an episode", 1e3 * used.spent / count, "ms"),
            Figure(f"{name}, largest process", used.bytes / 1e6, "MB", 2_000),
        ]
    return [*figures, Figure(f"{count:,} episodes: on disk, an episode", out.stat().st_size / count, "bytes")]


if __name__ == "__main__":
    main()
