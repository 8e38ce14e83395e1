"""What storing distance fields beside homes would save: `python benchmarks/stored_fields.py [HOME...]`.

Fields are made when a walk first asks for them, and kept in memory. This prints, for each of our homes, what all fields
of its furniture cost when they are made and when they are read from a file, and how large that is: storing has to earn
its files, its digests and its faults. A run of a challenge pays it once for each home and process.
"""

from __future__ import annotations

import io
import sys
from array import array
from time import process_time

import numpy as np

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.navigation import Field
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home


def measured(name: str) -> tuple[int, float, float, float]:
    """Of a home: how many fields, seconds to make and to read them, and megabytes stored."""
    known = default()
    home = Home.from_graph(library.load_graph(name, known), name, known)
    here = ground_of(home)
    assert here is not None, name
    ends = sorted({here.ground.stands(i) for i in indices(home.everything)} - {()})
    begun = process_time()
    fields = [here.ground.ways.field(each) for each in ends]
    made = process_time() - begun
    file = io.BytesIO()
    np.savez(file, *(np.asarray(part) for field in fields for part in field))
    begun = process_time()
    stored = np.load(io.BytesIO(file.getvalue()), allow_pickle=False)
    parts = [stored[each] for each in stored.files]
    read = [
        Field(array("d", a.tobytes()), array("i", b.tobytes())) for a, b in zip(parts[::2], parts[1::2], strict=True)
    ]
    assert read == fields
    return len(fields), made, process_time() - begun, len(file.getvalue()) / 1e6


def main() -> None:
    """Print a row for each home."""
    print(f"{'home':10} {'fields':>7} {'made, s':>8} {'read, s':>8} {'MB':>6}")
    rows = [(name, *measured(name)) for name in sys.argv[1:] or library.names()]
    for name, count, made, read, size in rows:
        print(f"{name:10} {count:7} {made:8.3f} {read:8.3f} {size:6.1f}")
    saved, size = sum(row[2] - row[3] for row in rows), sum(row[4] for row in rows)
    print(f"storing all saves {saved:.2f} s of a process that needs every field of every home, for {size:.0f} MB")


if __name__ == "__main__":
    main()
