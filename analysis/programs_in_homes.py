"""Runs of every program of some sources in every home, in environments sampled for it; nothing is written.

Impossible programs are proven: by two contradictory steps, or by a fact that forbids the program in any home.
"""

import io
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from statistics import fmean
from time import perf_counter, process_time
from typing import Any, NamedTuple

import pyarrow as pa
import pyarrow.parquet as pq

from hearth.datasets.format.case_rows import environment_of
from hearth.datasets.format.row_conversion import program_of
from hearth.grounding.environments.default_state import prepared
from hearth.grounding.environments.sampling import USUAL, Environment, Size, sample, unplaceable
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.kb.knowledge import Knowledge
from hearth.pipelines import ingest, validate
from hearth.pipelines.engine.build_homes import Homes
from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.engine.workers import Workers
from hearth.pipelines.readers import release
from hearth.pipelines.readers.reader_items import Item
from hearth.schemas.failures import Failure
from hearth.schemas.program import Program
from hearth.schemas.row_types import DifferenceRow, Row
from hearth.schemas.stage_rows import IngestedRow
from hearth.schemas.tables import CASE
from hearth.simulation.rules import rules_of
from hearth.storage.batch_sizes import ENVIRONMENTS_MEASURED
from hearth.storage.rejects import Reject

ANY_HOME = "any home"
"""The place of programs that are impossible because they contradict themselves."""


class Script(NamedTuple):
    """An unbound program of a source."""

    program_id: str
    place: str
    program: Program


@dataclass(slots=True)
class Coverage:
    """The results of all pairs of a program and a home.

    Attributes:
        homes: names.
        programs: number of programs read; `rejected`: number of unreadable ones.
        ran: number of pairs whose environment was sampled and checked, and whose program ran to its end.
        impossible: programs proven impossible in `ANY_HOME`, or in the named home, each with the failure.
        failed: other pairs that did not run, each with the failure.
        seconds: (wall, processor) of inference, sampling and checking, without reading and building homes.
        nodes: numbers of nodes of the environments.
        size: bytes of all environments in Parquet, as differences from their homes.
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
        """Number of programs times number of homes."""
        return self.programs * len(self.homes)

    def _homes_of(self, where: str) -> int:
        return len(self.homes) if where == ANY_HOME else 1

    def summary(self) -> dict[str, Any]:
        """Return the figures, for printing."""
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
    """Yield the programs of sources with canonical names and without node ids; graphs of a release are not read."""
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


def measure_coverage(
    programs: Iterable[Script | Reject], homes: Homes, names: Sequence[str], seed: int = 0, size: Size = USUAL
) -> Coverage:
    """Sample an environment for every program in every home, check it, and run the program in it.

    Args:
        programs: as `scripts` gives them.
        homes: the source of homes.
        names: of the homes.
        seed: of the sampling.
        size: number of nodes; `Size(280, 300)` as in the release.
    """
    found = Coverage(tuple(names))
    stored = _Stored()
    for name in names:
        # Properties computed once per home are not part of the measured time.
        _ = size.base(homes.home(name)).fillers, homes.edges(name)
    # Homes stay in memory: without this the garbage collector scans them repeatedly (half of the time).
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
    script: Script, homes: Homes, found: Coverage, seed: int, size: Size
) -> list[tuple[str, Environment]]:
    environments: list[tuple[str, Environment]] = []
    wall, processor = perf_counter(), process_time()
    rules = rules_of(homes.knowledge)
    conditions = infer(script.program, homes.knowledge, rules)
    if isinstance(conditions, Failure):
        found.impossible.append((script, ANY_HOME, conditions))
    else:
        for name in found.homes:
            drawn = sample(script.program, homes.home(name), seed, script.program_id, conditions, size, rules)
            if isinstance(drawn, Failure):
                proven = unplaceable(script.program, prepared(homes.home(name))) is not None
                (found.impossible if proven else found.failed).append((script, name, drawn))
            else:
                environments.append((name, drawn[0]))
    found.seconds = (found.seconds[0] + perf_counter() - wall, found.seconds[1] + process_time() - processor)
    found.ran += len(environments)
    return environments


class _Stored:
    """Measures the bytes of environments in Parquet, written to memory in row groups as in the tables."""

    def __init__(self) -> None:
        self._schema = pa.schema([CASE.field("environment")])
        self._rows: list[Row] = []
        self._bytes = io.BytesIO()
        self._writer = pq.ParquetWriter(self._bytes, self._schema, compression="zstd")

    def add(self, environments: list[DifferenceRow]) -> None:
        """Add environments."""
        self._rows.extend({"environment": environment} for environment in environments)
        if len(self._rows) >= ENVIRONMENTS_MEASURED:
            self._flush()

    def _flush(self) -> None:
        if self._rows:
            self._writer.write_table(pa.Table.from_pylist(self._rows, schema=self._schema))
            self._rows = []

    def close(self) -> int:
        """Return the bytes of the whole file."""
        self._flush()
        self._writer.close()
        return self._bytes.getbuffer().nbytes
