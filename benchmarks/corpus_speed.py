"""Rates of ingesting, understanding, drawing and comparing programs, and the peak memory of each reader.

Seconds are processor seconds of one core. Memory is the peak of a separate process that reads an input, and ten times
that input: constant memory is a ratio of about 1. The files are made here; nothing is downloaded.
`--programs N` sets how many programs of text are ingested; `--memory 0` leaves the memory out, 2 everything else.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from random import Random

import plain_reference
from measurement import Figure, as_line, finish, parser, passes, rate, runs, seconds

from hearth.analysis import corpus_statistics, synthesis
from hearth.kb.language import numbered_steps
from hearth.kb.loading.load import default
from hearth.pipelines.readers.crowd import DESCRIPTIONS, PROGRAMS
from hearth.schemas.program import ObjectRef, Step

OBJECTS = ("couch", "bed", "table", "kitchen", "cup", "milk", "fridge", "television", "sofa", "desk", "book")

SLICE = 400
"""Programs drawn per unit of timing."""

INGEST = """
import sys, tempfile, time
from hearth.pipelines.ingest import STAGE
from hearth.pipelines.engine.runner import run_stage
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.workers import Workers
with tempfile.TemporaryDirectory() as out, Workers(1) as workers:
    began = time.process_time()
    counts = run_stage(STAGE, Settings((sys.argv[1],), out), workers).manifest.counts
    taken = time.process_time() - began
# Not ru_maxrss: that begins with what the process that started this one held.
most = next(line for line in open("/proc/self/status") if line.startswith("VmHWM"))
print(counts.records_in, taken, int(most.split()[1]) / 1024)
"""


def steps_of(chance: Random) -> list[str]:
    return [f"[Walk] <{chance.choice(OBJECTS)}> ({chance.randint(1, 3)})" for _ in range(chance.randint(8, 15))]


def description(number: int) -> str:
    return f"Sit down on the couch. Pick up the remote. Stay until show {number} is over and then go to bed."


def as_text(count: int) -> Iterator[str]:
    chance = Random(1)
    for number in range(count):
        yield f"Watch TV {number}\n{description(number)}\n\n\n" + "\n".join(steps_of(chance)) + "\n\n"


def as_words(count: int) -> Iterator[str]:
    for number in range(count):
        steps = "".join(f"Step {n}: Walk to the {OBJECTS[(number * n) % 11]}\n" for n in range(1, 13))
        yield f"Task: Watch TV {number}\n{steps}\n"


def as_records(count: int) -> Iterator[str]:
    chance = Random(1)
    for number in range(count):
        yield json.dumps({"title": "Watch TV", "description": description(number), "steps": steps_of(chance)}) + "\n"


def as_list(entries: Iterable[str]) -> Iterator[str]:
    yield "["
    for number, entry in enumerate(entries):
        yield f"{', ' if number else ''}{entry}"
    yield "]\n"


def as_sketches(count: int) -> Iterator[str]:
    chance = Random(1)
    yield '{"answer": '
    yield from as_list("[1, 0, 1]" for _ in range(count))
    yield ', "input": '
    prog = {"title": "T", "prog": ["Walk couch", "Find cup", "Grab cup"]}
    yield from as_list(
        json.dumps({**prog, "descr": description(n), "prefix": f"b/f_{chance.random()}"}) for n in range(count)
    )
    yield "}"


def as_descriptions(count: int) -> Iterator[str]:
    chance = Random(1)
    yield ",".join(DESCRIPTIONS) + "\n"
    for number in range(count):
        words = " ".join(f"{chance.choice(OBJECTS)}{chance.randint(1, 99)}" for _ in range(22))
        yield f'D{number},W{number % 50},Approved,kitchen,Title {number},"{words}"\n'


def as_answers_of_one_worker(count: int) -> Iterator[str]:
    chance = Random(1)
    yield ",".join(PROGRAMS) + "\n"
    for number in range(count):
        steps = "\n".join(steps_of(chance))
        yield f'P{number},W1,Approved,D{number},Watch TV,"{description(number)}",,,"{steps}"\n'


FORMS: dict[str, tuple[str, int, Callable[[int], Iterator[str]]]] = {
    "program text": ("a.txt", 10_000, as_text),
    "one text without end": ("a.txt", 20_000, lambda n: (description(k) + "\n" for k in range(10 * n))),
    "steps in words": ("a.txt", 5_000, as_words),
    "JSON list of texts": ("a.json", 5_000, lambda n: as_list(map(json.dumps, as_words(n)))),
    "JSON Lines of records": ("a.jsonl", 5_000, as_records),
    "JSON list of records": ("a.json", 5_000, lambda n: as_list(as_records(n))),
    "sketches": ("a.json", 5_000, as_sketches),
    "crowd descriptions": ("a.csv", 5_000, as_descriptions),
    "crowd programs of one worker": ("a.csv", 10_000, as_answers_of_one_worker),
}
"""For each reader a file's name, the number of records in the smaller input, and the function that makes them."""


