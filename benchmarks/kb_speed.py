"""Times of loading the knowledge, and of look-ups: `python benchmarks/kb_speed.py`."""

from __future__ import annotations

import subprocess
import sys
import timeit
from pathlib import Path

import plain_reference
from measurement import Figure, as_line, finish, parser, seconds

from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default

KB = Path(__file__).resolve().parents[1] / "kb/data"
LOAD = 150
"""Target, milliseconds."""

COLD = """
import time
started = time.perf_counter()
from hearth.kb.loading.load import load
load()
print(time.perf_counter() - started)
"""


def cold_loads(times: int = 7) -> list[float]:
    """Seconds to import and load in fresh processes, the quickest first."""
    runs = (subprocess.run([sys.executable, "-c", COLD], capture_output=True, check=True) for _ in range(times))
    return sorted(float(run.stdout) for run in runs)


def lookups(knowledge: Knowledge, number: int = 20_000) -> list[Figure]:
    """Microseconds a look-up."""
    cases = {
        'action("PutBack")': lambda: knowledge.action("PutBack"),
        'action("put back")': lambda: knowledge.action("put back"),
        'object_class("fridge")': lambda: knowledge.object_class("fridge"),
        'object_class("Coffee Table")': lambda: knowledge.object_class("Coffee Table"),
        'same_class("cup")': lambda: knowledge.same_class("cup"),
        'placements("cup")': lambda: knowledge.placements("cup"),
        'holds("fridge")': lambda: knowledge.holds("fridge"),
        'seat_limit("couch")': lambda: knowledge.seat_limit("couch"),
        'affords("Grab", 0, "cup")': lambda: knowledge.affords("Grab", 0, "cup"),
        'default_states("fridge")': lambda: knowledge.default_states("fridge"),
    }
    scan = plain_reference.found_by_scanning(knowledge.objects)
    taken = {
        name: [each / number for each in timeit.repeat(case, number=number, repeat=5)] for name, case in cases.items()
    }
    return [seconds(name, each, "us", ratio=scan.ratio(1, each)) for name, each in taken.items()]


def main() -> None:
    """Measure and print."""
    asked = parser(__doc__).parse_args()
    loads = cold_loads()
    ratio = plain_reference.read_yaml(KB).ratio(1, loads)
    found = [seconds("load the knowledge, importing included", loads, "ms", LOAD, ratio), *lookups(default())]
    for figure in found:
        print(as_line(figure))
    finish(found, asked.json)


if __name__ == "__main__":
    main()
