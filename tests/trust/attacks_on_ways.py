"""Attacks by stored ways, which whoever walks reads: what is read is the shortest way, or it is not taken."""

from __future__ import annotations

import random
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from attack import Attack, Ground

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.simulation.motion import stored_distance_fields
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.navigation import Ways
from hearth.simulation.world.home import Home

HOME = "maple"
FEW = 3


@cache
def walked() -> tuple[Ways, tuple[tuple[int, ...], ...]]:
    """The ways of a home, and the ends of some fields."""
    known = default()
    here = ground_of(Home.from_graph(library.load_graph(HOME, known), HOME, known))
    assert here is not None
    ways = Ways(here.ground.floor)
    return ways, tuple(here.ground.every()[:FEW])


@cache
def stored() -> bytes:
    """A true file."""
    ways, every = walked()
    with TemporaryDirectory() as folder:
        return stored_distance_fields.store(ways, every, Path(folder)).read_bytes()


def read(data: bytes, folder: Path) -> int:
    """Return the number of a file's fields that are read; each of them must equal the computed one."""
    ways, every = walked()
    stored_distance_fields.file_of(ways, folder).write_bytes(data)
    found, taken = stored_distance_fields.StoredWays(ways, folder), 0
    for ends in every:
        field = found.field(ends)
        if field is not None:
            assert np.allclose(field.distance, ways.field(ends).distance, atol=1e-6), "a way that is not the shortest"
            taken += 1
    return taken


def changed(seed: int) -> bytes:
    """A file with some of its bytes changed, or cut."""
    chooser, data = random.Random(seed), bytearray(stored())
    if seed % 5 == 0:
        return bytes(data[: chooser.randrange(len(data))])
    for _ in range(chooser.choice((1, 3, 30, 3_000))):
        data[chooser.randrange(len(data)) if seed % 2 else chooser.randrange(1_000)] = chooser.randrange(256)
    return bytes(data)


def ways() -> Iterator[Attack]:
    """Damaged files, and others than of ways, in place of stored ways."""
    for seed in range(200):

        def load(ground: Ground, seed: int = seed) -> Any:
            return read(changed(seed), ground.folder)

        yield Attack("ways", f"changed {seed}", load)
    for name, data in {"empty": b"", "text": b"ways", "no table": b"ARROW1\0\0" + bytes(100) + b"ARROW1"}.items():
        yield Attack("ways", name, lambda ground, d=data: read(d, ground.folder))
