"""Mutation testing of every reader: each record gives a row or a reject, without exceptions; cases are reproducible."""

from __future__ import annotations

import gzip
import io
import json
import time
import zipfile
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from hearth.kb.knowledge import Knowledge
from hearth.pipelines import validate
from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items, read
from hearth.pipelines.readers.recognition_by_content import recognise
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.published_rows import ProgramRow
from hearth.schemas.rng import rng
from hearth.schemas.row_types import Row, StepRow
from hearth.schemas.stage_rows import IngestedRow
from hearth.storage.rejects import Reject

_PROGRAM = "Watch TV\nFrom the sofa.\n\n\n[Walk] <television> (1)\n[SwitchOn] <television> (1)\n[Special] <yawn>\n"
_GOOD = "Sleep\nGo to bed, it is late.\n\n\n[Walk] <bedroom> (1)\n[Walk] <bed> (1)\n[Lie] <bed> (1)\n[Sleep]\n"
_GRAPH = {
    "nodes": [{"id": 1, "class_name": "bed", "category": "Furniture", "properties": ["LIEABLE"], "states": ["CLEAN"]}],
    "edges": [{"from_id": 1, "relation_type": "ON", "to_id": 1}],
}
_SKETCH = {"title": "T", "descr": "D", "prog": ["walk bed"], "prefix": "b/f_1"}
_ROOT = "programs_processed_precond_nograb_morepreconds"


def _zip(files: dict[str, str]) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in files.items():
            archive.writestr(zipfile.ZipInfo(name), text)
    return out.getvalue()


def _release() -> bytes:
    graphs = json.dumps({"init_graph": _GRAPH, "final_graph": _GRAPH})
    return _zip(
        {
            f"{_ROOT}/withoutconds/b/f_1.txt": "T\n\n\n[Walk] <bed> (1)\n",
            f"{_ROOT}/initstate/b/f_1.json": '[{"is_off": ["television", "1"]}]',
            f"{_ROOT}/executable_programs/h_graph/b/f_1.txt": "T\n\n\n[WALK] <bed> (1.1)\n",
            f"{_ROOT}/init_and_final_graphs/h_graph/b/f_1.json": graphs,
        }
    )


def _zstd(data: bytes) -> bytes:
    import pyarrow as pa

    packed: bytes = pa.Codec("zstd").compress(data, asbytes=True)
    return packed


_STAGE_1 = (
    "HITId,WorkerId,AssignmentStatus,Input.scene,Answer.title,Answer.description\n"
    'H1,W1,Approved,kitchen,Cook,"Cook, ""well""\nand eat."\nH2,W2,Rejected,kitchen,x,y\n'
)
_STAGE_2 = (
    "HITId,WorkerId,AssignmentStatus,Input.description_id,Input.title,Input.description,Answer.rooms,Answer.props,"
    'Answer.program\nP1,W1,Approved,H1,Cook,Cook.,kitchen*1,"stove*1, pot*2","[Walk] <stove> (1)\n[Find] <pot> (1)"\n'
)

DATASET = "dataset.parquet"
"""File name of a published dataset's programs; `placed` makes the folder around it."""


def _programs() -> bytes:
    import pyarrow as pa
    import pyarrow.parquet as pq

    from hearth.pipelines.readers.published_dataset import COLUMNS

    step: StepRow = {"agent": 0, "action": "Sleep", "objects": [], "joins": False, "modifiers": [], "line": 1}
    program: ProgramRow = {
        "program_id": "p",
        "activity_id": "t",
        "description_id": "d",
        "parent_id": None,
        "origin": "text",
        "source": "s",
        "place": "p",
        "title": "T",
        "description": "D",
        "split": "train",
        "steps": [step],
        "rooms": None,
        "props": None,
        "worker": None,
        "platform": None,
        "warnings": [],
    }
    out = io.BytesIO()
    pq.write_table(pa.Table.from_pylist([{**program}]).select(COLUMNS), out)
    return out.getvalue()


