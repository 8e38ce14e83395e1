"""Rates of reading, drawing and comparing programs, and five minutes of mutated input.

Seconds are of the processor, the best of three, so that a busy machine slows them less. `--fuzz 0` leaves the fuzzing
out.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from hearth.kb import knowledge
from hearth.pipelines import corpus, fuzzing, spoken, synthesis
from hearth.pipelines.readers import text
from hearth.schemas.program import ObjectRef, Step

COUNT = 20_000


def timed(name: str, units: int, work: Callable[[], object]) -> None:
    best = float("inf")
    for _ in range(3):
        before = time.process_time()
        work()
        best = min(best, time.process_time() - before)
    print(f"{name:<52} {units / best:>12,.0f} a second   {best:>8.3f} s")


def program(number: int) -> str:
    steps = "".join(f"[Walk] <couch> ({place + number % 7})\n" for place in range(1, 12))
    return f"Watch TV\nSit down on the couch. Pick up the remote. Stay until the show is over.\n\n\n{steps}"


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--fuzz", type=float, default=300, metavar="SECONDS")
    asked = arguments.parse_args()
    known = knowledge.default()
    grammar = synthesis.load(synthesis.FILE, known)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "plain.txt"
        file.write_text("\n".join(program(number) for number in range(COUNT)))
        timed(
            "programs of text found and read", COUNT, lambda: [text.read(item) for item in text.scan(file, "plain.txt")]
        )
    words = "Task: T\n" + "".join(f"Step {n}: Walk to the kitchen\n" for n in range(1, 13))
    timed(
        "programs in words understood", 1_000, lambda: [spoken.parse_spoken(words, 0, "", known) for _ in range(1_000)]
    )
    count = synthesis.DEFAULT_COUNT
    timed("programs drawn", count, lambda: list(synthesis.synthesize(count, 0, grammar)))
    drawn = list(synthesis.synthesize(5_000, 0, grammar))
    steps = [tuple(Step(action, tuple(map(ObjectRef, names))) for action, names in one.steps) for one in drawn]
    many = corpus.Corpus(programs=[corpus.Written(str(n), drawn[n].title, "", each) for n, each in enumerate(steps)])
    timed("pairs of 5,000 programs, compared and sorted", 12_497_500, lambda: corpus.similarities(many, workers=1))
    if asked.fuzz:
        report = fuzzing.fuzz(known, asked.fuzz, 0)
        print(
            f"{report.cases:,} cases, {report.records:,} records, {len(report.crashes)} crashes",
            *report.crashes,
            sep="\n",
        )
        return bool(report.crashes)
    return 0


if __name__ == "__main__":
    sys.exit(main())
