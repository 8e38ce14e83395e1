"""Mutation testing by drawn mutations: how many of them does a test notice?

    python benchmarks/drawn_mutations.py [--number 600] [--seed 0] [--jobs 2] [--rooms simulation,...] [--json FILE]

Cosmic Ray proposes the mutations (`pip install cosmic-ray pytest-cov`); equally many are drawn in each room. Each is
made in a copy of the checkout, and the quick tests that run its line are run there, the fastest first and then those
that run most of its room, until one fails. A test that is stopped by its time limit has noticed, too. A mutation lives
where all of them pass; it is printed with its reason: `unreached` (no quick test runs the line) or `passed` (the tests
do not depend on it). The status is 1 if fewer than --share of the mutations are noticed. `--coverage FILE` keeps which
test runs which line, and uses it if the file is there.
"""

from __future__ import annotations

import argparse
import json
import os
import queue
import sys
import tempfile
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from math import ceil
from pathlib import Path
from typing import Any, NamedTuple

from chosen_tests import FIRST, Reached, breadths, chosen, measured
from mutated_checkout import copied, pytest_run
from proposed_mutations import Mutation, drawn, mutated

ROOMS = ("simulation", "grounding", "repair", "scoring", "datasets")

STARTING = 30
"""Seconds of the processor that pytest may need before its first test."""


class Result(NamedTuple):
    """The outcome of a mutation."""

    mutation: Mutation
    outcome: str
    """`noticed`, `unreached` or `passed`."""
    line: str
    """The line as the mutation makes it."""
    tests: int
    """The largest number of tests that were run."""


def tried(copy: Path, mutation: Mutation, tests: Sequence[str], seconds: Mapping[str, float]) -> Result:
    """Make the mutation in a copy, run the tests, take it back; tests that take three times as long have noticed."""
    file = copy / mutation.file
    before, times = file.read_text("utf-8"), file.stat()
    after = mutated(before, mutation)
    line = "".join(after.splitlines()[mutation.line - 1 : mutation.line]).strip()  # the last line may be gone
    if not tests:
        return Result(mutation, "unreached", line, 0)
    try:
        file.write_text(after, "utf-8")
        os.utime(file, (times.st_atime, times.st_mtime + 10))  # so that the compiled module is not taken
        for part in (tests[:FIRST], tests[FIRST:]):
            limit = STARTING + 3 * ceil(sum(seconds[test] for test in part))
            status = pytest_run(copy, ["-x", *part], limit) if part else 0
            if status != 0:
                return Result(mutation, "noticed", line, len(tests))
        return Result(mutation, "passed", line, len(tests))
    finally:
        file.write_text(before, "utf-8")
        os.utime(file, (times.st_atime, times.st_mtime))


def run(mutations: Sequence[Mutation], reached: Reached, seconds: Mapping[str, float], jobs: int,
        show: Callable[[Result], None]) -> list[Result]:  # fmt: skip
    """All of them, `jobs` at a time, each in a copy of its own."""
    breadth = breadths(reached)
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(jobs) as pool:
        copies: queue.Queue[Path] = queue.Queue()
        for n in range(jobs):
            copies.put(copied(Path(folder, str(n))))

        def one(mutation: Mutation) -> Result:
            copy = copies.get()
            try:
                result = tried(copy, mutation, chosen(mutation, reached, breadth, seconds), seconds)
            finally:
                copies.put(copy)
            show(result)
            return result

        return list(pool.map(one, mutations))


def _shown(result: Result) -> None:
    m = result.mutation
    operator = m.operator.partition("/")[2]
    print(f"{result.outcome:9} {m.file}:{m.line}:{m.column + 1} {operator}: {result.line}", flush=True)


def summary(results: Sequence[Result]) -> dict[str, Any]:
    """Return the number of mutations that tests noticed, of each room and of all."""
    rooms: dict[str, list[bool]] = defaultdict(list)
    for result in results:
        rooms[result.mutation.file.partition("/")[0]].append(result.outcome == "noticed")
    everything = [noticed for found in rooms.values() for noticed in found]
    return {
        "mutations": len(everything),
        "noticed": sum(everything),
        "share": sum(everything) / max(len(everything), 1),
        "rooms": {room: f"{sum(found)} of {len(found)}" for room, found in rooms.items()},
    }


def _kept(file: Path | None, rooms: Sequence[str], jobs: int) -> tuple[Reached, dict[str, float]]:
    if file is not None and file.exists():
        kept = json.loads(file.read_text("utf-8"))
        return kept["reached"], kept["seconds"]
    reached, seconds = measured(rooms, jobs)
    if file is not None:
        file.write_text(json.dumps({"reached": reached, "seconds": seconds}), encoding="utf-8")
    return reached, seconds


def main(words: Sequence[str] | None = None) -> int:
    """Draw, run, print; 1 if too few are noticed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--number", type=int, default=600, metavar="N")
    parser.add_argument("--seed", type=int, default=0, metavar="N")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, metavar="N")
    parser.add_argument("--rooms", default=",".join(ROOMS), metavar="NAMES")
    parser.add_argument("--share", type=float, default=0.9, metavar="X", help="of the mutations that must be noticed")
    parser.add_argument("--coverage", type=Path, metavar="FILE")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all results here, too")
    asked = parser.parse_args(words)
    rooms = asked.rooms.split(",")
    mutations = drawn(rooms, asked.number, asked.seed)
    reached, seconds = _kept(asked.coverage, rooms, asked.jobs)
    results = run(mutations, reached, seconds, asked.jobs, _shown)
    found = summary(results)
    print(json.dumps(found, indent=1))
    if asked.json:
        rows = [{**r.mutation._asdict(), "outcome": r.outcome, "text": r.line, "tests": r.tests} for r in results]
        asked.json.write_text(json.dumps({**found, "results": rows}, indent=1) + "\n", encoding="utf-8")
    return int(found["share"] < asked.share)


if __name__ == "__main__":
    sys.exit(main())
