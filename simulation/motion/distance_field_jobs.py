"""The ways of homes made beforehand, homes side by side in several processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.stored_distance_fields import store
from hearth.simulation.world.home import Home
from hearth.storage.parallel import Seen, spread, unseen


@dataclass(frozen=True)
class Wanted:
    """A home whose ways are to be stored.

    Attributes:
        name: of the home.
        graph: its scene graph, with boxes.
        known: gives the knowledge.
        place: the folder.
    """

    name: str
    graph: EnvironmentGraph
    known: Callable[[], Knowledge]
    place: Path


class Made(NamedTuple):
    """The stored ways: the home, the number of fields, the cells of each, bytes, and the file."""

    home: str
    fields: int
    cells: int
    bytes: int
    file: str


def make(wanted: Sequence[Wanted], workers: int = 1, seen: Seen = unseen) -> Iterator[Made]:
    """Store the distance fields of everything one can walk to in some homes.

    Raises:
        HearthError: NO_ROOM: a graph without boxes of rooms; UNWRITABLE.
    """
    return spread(made, wanted, workers, seen)


def made(wanted: Wanted) -> Made:
    """Those of one home; errors as of `make`."""
    here = ground_of(Home.from_graph(wanted.graph, wanted.name, wanted.known()))
    if here is None:
        remedy = f"`home convert {wanted.name} FILE.json --layout` gives it boxes"
        raise HearthError.of(Code.NO_ROOM, "rooms without boxes", file=wanted.name, suggestion=remedy)
    every = here.ground.every()
    file = store(here.ground.ways, every, wanted.place)
    return Made(wanted.name, len(every), len(here.ground.ways.cells), file.stat().st_size, str(file))
