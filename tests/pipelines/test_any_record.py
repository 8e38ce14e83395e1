"""Whatever a record holds, and whatever a stage's function does with it: it alone is refused, and the build goes on."""

from __future__ import annotations

import json
from dataclasses import replace
from types import SimpleNamespace

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from hearth.pipelines import ingest
from hearth.pipelines.engine.runner import run_stage
from hearth.pipelines.engine.settings import Settings
from hearth.pipelines.engine.stage import Partition, Stage
from hearth.pipelines.readers import json_records
from hearth.pipelines.readers.crowd import DESCRIPTIONS
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.storage.rejects import INTERNAL_ERROR, Reject

GOOD = {"title": "Nap", "description": "On it.", "steps": ["[Walk] <bed> (1)"]}

SCHEMA = pa.schema([("program_id", pa.string()), ("number", pa.int32()), ("half", pa.int32())])


def partitions(job):
    for share in range(4):
        yield Partition(share, f"share {share}", list(range(share * 25, share * 25 + 25)), 25)


def records(job, partition):
    return ({"program_id": f"n{number}", "number": number} for number in partition.payload)


STAGE = Stage("count", {"": SCHEMA}, lambda record, context: [record], partitions=partitions, records=records)


@pytest.fixture
def settings(tmp_path):
    source = tmp_path / "numbers.txt"
    source.write_text("0 to 99")
    return Settings((str(source),), str(tmp_path / "out"))


def rejects(result):
    return pq.read_table(result.manifest.folder / "rejects.parquet").to_pylist()


class UnprintableError(Exception):
    def __str__(self):
        raise ValueError("it cannot be printed")


class PanicError(BaseException):
    """As compiled libraries raise them: not an `Exception`."""


class Explosive:
    def __getattr__(self, name):
        raise RuntimeError(name)

    def __eq__(self, other):
        raise RuntimeError

    __hash__ = None


def raising(error):
    def process():
        raise error

    return process


def row(**changed):
    return {"program_id": "n5", "number": 5, "half": 0, **changed}


OUTPUTS = {
    "an exception that cannot be printed": raising(UnprintableError()),
    "an exception that is not text": raising(ValueError("\udc80\x00")),
    "recursion": raising(RecursionError("too deep")),
    "no memory": raising(MemoryError()),
    "a panic": raising(PanicError("index out of bounds")),
    "an error without a fault": raising(HearthError([])),
    "an error whose line is a huge number": raising(HearthError(Diagnostic(Code.EMPTY, "?", "f", 2**40, -(2**70)))),
    "None": lambda: None,
    "a number": lambda: 7,
    "a generator that breaks": lambda: (1 / 0 for _ in "x"),
    "an output that is None": lambda: [None],
    "an output that is an object": lambda: [Explosive()],
    "a pair that names an unknown table": lambda: [("elsewhere", row())],
    "a tuple of three": lambda: [("", row(), 1)],
    "a row that is a list": lambda: [["program_id", "n5"]],
    "a row whose names are numbers": lambda: [{5: 5}],
    "half a character": lambda: [row(program_id="\ud800")],
    "a number of 65 bits": lambda: [row(number=2**64)],
    "an object in a cell": lambda: [row(number=Explosive())],
    "a reject of half a character": lambda: Reject.of(Code.EMPTY, "\ud800", file="\udcff", found="\ud800\x1b"),
    "a reject without a fault": lambda: Reject(()),
    "a reject that holds other types": lambda: Reject.of(Code.EMPTY, 7, file=None, found=b"x", line="third"),
}


@pytest.mark.parametrize("name", OUTPUTS)
def test_whatever_a_function_does_costs_only_its_record(settings, name):
    def process(record, context):
        return OUTPUTS[name]() if record["number"] == 5 else [row(program_id=record["program_id"])]

    result = run_stage(replace(STAGE, process=process), settings)
    counts = result.manifest.counts
    assert (counts.records_in, counts.through, counts.rejected, counts.rows.total()) == (100, 99, 1, 99)
    (refused,) = rejects(result)
    assert refused["record_id"] == "n5" and refused["code"] in counts.codes
    assert "�" not in refused["message"] and refused["message"]


@pytest.mark.parametrize(
    "record", [None, 7, "text", Explosive(), SimpleNamespace()], ids=lambda value: type(value).__name__
)
def test_a_record_of_any_type_is_refused(settings, record):
    stage = replace(
        STAGE,
        process=lambda record, context: [row(program_id=record["program_id"])],
        records=lambda job, partition: iter([{"program_id": "before"}, record, {"program_id": "after"}]),
    )
    result = run_stage(stage, settings)
    assert (result.manifest.counts.through, result.manifest.counts.rejected) == (8, 4)
    assert {row["code"] for row in rejects(result)} == {INTERNAL_ERROR}


