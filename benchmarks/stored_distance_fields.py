"""Savings by storing the distance fields of homes: `python benchmarks/stored_distance_fields.py [HOME...]`.

Fields are made when a walk first asks for them, or read from where `home ways` stored them. This prints, for each home,
the processor time of all its fields when they are made, and when they are read and compared with the floor, and what
the files take on disk and in memory that processes share.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from statistics import median
from time import process_time

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.simulation.motion import stored_distance_fields
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.navigation import Ways
from hearth.simulation.world.home import Home

TIMES = 5


def measured(name: str) -> tuple[int, float, float, float]:
    """Of a home: how many fields, seconds to make and to read them (medians), and megabytes stored."""
    known = default()
    here = ground_of(Home.from_graph(library.load_graph(name, known), name, known))
    assert here is not None, name
    floor, every = here.ground.floor, here.ground.every()
    taken: dict[str, list[float]] = {"made": [], "read": []}
    with tempfile.TemporaryDirectory() as folder:
        file = stored_distance_fields.store(here.ground.ways, every, Path(folder))
        for _ in range(TIMES):
            for how, seconds in taken.items():
                ways = Ways(floor)
                assert ways.graph.nnz  # both need it
                begun = process_time()
                if how == "read":
                    ways.stored = stored_distance_fields.StoredWays(ways, Path(folder)).field
                fields = [ways.field(each) for each in every]
                seconds.append(process_time() - begun)
                assert len(fields) == len(every)
        size = file.stat().st_size / 1e6
    return len(every), median(taken["made"]), median(taken["read"]), size


def main() -> None:
    """Print a row for each home."""
    print(f"{'home':10} {'fields':>7} {'made, s':>8} {'read, s':>8} {'MB':>6}")
    rows = [(name, *measured(name)) for name in sys.argv[1:] or library.names()]
    for name, count, made, read, size in rows:
        print(f"{name:10} {count:7} {made:8.3f} {read:8.3f} {size:6.1f}")
    made, read, size = (sum(row[column] for row in rows) for column in (2, 3, 4))
    faster = f"{made / read:.1f} times as fast"
    print(f"all: {made:.2f} s made, {read:.2f} s read ({faster}), {size:.0f} MB that processes share")


if __name__ == "__main__":
    main()
