"""Count how a reader takes sources: programs, steps, steps read as typos, refused lines, records without a program.

    python benchmarks/reading_counts.py data_raw/crowd tests/messy/plans.jsonl --unpack

The counts of two versions of Hearth on the same sources show what a change of the reader accepts or refuses.

    python benchmarks/reading_counts.py --readings data_raw/written/readings.csv

counts the verdicts of readers of our corpus. A note of 2026 said "195 of 200 read faithful": an author of the corpus
had reread 200 of its programs, and repaired five. It is not a figure of this reader.
"""

from __future__ import annotations

import argparse
import csv
import json
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from hearth.commands.inputs import read_programs
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.storage.rejects import Reject

COLUMNS = ("programs", "steps", "fuzzy", "refused", "rejects", "errors")


def counts(source: Path, known: Knowledge) -> Counter[str]:
    """Return the counts of one source."""
    found: Counter[str] = Counter()
    try:
        for each in read_programs(source, known, source.name):
            if isinstance(each, Reject):
                found["rejects"] += 1
                continue
            found["programs"] += 1
            found["steps"] += len(each.program.steps)
            found["refused"] += len({fault.line for fault in each.faults})
            found["fuzzy"] += sum(warning.code == "FUZZY_MATCH" for warning in each.warnings)
    except HearthError:
        found["errors"] += 1
    return found


def unpacked(file: Path, folder: Path) -> Iterator[Path]:
    """Yield the files of a set of messy plans, each written into a folder of its own."""
    for row in map(json.loads, file.read_text("utf-8").splitlines()):
        place = folder / row["id"]
        place.mkdir()
        (place / row["file"]).write_bytes(row["text"].encode())
        yield place / row["file"]


def verdicts(file: Path) -> Iterator[str]:
    """Yield a line for each reader of a corpus: how many programs it found faithful, repaired and refused."""
    with file.open(encoding="utf-8", newline="") as rows:
        found = Counter((row["reader"], row["verdict"]) for row in csv.DictReader(rows))
    for reader in sorted({reader for reader, _ in found}):
        counted = [(verdict, count) for (name, verdict), count in sorted(found.items()) if name == reader]
        said = ", ".join(f"{count:,} {verdict}" for verdict, count in counted)
        yield f"{reader}: {said} of {sum(count for _, count in counted):,}"


def printed(name: str, total: Counter[str]) -> None:
    """Print the counts of a source."""
    print(name.ljust(34), *(f"{total[column]:,}".rjust(9) for column in COLUMNS))


def main() -> None:
    """Print one line for each source, and one for all of them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sources", nargs="*", type=Path)
    parser.add_argument("--unpack", action="store_true", help="*.jsonl sources are sets of messy plans")
    parser.add_argument("--readings", type=Path, help="verdicts of readers of a corpus, to be counted instead")
    given = parser.parse_args()
    if given.readings:
        print(*verdicts(given.readings), sep="\n")
        return
    known = default()
    print("source".ljust(34), *(name.rjust(9) for name in COLUMNS))
    whole: Counter[str] = Counter()
    for source in given.sources:
        with tempfile.TemporaryDirectory() as folder:
            is_set = given.unpack and source.suffix == ".jsonl"
            files = unpacked(source, Path(folder)) if is_set else iter([source])
            total = sum((counts(file, known) for file in files), Counter())
        printed(source.name, total)
        whole += total
    if len(given.sources) > 1:
        printed("all", whole)


if __name__ == "__main__":
    main()
