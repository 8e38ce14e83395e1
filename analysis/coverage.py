"""Rehearsing: every program of some sources in every home, each in an environment sampled for it; nothing is written.

What can't be is proven: by the two steps that contradict each other, or by the fact that forbids it in any home.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from statistics import fmean
from time import perf_counter, process_time
from typing import Any, NamedTuple

from hearth.datasets.format.cases import environment_of
from hearth.datasets.format.codecs import program_of
from hearth.grounding.environments.default_state import prepared
from hearth.grounding.environments.sampling import USUAL, Environment, Size, sample, unplaceable
from hearth.grounding.preconditions.infer import infer
from hearth.kb.knowledge import Knowledge
from hearth.pipelines import ingest, validate
from hearth.pipelines.engine.build_homes import Homes
from hearth.pipelines.engine.sources import labelled
from hearth.pipelines.engine.workers import Workers
from hearth.pipelines.readers import release
from hearth.pipelines.readers.item import Item
from hearth.schemas.failures import Failure
from hearth.schemas.program import Program
from hearth.schemas.rows import IngestedRow, Row
from hearth.schemas.structs import DifferenceRow
from hearth.storage.rejects import Reject

ANY_HOME = "any home"
"""Where a program is impossible that contradicts itself."""


class Script(NamedTuple):
    """A program of a source, its instances counters."""

    program_id: str
    place: str
    program: Program


@dataclass(slots=True)
class Rehearsal:
    """What became of every program in every home.

    Attributes:
        homes: names.
        programs: how many were read, and `rejected` how many could not be.
        ran: pairs of a program and a home for which an environment was sampled, checked, and run to the program's end.
        impossible: programs that no environment of `ANY_HOME`, or of the home named, lets run, each with why.
        failed: pairs that ought to run and did not, each with why.
        seconds: (wall, processor) spent sampling and checking, inference included; reading and building homes is not.
        nodes: of the environments.
        size: bytes that the environments take in Parquet, all together, as what differs from their homes.
    """

    homes: tuple[str, ...]
    programs: int = 0
    rejected: int = 0
    ran: int = 0
    impossible: list[tuple[Script, str, Failure]] = field(default_factory=list)
    failed: list[tuple[Script, str, Failure]] = field(default_factory=list)
    seconds: tuple[float, float] = (0.0, 0.0)
    nodes: list[int] = field(default_factory=list)
    size: int = 0

    @property
    def pairs(self) -> int:
        """Programs times homes."""
        return self.programs * len(self.homes)

    def _homes_of(self, where: str) -> int:
        return len(self.homes) if where == ANY_HOME else 1

    def summary(self) -> dict[str, Any]:
        """The figures, for printing."""
        codes = Counter(str(failure.code) for _, _, failure in self.failed)
        for _, where, failure in self.impossible:
            codes[str(failure.code)] += self._homes_of(where)
        return {
            "programs": self.programs,
            "unreadable": self.rejected,
            "homes": list(self.homes),
            "pairs": self.pairs,
            "ran": self.ran,
            "proven_impossible": sum(self._homes_of(where) for _, where, _ in self.impossible),
            "failed": len(self.failed),
            "failures_by_code": dict(sorted(codes.items())),
            "seconds": round(self.seconds[0], 3),
            "processor_seconds": round(self.seconds[1], 3),
            "environments_per_processor_second": round(self.ran / self.seconds[1]) if self.seconds[1] else None,
            "nodes_on_average": round(fmean(self.nodes), 1) if self.nodes else None,
            "bytes_an_environment": round(self.size / self.ran) if self.ran else None,
        }


def scripts(sources: Iterable[str], knowledge: Knowledge) -> Iterator[Script | Reject]:
    """The programs of sources in canonical names, stripped of node ids; graphs that came with them stay unread."""
    for _, item in ingest.items(labelled(sources)):
        for row in ingest.read(_without_graphs(item)):
            if isinstance(row, Reject):
                yield row
            elif row["kind"] == "program":
                yield from _checked(row, knowledge)


def _without_graphs(item: Item) -> Item:
    if item.reader != release.NAME:
        return item
    return replace(item, value={**item.value, "graphs": {}})


def _checked(row: IngestedRow, knowledge: Knowledge) -> Iterator[Script | Reject]:
    for found in validate.process({**row, "groundings": None}, knowledge):
        if isinstance(found, Reject):
            yield found
        else:
            yield Script(row["program_id"], row["place"], program_of(found).unbound())


def rehearse(
    programs: Iterable[Script | Reject], homes: Homes, names: Sequence[str], seed: int = 0, size: Size = USUAL
) -> Rehearsal:
    """Sample an environment for every program in every home, check it, and run the program in it.

    Args:
        programs: as of `scripts`.
        homes: where homes come from.
        names: which.
        seed: of the sampling.
        size: nodes wanted; `Size(280, 300)` as the release has.
    """
    found = Rehearsal(tuple(names))
    stored = _Stored()
    for name in names:
        # What is found out once for a home is no part of the time.
        _ = size.base(homes.home(name)).fillers, homes.edges(name)
    # Homes stay: the garbage collector need not look at them again and again (half of the time).
    with Workers():
        for script in programs:
            if isinstance(script, Reject):
                found.rejected += 1
                continue
            found.programs += 1
            environments = _in_every_home(script, homes, found, seed, size)
            stored.add([environment_of(one, homes.edges(name)) for name, one in environments])
            found.nodes.extend(len(one.world.home) for _, one in environments)
    found.size = stored.close()
    return found


def _in_every_home(
    script: Script, homes: Homes, found: Rehearsal, seed: int, size: Size
) -> list[tuple[str, Environment]]:
    environments: list[tuple[str, Environment]] = []
    wall, processor = perf_counter(), process_time()
    conditions = infer(script.program, homes.knowledge)
    if isinstance(conditions, Failure):
        found.impossible.append((script, ANY_HOME, conditions))
    else:
        for name in found.homes:
            drawn = sample(script.program, homes.home(name), seed, script.program_id, conditions, size)
            if isinstance(drawn, Failure):
                proven = unplaceable(script.program, prepared(homes.home(name))) is not None
                (found.impossible if proven else found.failed).append((script, name, drawn))
            else:
                environments.append((name, drawn[0]))
    found.seconds = (found.seconds[0] + perf_counter() - wall, found.seconds[1] + process_time() - processor)
    found.ran += len(environments)
    return environments


class _Stored:
    """How many bytes environments take in Parquet, written to memory in groups as the tables are."""

    _FULL = 500

    def __init__(self) -> None:
        import io

        import pyarrow as pa
        import pyarrow.parquet as pq

        from hearth.schemas.tables import CASE

        self._schema = pa.schema([CASE.field("environment")])
        self._rows: list[Row] = []
        self._bytes = io.BytesIO()
        self._writer = pq.ParquetWriter(self._bytes, self._schema, compression="zstd")

    def add(self, environments: list[DifferenceRow]) -> None:
        """Take more."""
        self._rows.extend({"environment": environment} for environment in environments)
        if len(self._rows) >= self._FULL:
            self._flush()

    def _flush(self) -> None:
        import pyarrow as pa

        if self._rows:
            self._writer.write_table(pa.Table.from_pylist(self._rows, schema=self._schema))
            self._rows = []

    def close(self) -> int:
        """The bytes of the whole file."""
        self._flush()
        self._writer.close()
        return self._bytes.getbuffer().nbytes