def test_a_count_that_breaks_costs_only_its_record(settings):
    stage = replace(
        STAGE, process=lambda record, context: [row(**record)], labels=lambda row: (str(1 / (row["number"] - 5)),)
    )
    counts = run_stage(stage, settings).manifest.counts
    assert (counts.through, counts.rejected, counts.rows.total(), counts.tally.total()) == (99, 1, 99, 99)


def test_an_interrupt_is_not_a_reject(settings):
    with pytest.raises(KeyboardInterrupt):
        run_stage(replace(STAGE, process=lambda record, context: raising(KeyboardInterrupt())()), settings)


def ingested(built, *paths):
    made = built(*paths)
    counts = made.run("ingest").manifest.counts
    assert counts.records_in == counts.through + counts.rejected
    return [row["title"] for row in made.rows("ingest")], [row for row in made.rejects("ingest") if not row["partial"]]


def test_a_crowd_row_that_is_not_text_and_has_too_few_cells(built, write):
    head = ",".join(DESCRIPTIONS)
    rows = [b"H1,W1,Approved,home,Nap,On it.", b"H2,W2,Appro\xffved", b"H3,W3,Approved,home,Read,A book."]
    titles, refused = ingested(built, write("a.csv", b"\n".join([head.encode(), *rows, b""])))
    assert titles == ["Nap", "Read"]
    assert [(row["code"], row["line"]) for row in refused] == [("BAD_TABLE", 3)]


@pytest.mark.parametrize("depth", [200, 250, 255, 300, 500, 1_000, 1_024, 1_100, 100_000])
@pytest.mark.parametrize("form", ["lines", "list", "document"])
def test_deep_json_is_refused_alone(built, write, depth, form):
    deep = f'{{"title": "Deep", "steps": {"[" * depth}{"]" * depth}}}'
    entries = [json.dumps(GOOD), deep, json.dumps({**GOOD, "title": "Read"})]
    texts = {"lines": "\n".join(entries), "list": f"[{','.join(entries)}]", "document": deep}
    write("b.jsonl", json.dumps({**GOOD, "title": "Beside"}))
    titles, refused = ingested(built, write("a.json", texts[form]).parent)
    assert titles == (["Beside"] if form == "document" else ["Nap", "Read", "Beside"])
    assert [row["code"] for row in refused] == ["BAD_JSON"]


@pytest.mark.parametrize("name", [b"a\xff.txt", b"a\xff.jsonl", b"a\xff.csv"])
def test_a_file_whose_name_is_not_text(built, write, name):
    folder = write("b.jsonl", json.dumps(GOOD)).parent
    text = b"Nap\nOn it.\n\n[Walk] <bed> (1)\n" if name.endswith(b"txt") else json.dumps(GOOD).encode() + b"\n"
    with open(bytes(folder) + b"/" + name, "wb") as file:  # noqa: PTH123 - pathlib has no bytes
        file.write(text)
    titles, _ = ingested(built, folder)
    assert "Nap" in titles


def test_a_reader_that_breaks_while_it_looks_for_records(built, write, monkeypatch):
    def scan(path, place, columns):
        yield from json_records.items(GOOD, place, 1, place, columns)
        raise IndexError("a fault of the reader")

    monkeypatch.setitem(ingest.SCANNERS, json_records.NAME, scan)
    titles, refused = ingested(built, write("a.jsonl", json.dumps(GOOD) + "\n" + json.dumps(GOOD)))
    assert titles == ["Nap"]
    assert [row["code"] for row in refused] == [INTERNAL_ERROR]
    assert "test_any_record.py:" in refused[0]["message"]


@pytest.mark.parametrize("value", [{"a": "\ud800"}, {"a": object()}, {"a": 2**70}, {"a": {1: 2}}],
                         ids=("surrogate", "object", "large", "key"))  # fmt: skip
def test_an_item_that_cannot_be_stored(built, write, monkeypatch, value):
    def scan(path, place, columns):
        yield from json_records.items(GOOD, place, 1, "one", columns)
        yield from json_records.items({**GOOD, **value}, place, 2, "two", columns)
        yield from json_records.items({**GOOD, "title": "Read"}, place, 3, "three", columns)

    monkeypatch.setitem(ingest.SCANNERS, json_records.NAME, scan)
    titles, refused = ingested(built, write("a.jsonl", json.dumps(GOOD) + "\n" + json.dumps(GOOD)))
    assert titles == ["Nap", "Read"] and len(refused) == 1


def test_rejects_are_read_back_as_text(settings):
    reject = Reject.of(Code.EMPTY, "a\ud800b", file="x\udcff", found="\udc80")
    result = run_stage(replace(STAGE, process=lambda record, context: reject), settings)
    (first, *_) = pq.read_table(result.manifest.folder / "rejects.parquet").to_pylist()
    assert (first["message"], first["file"], first["found"]) == ("a\\ud800b", "x\\udcff", "\\udc80")
