"""The corpus that was written, not crowd-sourced: its origin, ids, and parts in splits, as readers give them."""

from __future__ import annotations

import json

from read_sources import HEADER, answer, batch, faults, read, rows

from hearth.datasets.format.ids import current_id
from hearth.pipelines.build import FIRST, corpus
from hearth.pipelines.readers import crowd
from hearth.pipelines.readers.reader_items import worker_hash

WRITTEN = f"Origin,Writer,Style,{HEADER.replace('WorkerId,', '')}"


def test_what_says_that_it_is_written_has_no_worker(write):
    text = batch(f"written,w1,terse,{answer(1, worker='x').replace(',x', '')}", header=WRITTEN)
    programs = ",".join(["Origin", *crowd.PROGRAMS, "Platform"])
    line = 'written,P1,W1,Approved,D1,Sleep,Go to bed.,bedroom*1,bed*1,"[Lie] <bed> (1)",AMT'
    described, program = rows(read(write("d.csv", text), write("p.csv", batch(line, header=programs))))
    for row in (described, program):
        assert (row["origin"], row["description_id"]) == ("written", "written:D1")
        assert (row["worker"], row["platform"]) == (None, None)
    assert (described["style"], program["program_id"], program["style"]) == ("terse", "written:P1", None)


def test_an_answer_of_an_unknown_origin_is_refused_alone(write):
    lines = [f"{origin},w1,,{answer(n).replace(',W1', '')}" for n, origin in enumerate(("", "writen", "crowd"), 1)]
    found = read(write("d.csv", batch(*lines, header=WRITTEN)))
    assert [row["program_id"] for row in rows(found)] == ["crowd:D1", "crowd:D3"]
    assert faults(found) == [("BAD_TABLE", "d.csv", 3)]
    assert "an origin that no answer has: `writen`" in found[1][1].diagnostics[0].message


def test_the_embedded_corpus_says_that_it_is_written():
    found = rows(read(*corpus()))
    assert len(found) > 800
    assert {(row["worker"], row["platform"]) for row in found} == {(None, None)}
    assert {(row["kind"], row["origin"]) for row in found} == {
        ("program", "written"), ("description", "written"), ("sketch", "sketches")
    }  # fmt: skip
    first = rows(read(*corpus(FIRST)))
    assert all(current_id(row["program_id"].replace("written:", "crowd:")) == row["program_id"] for row in first)


def test_records_of_the_embedded_corpus_as_version_0_1_had_them(write):
    old = {"program_id": "crowd:3P0001A2SM5", "description_id": "crowd:3D0001FLP5E", "origin": "crowd", "worker": "x",
           "platform": "AMT", "title": "Sleep", "steps": ["[Lie] <bed> (1)"]}  # fmt: skip
    theirs = {**old, "program_id": "crowd:P1", "description_id": "crowd:3D0001FLP5EXX"}
    ours, others = rows(read(write("a.jsonl", f"{json.dumps(old)}\n{json.dumps(theirs)}\n")))
    assert (ours["program_id"], ours["description_id"]) == ("written:3P0001A2SM5", "written:3D0001FLP5E")
    assert (ours["origin"], ours["worker"], ours["platform"]) == ("written", None, None)
    assert (others["program_id"], others["description_id"]) == ("crowd:P1", "crowd:3D0001FLP5EXX")
    assert (others["origin"], others["worker"], others["platform"]) == ("crowd", worker_hash("x", "salt"), "AMT")


def test_parts_in_splits_of_a_source(write):
    sleep = {"title": "Sleep", "steps": ["[Lie] <bed> (1)"]}
    given = [
        {"pairs": "test", "tasks": None},
        {"activities": "test"},
        {"pairs": "../x"},
        {"a b": "test"},
        {f"s{n}": "test" for n in range(21)},
        ["pairs"],
        {},
    ]
    text = "".join(json.dumps({**sleep, "program_id": f"p{n}", "splits": each}) + "\n" for n, each in enumerate(given))
    found = read(write("a.jsonl", text))
    parts = {row["program_id"]: row["parts"] for row in rows(found)}
    wanted = [{"split": "pairs", "part": "test"}, {"split": "tasks", "part": None}]
    assert parts == {"p0": wanted, **dict.fromkeys(f"p{n}" for n in range(1, 7))}
    assert [line for _, _, line in faults(found)] == [2, 3, 4, 5]
