"""Mutated input for every reader: no exception, no record without a row or a reject; every case can be made again."""

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
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.pipelines import corpus, validate
from hearth.pipelines.ingest import READERS, items
from hearth.pipelines.rejects import Reject
from hearth.pipelines.sources import labelled
from hearth.schemas.errors import HearthError
from hearth.schemas.rng import rng

_PROGRAM = "Watch TV\nFrom the sofa.\n\n\n[Walk] <television> (1)\n[SwitchOn] <television> (1)\n[Special] <yawn>\n"
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
            f"{_ROOT}/withoutconds/b/f_1.txt": _PROGRAM,
            f"{_ROOT}/initstate/b/f_1.json": '[{"is_off": ["television", "1"]}]',
            f"{_ROOT}/executable_programs/h_graph/b/f_1.txt": "T\n\n\n[WALK] <bed> (1.1)\n",
            f"{_ROOT}/init_and_final_graphs/h_graph/b/f_1.json": graphs,
        }
    )


_STAGE_1 = (
    "HITId,WorkerId,AssignmentStatus,Input.scene,Answer.title,Answer.description\n"
    'H1,W1,Approved,kitchen,Cook,"Cook, ""well""\nand eat."\nH2,W2,Rejected,kitchen,x,y\n'
)
_STAGE_2 = (
    "HITId,WorkerId,AssignmentStatus,Input.description_id,Input.title,Input.description,Answer.rooms,Answer.props,"
    'Answer.program\nP1,W1,Approved,H1,Cook,Cook.,kitchen*1,"stove*1, pot*2","[Walk] <stove> (1)\n[Find] <pot> (1)"\n'
)

SEEDS: dict[str, Callable[[], bytes]] = {
    "text.txt": (_PROGRAM * 2).encode,
    "descriptions.csv": _STAGE_1.encode,
    "programs.csv": _STAGE_2.encode,
    "release.zip": _release,
    "plain.zip": lambda: _zip({"a.txt": _PROGRAM, "b.csv": _STAGE_1, "c.json": json.dumps(_GRAPH)}),
    "steps.txt": lambda: b"Task: Sleep\n1. Walk to the bed\n2. Lie on it\n3. Sleep\n",
    "steps.json": lambda: json.dumps(["Task: Sleep\nStep 1: Walk to bed\nStep 2: Sleep"] * 2).encode(),
    "records.jsonl": lambda: (
        b'{"title": "T", "steps": ["[Walk] <bed> (1)"]}\n{"title": "D", "description": "Words."}\n'
    ),
    "records.json": lambda: json.dumps([{"title": "T", "steps": [{"action": "Sleep", "objects": []}]}]).encode(),
    "sketches.json": lambda: json.dumps({"answer": [[0, 1]], "represent": [1], "input": [_SKETCH]}).encode(),
    "scene.json": lambda: json.dumps(_GRAPH).encode(),
    "packed.txt.gz": lambda: gzip.compress(_PROGRAM.encode(), mtime=0),
}
"""A small good input for each reader, by file name."""

_NASTY = (
    *(bytes([code]) for code in b'\x00\r",;\t[]<>(){}|'), b"\xff\xfe", b"\xef\xbb\xbf", b"\r\n", b'""',
    b"[Special]", b"(1.1)",
    b"null", b"true", b"-1", b"1e999", b"999999999999999999999", b"../", b"\\", b"[" * 600, b"\xe2\x80\xa8",
    b"\xed\xa0\x80", b"A" * 11_000, b"\n\n\n", b"Step 1:", b"it", b"<char0>", b"NaN",
)  # fmt: skip


@dataclass(slots=True)
class Report:
    """What came of it. `crashes` name the input and the case's number, from which `case` makes it again."""

    cases: int = 0
    records: int = 0
    rows: int = 0
    rejects: int = 0
    refused_whole: int = 0
    codes: Counter[str] = field(default_factory=Counter)
    crashes: list[str] = field(default_factory=list)


def mutated(data: bytes, chance: Random) -> bytes:
    """The data with one to six things done to it."""
    found = bytearray(data)
    for _ in range(chance.randint(1, 6)):
        at = chance.randrange(len(found) + 1)
        span = chance.randint(1, max(1, len(found) // 4))
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
    """Try cases until the time is over, or `most` of them were tried."""
    report = Report()
    end = time.monotonic() + seconds
    with TemporaryDirectory() as folder:
        while time.monotonic() < end and (most is None or report.cases < most):
            name, data = case(seed, report.cases)
            path = Path(folder) / name
            path.write_bytes(data)
            try:
                _attempt(path, known, report)
            except Exception as error:
                report.crashes.append(f"case {report.cases} ({name}): {type(error).__name__}: {error}"[:300])
            report.cases += 1
    return report


def _attempt(path: Path, known: Knowledge, report: Report) -> None:
    try:
        found = list(items(labelled([str(path)])))
    except HearthError as error:
        report.refused_whole += 1
        report.codes.update(str(fault.code) for fault in error.diagnostics[:1])
        return
    if not found:
        raise AssertionError("a file gave neither a record nor a reject")
    for _, item in found:
        report.records += 1
        outputs = list(_outputs(READERS[item.reader](item, "salt"), known))
        if not outputs:
            raise AssertionError(f"nothing came of {item.record_id}")
        for output in outputs:
            if isinstance(output, Reject):
                report.rejects += 1
                report.codes[output.code] += 1
            else:
                report.rows += 1


def _outputs(read: Any, known: Knowledge) -> Iterator[Any]:
    """What a record gives at the end of both stages."""
    for row in [read] if isinstance(read, dict | Reject) else read:
        if isinstance(row, Reject) or row["kind"] != "program":
            yield row
            continue
        done = validate.process(corpus.complete(row) | {"groundings": row.get("groundings")}, known)
        yield from [done] if isinstance(done, Reject) else done