def placed(folder: Path, name: str, data: bytes) -> Path:
    """Write a case; returns the path of its source."""
    path = folder / name
    if name == DATASET:
        path = folder / "dataset" / "programs" / "part.parquet"
        path.parent.mkdir(parents=True, exist_ok=True)
        (folder / "dataset" / "manifest.json").write_text('{"stage": "publish"}')
    path.write_bytes(data)
    return folder / "dataset" if name == DATASET else path


SEEDS: dict[str, Callable[[], bytes]] = {
    "text.txt": f"{_PROGRAM}\n{_GOOD}\n{_GOOD}".encode,
    "descriptions.csv": _STAGE_1.encode,
    "programs.csv": _STAGE_2.encode,
    "release.zip": _release,
    "plain.zip": lambda: _zip({"a.txt": _GOOD, "b.csv": _STAGE_1, "c.json": json.dumps(_GRAPH)}),
    "steps.txt": lambda: b"Task: Sleep\n1. Walk to the bed\n2. Lie on it\n3. Sleep\n",
    "steps.json": lambda: json.dumps(["Task: Sleep\nStep 1: Walk to bed\nStep 2: Sleep"] * 2).encode(),
    "records.jsonl": lambda: (
        b'{"title": "T", "steps": ["[Walk] <bed> (1)"]}\n{"title": "D", "description": "Words."}\n'
    ),
    "records.json": lambda: json.dumps([{"title": "T", "steps": [{"action": "Sleep", "objects": []}]}]).encode(),
    "sketches.json": lambda: json.dumps({"answer": [[0, 1]], "represent": [1], "input": [_SKETCH]}).encode(),
    "sheet.csv": 'Task;Text;Plan\nNap;"On ""it""";"[Walk] <bed> (1)\n[Sleep]"\nRest;;Walk to bed; Sleep\n'.encode,
    "plan.md": "Sure!\n\n# Nap\n1. **Walk** to bed\n   - It is soft.\n2. [Sleep]\n\nEnjoy!\n# Tea\n- Find cup\n".encode,
    "others.json": lambda: b'{"data": [{"task": "Nap", "plan": ["Walk to bed", "Sleep"]}], "by": {"Nap": ["[Sleep]"]}}',
    "scene.json": lambda: json.dumps(_GRAPH).encode(),
    "packed.txt.gz": lambda: gzip.compress(_GOOD.encode(), mtime=0),
    "packed.txt.zst": lambda: _zstd(_GOOD.encode()),
    DATASET: _programs,
    "wide.txt": lambda: b"\xff\xfe" + _GOOD.encode("utf-16-le"),
}
"""A small good input for each reader, by file name."""

_NASTY = (
    *(bytes([code]) for code in b'\x00\r",;\t[]<>(){}|'), b"\xff\xfe", b"\xef\xbb\xbf", b"\r\n", b'""',
    b"[Special]", b"(1.1)",
    b"null", b"true", b"-1", b"1e999", b"999999999999999999999", b"../", b"\\", b"[" * 600, b"\xe2\x80\xa8",
    b"\xed\xa0\x80", b"A" * 11_000, b"\n\n\n", b"Step 1:", b"it", b"<char0>", b"NaN",
)  # fmt: skip


_GENTLE = 0.5


@dataclass(slots=True)
class ReaderCounts:
    """Counts of one reader's input. Always `records = accepted + rejected`, and `silent` is 0.

    Attributes:
        reader: the reader; `none` for files that were not recognised.
        inputs: number of files.
        refused_whole: number of files rejected as a whole.
        records: number of records in the others.
        accepted: records with a valid program or another row.
        rejected: records with rejects only.
        silent: records without any output; must be 0.
        tracebacks: exceptions other than a `HearthError`.
        longest: greatest seconds for one file.
    """

    reader: str
    inputs: int = 0
    refused_whole: int = 0
    records: int = 0
    accepted: int = 0
    rejected: int = 0
    silent: int = 0
    tracebacks: int = 0
    longest: float = 0.0

    @property
    def adds_up(self) -> bool:
        """Return whether every record has an output."""
        return self.silent == 0 and self.records == self.accepted + self.rejected


