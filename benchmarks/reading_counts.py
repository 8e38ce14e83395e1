"""Count how a reader takes sources: programs, steps, steps read as typos, refused lines, records without a program.

    python benchmarks/reading_counts.py data_raw/crowd tests/messy/plans.jsonl --unpack

The counts of two versions of Hearth on the same sources show what a change of the reader accepts or refuses.
"""

from __future__ import annotations

import argparse
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


def main() -> None:
    """Print one line for each source."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sources", nargs="+", type=Path)
    parser.add_argument("--unpack", action="store_true", help="*.jsonl sources are sets of messy plans")
    given = parser.parse_args()
    known = default()
    print("source".ljust(34), *(name.rjust(9) for name in COLUMNS))
    for source in given.sources:
        with tempfile.TemporaryDirectory() as folder:
            is_set = given.unpack and source.suffix == ".jsonl"
            files = unpacked(source, Path(folder)) if is_set else iter([source])
            total = sum((counts(file, known) for file in files), Counter())
        print(source.name.ljust(34), *(f"{total[name]:,}".rjust(9) for name in COLUMNS))


if __name__ == "__main__":
    main()
