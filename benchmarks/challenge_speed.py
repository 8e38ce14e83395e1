"""Whole episodes of Watch-And-Help by one process: done, done again, and their bytes.

    python benchmarks/challenge_speed.py [--tasks N] [--times N] [--json FILE]

Each task is done alone and with a helper that plans with the true goal, and written; `challenge verify` does it again.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from time import process_time

from measurement import RUNS, Figure, as_line, finish, parser, rate, spread

from hearth.challenges.episode_agents import Lineup
from hearth.challenges.result_files import read
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite
from hearth.challenges.verification import verify
from hearth.kb.loading.load import default

HELPER = Lineup(helper="hp_true")


def main() -> None:
    """Measure."""
    options = parser(__doc__)
    options.add_argument("--tasks", type=int, default=20)
    options.add_argument("--times", type=int, default=RUNS)
    asked = options.parse_args()
    found = figures(asked.tasks, asked.times)
    for figure in found:
        print(as_line(figure))
    finish(found, asked.json)


def figures(tasks: int, times: int) -> list[Figure]:
    """Episodes a second, and bytes of one. The first run, which fills caches of homes, is not counted."""
    chosen = suite("wah", "test-1", limit=tasks)
    taken: dict[str, list[float]] = {"done": [], "again": []}
    with tempfile.TemporaryDirectory() as folder:
        for number in range(times + 1):
            out = Path(folder) / f"{number}.jsonl"
            began = process_time()
            run(chosen, HELPER, 1, out, default)
            taken["done"].append(process_time() - began)
            began = process_time()
            assert not verify(read(out), str(out), default)
            taken["again"].append(process_time() - began)
        size = out.stat().st_size / (2 * tasks)
    done, again = (taken[name][1:] for name in ("done", "again"))
    return [
        rate("episodes, alone and with a helper in turn", 2 * tasks, done, "episodes/s"),
        rate("the same done again by `challenge verify`", 2 * tasks, again, "episodes/s"),
        Figure("bytes of an episode", size, "bytes", spread=spread([size])),
    ]


if __name__ == "__main__":
    main()