def ingested(file: Path) -> tuple[int, float, float]:
    """Records, processor seconds and peak MB of the ingest stage in a separate process."""
    done = subprocess.run([sys.executable, "-c", INGEST, str(file)], check=True, capture_output=True, text=True)
    records, seconds, megabytes = done.stdout.split()[-3:]
    return int(records), float(seconds), float(megabytes)


def whole_ingest(folder: Path, programs: int) -> Iterator[Figure]:
    file = folder / "plain.txt"
    with file.open("w") as out:
        out.writelines(as_text(programs))
    yardstick = plain_reference.read_text(list(as_text(2_000)), folder / "plain.jsonl")
    taken = [ingested(file)[1] for _ in range(3)]
    yield rate(
        "programs of text ingested, read to Parquet", programs, taken, "a second", 20_000,
        yardstick.ratio(programs, taken),
    )  # fmt: skip
    with zipfile.ZipFile(folder / "plain.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(file, "plain.txt")
    taken = [ingested(folder / "plain.zip")[1] for _ in range(3)]
    yield rate("the same inside a zip", programs, taken, "a second", 20_000, yardstick.ratio(programs, taken))


def memory(folder: Path) -> Iterator[Figure]:
    for name, (file, count, make) in FORMS.items():
        used = []
        for times in (1, 10):
            path = folder / file
            with path.open("w") as out:
                out.writelines(make(count * times))
            records, _, megabytes = ingested(path)
            used.append(megabytes)
        path.unlink()
        yield Figure(f"most memory, {name}, {records:,} records", used[1], "MB")
        yield Figure(f"... over that of a tenth of them ({used[0]:,.0f} MB)", used[1] / used[0], "times", 1.2)


def others() -> Iterator[Figure]:
    known = default()
    grammar = synthesis.load(synthesis.FILE, known)
    words = "".join(as_words(1))
    split = plain_reference.split_words([words] * 1_000)
    parsed = runs(lambda: [numbered_steps.parse_steps(words, 0, "", known) for _ in range(1_000)])
    yield rate("programs in words understood", 1_000, parsed, "a second", ratio=split.ratio(1_000, parsed))
    drawn = passes(lambda seed: list(synthesis.synthesize(SLICE, seed, grammar)), range(13))
    ratio = plain_reference.drawn_steps().ratio(13 * SLICE, drawn)
    yield rate("programs drawn", 13 * SLICE, drawn, "a second", 5_000, ratio)
    some = list(synthesis.synthesize(5_000, 0, grammar))
    steps = [tuple(Step(action, tuple(map(ObjectRef, names))) for action, names in one.steps) for one in some]
    many = corpus_statistics.Corpus(
        programs=[corpus_statistics.Written(str(n), some[n].title, "", each) for n, each in enumerate(steps)]
    )
    taken = runs(lambda: corpus_statistics.similarities(many, workers=1), 9)
    ratio = plain_reference.textbook_lcs(steps).ratio(len(steps) ** 2, taken)
    yield seconds("all pairs of 5,000 programs compared and sorted", taken, "s", 2.0, ratio)


def main() -> int:
    arguments = parser(__doc__)
    arguments.add_argument("--programs", type=int, default=100_000, metavar="N")
    arguments.add_argument("--memory", type=int, default=1, metavar="0|1|2", help="2 for nothing else")
    asked = arguments.parse_args()
    figures: list[Figure] = []
    with tempfile.TemporaryDirectory() as name:
        parts = [] if asked.memory > 1 else [whole_ingest(Path(name), asked.programs), others()]
        for part in [*parts, memory(Path(name))] if asked.memory else parts:
            for figure in part:
                figures.append(figure)
                print(as_line(figure), flush=True)
    finish(figures, asked.json)
    return 0


if __name__ == "__main__":
    sys.exit(main())