@dataclass(slots=True)
class Report:
    """The results. `crashes` name the input and the case's number, from which `case` makes it again."""

    cases: int = 0
    readers: dict[str, ReaderCounts] = field(default_factory=dict)
    codes: Counter[str] = field(default_factory=Counter)
    crashes: list[str] = field(default_factory=list)

    @property
    def records(self) -> int:
        """Number of records in all files."""
        return sum(row.records for row in self.readers.values())

    @property
    def longest(self) -> float:
        """Seconds for the slowest file."""
        return max((row.longest for row in self.readers.values()), default=0.0)

    def row(self, reader: str) -> ReaderCounts:
        """The row of a reader."""
        return self.readers.setdefault(reader, ReaderCounts(reader))

    def table(self) -> list[ReaderCounts]:
        """The rows by name."""
        return [self.readers[name] for name in sorted(self.readers)]


def mutated(data: bytes, chance: Random) -> bytes:
    """The data after one to six mutations, small or large."""
    found = bytearray(data)
    gentle = chance.random() < _GENTLE
    for _ in range(1 if gentle else chance.randint(1, 6)):
        at = chance.randrange(len(found) + 1)
        span = chance.randint(1, 3 if gentle else max(1, len(found) // 4))
        match chance.randrange(6):
            case 0:
                found[at:at] = chance.choice(_NASTY)
            case 1:
                del found[at : at + span]
            case 2:
                found[at:at] = found[at : at + span]
            case 3 if at < len(found):
                found[at] = chance.randrange(256)
            case 4:
                found[at : at + 1] = chance.choice(_NASTY)
            case _:
                del found[at:]
    return bytes(found)


def case(seed: int, number: int) -> tuple[str, bytes]:
    """The name and content of one case."""
    chance = rng(seed, "fuzz", number)
    name = list(SEEDS)[number % len(SEEDS)]
    return name, mutated(SEEDS[name](), chance)


def fuzz(known: Knowledge, seconds: float, seed: int, most: int | None = None) -> Report:
    """Try cases until the time is over, or until `most` were tried."""
    report = Report()
    end = time.monotonic() + seconds
    with TemporaryDirectory() as folder:
        while time.monotonic() < end and (most is None or report.cases < most):
            name, data = case(seed, report.cases)
            path = placed(Path(folder), name, data)
            began = time.process_time()
            row = _attempt(path, known, report)
            row.inputs += 1
            row.longest = max(row.longest, time.process_time() - began)
            report.cases += 1
    return report


def _attempt(path: Path, known: Knowledge, report: Report) -> ReaderCounts:
    """Read and check one file; returns the counts of its reader."""
    reader = "none"
    try:
        readers = {entry.reader for entry in recognise(path, path.name)} - {""}
        reader = next(iter(sorted(readers)), "none")
        found = list(items(labelled([str(path)])))
        if not found:
            raise AssertionError("a file gave neither a record nor a reject")
        for _, item in found:
            _count(list(_outputs(read(item, salt="salt"), known)), report.row(reader), report.codes)
    except HearthError as error:
        report.row(reader).refused_whole += 1
        report.codes.update(str(fault.code) for fault in error.diagnostics[:1])
    except Exception as error:
        report.row(reader).tracebacks += 1
        report.crashes.append(f"case {report.cases} ({path.name}): {type(error).__name__}: {error}"[:300])
    return report.row(reader)


def _count(outputs: list[Row | Reject], row: ReaderCounts, codes: Counter[str]) -> None:
    """Count a record as accepted if it gave any row, and as rejected if it gave only rejects."""
    row.records += 1
    rejects = [output for output in outputs if isinstance(output, Reject)]
    codes.update(reject.code for reject in rejects)
    row.accepted += len(outputs) > len(rejects)
    row.rejected += 0 < len(outputs) == len(rejects)
    row.silent += not outputs


def _outputs(rows: list[IngestedRow | Reject], known: Knowledge) -> Iterator[Row | Reject]:
    """The outputs of a record after both stages."""
    for row in rows:
        if isinstance(row, Reject) or row["kind"] != "program":
            yield row
        else:
            yield from validate.process(row, known)
