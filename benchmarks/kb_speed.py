"""How long the knowledge takes to load, and each look-up: `python benchmarks/kb_speed.py`."""

from __future__ import annotations

import subprocess
import sys
import timeit

from hearth.kb.knowledge import Knowledge, default

COLD = """
import time
started = time.perf_counter()
from hearth.kb.knowledge import load
load()
print(time.perf_counter() - started)
"""


def cold_loads(times: int = 7) -> list[float]:
    """Seconds to import and load in fresh processes, the quickest first."""
    runs = (subprocess.run([sys.executable, "-c", COLD], capture_output=True, check=True) for _ in range(times))
    return sorted(float(run.stdout) for run in runs)


def lookups(knowledge: Knowledge, number: int = 20_000) -> dict[str, float]:
    """Microseconds a look-up, the best of five."""
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
    return {name: min(timeit.repeat(case, number=number, repeat=5)) / number * 1e6 for name, case in cases.items()}


if __name__ == "__main__":
    loads = cold_loads()
    print(f"load, importing included: {loads[0] * 1000:.0f} ms at best, {loads[len(loads) // 2] * 1000:.0f} ms median")
    for case, micros in lookups(default()).items():
        print(f"{micros:6.2f} us  {case}")
