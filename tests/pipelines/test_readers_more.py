"""Readers of words, records, datasets, sketches and scenes; packed files; hostile archives."""

from __future__ import annotations

import gzip
import json
import struct
import zipfile

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import read_sources
from oracles import mutated_input
from read_sources import PROGRAM

from hearth.storage import archives
from hearth.storage.rejects import Reject

SPOKEN = "Task: Drink milk\nStep 1: Walk to fridge\nStep 2: Grab milk"
RECORD = {"title": "Sleep", "description": "In bed.", "steps": ["[Walk] <bed> (1)", "[Lie] <bed> (1)"]}


def read(*paths):
    """Everything that sources give: rows and rejects."""
    return [output for _, output in read_sources.read(*paths)]


def codes(found):
    return [one.code if isinstance(one, Reject) else one["kind"] for one in found]


# Words


def test_a_planning_papers_list_gives_each_text_once(write):
    found = read(write("examples.json", json.dumps([SPOKEN, SPOKEN, "Task: X\nStep 1: Sleep", 7])))
    assert codes(found) == ["program", "DUPLICATE", "program", "BAD_JSON"]
    assert (found[0]["title"], found[0]["origin"]) == ("Drink milk", "spoken")
    assert found[0]["text"] == SPOKEN + "\n"


def test_numbered_text_of_a_language_model(write):
    text = "Make tea\nYou feel like tea.\n\n1. Walk to the kitchen.\n2. Find the kettle\n\n"
    text += "Task: Sleep\n1) Walk to bed\n2) Sleep\n"
    first, second = read(write("model.txt", text))
    assert (first["title"], first["description"], first["line"]) == ("Make tea", "You feel like tea.", 0)
    assert (second["title"], second["line"]) == ("Sleep", 6)


# Records


def test_json_lines_lists_and_single_records(write):
    steps = [{"action": "Walk", "objects": [{"name": "Coffee Cup", "instance": 2}], "agent": 0}]
    lines = [RECORD, {"id": "mine", "title": "T", "steps": steps}, {"title": "D", "description": "Words only."}]
    file = write("a.jsonl", "\n".join(map(json.dumps, lines)) + "\nnot json\n[1]\n{}\n")
    found = read(file)
    assert codes(found) == ["program", "program", "description", "BAD_JSON", "BAD_JSON", "EMPTY"]
    assert found[0]["text"] == "[Walk] <bed> (1)\n[Lie] <bed> (1)\n"
    assert (found[1]["program_id"], found[1]["text"]) == ("mine", "[Walk] <coffee_cup> (2)\n")
    assert [found[3].diagnostics[0].line, found[4].diagnostics[0].line] == [4, 5]
    assert codes(read(write("b.json", json.dumps([RECORD, RECORD], indent=1)))) == ["program"] * 2
    assert codes(read(write("c.json", json.dumps(RECORD)))) == ["program"]


def test_steps_in_words_inside_a_record(write):
    (row,) = read(write("a.jsonl", json.dumps({"title": "Sleep", "steps": ["walk to bed", "sleep"]})))
    assert row["origin"] == "spoken"
    assert row["text"].splitlines()[-1] == "Step 2: sleep"


@pytest.mark.parametrize("value", [{"steps": 3}, {"title": 1, "steps": ["[Sleep]"]}, {"steps": [{"x": 1}]}])
def test_a_record_of_the_wrong_shape_is_a_reject(write, value):
    assert codes(read(write("a.jsonl", f"{json.dumps(RECORD)}\n{json.dumps(value)}\n"))) == ["program", "BAD_JSON"]


def test_a_published_dataset_is_read_back(made, build_folder, tmp_path):
    again = build_folder(tmp_path / "again", [made.out])
    again.run("ingest", "validate")
    programs = {row["program_id"]: row for row in made.rows("validate")}
    published = {
        row["program_id"]
        for path in (made.out / "publish/programs").glob("*.parquet")
        for row in pa.parquet.read_table(path).to_pylist()
        if row["parent_id"] is None
    }
    found = {row["program_id"]: row for row in again.rows("validate")}
    assert found.keys() == published and published
    for name, row in found.items():
        for column in ("title", "description", "origin", "worker", "props", "rooms"):
            assert (row[column] or None) == (programs[name][column] or None)
        strip = [{**step, "line": 0} for step in row["steps"]]
        assert strip == [{**step, "line": 0} for step in programs[name]["steps"]]


# Sketches and scenes


def test_sketches(write):
    given = {"title": "T", "descr": "D", "prog": ["walk bed "], "prefix": "b/file1_2"}
    data = {"answer": [[0, 1], [], [1], [1, 1]], "represent": [1, 1, 1, 1], "input": [given, given, {}, given]}
    found = read(write("s.json", json.dumps(data)))
    assert codes(found) == ["sketch", "EMPTY", "BAD_JSON", "BAD_JSON"]
    assert found[3].diagnostics[0].message == "not a sketch: flags set 2, steps in `prog` 1"
    assert (found[0]["keep"], found[0]["text"]) == ([False, True], "walk bed\n")
    assert found[0]["description_id"] == "release:b/file1_2"


def test_a_sketch_of_a_written_program(write):
    given = {"title": "T", "descr": "D", "prog": ["walk bed"], "prefix": "written:P1"}
    (row,) = read(write("s.json", json.dumps({"answer": [[1]], "represent": [1], "input": [given]})))
    assert row["description_id"] == "written:P1"


def test_a_scene_graph_alone(write):
    graph = {
        "nodes": [{"id": 1, "class_name": "bedroom", "category": "Rooms", "properties": [], "states": []}],
        "edges": [],
    }
    (row,) = read(write("hut.json", json.dumps(graph)))
    assert (row["kind"], row["title"]) == ("scene", "hut")
    assert row["groundings"][0]["start"]["nodes"][0]["class_name"] == "bedroom"
    assert codes(read(write("bad.json", json.dumps({"nodes": [{"id": "x"}], "edges": []})))) == ["BAD_GRAPH"]


@pytest.mark.parametrize(
    ("states", "count"), [(["ON", "OFF"], 1), (["ON", "ON"], 1), (["ON", "ON", "OFF"], 2), (["ON", "CLEAN"], 0)]
)
def test_duplicate_and_contradictory_states(write, states, count):
    node = {"id": 7, "class_name": "lamp", "category": "Lamps", "properties": [], "states": states}
    (found,) = read(write("hut.json", json.dumps({"nodes": [node], "edges": []})))
    faults = found.diagnostics if isinstance(found, Reject) else ()
    assert len(faults) == count
    assert all(fault.code == "BAD_GRAPH" and "node 7 (lamp)" in fault.message for fault in faults)


# Packed


def framed(data, tmp_path):
    path = tmp_path / "framed.zst"
    with pa.CompressedOutputStream(str(path), "zstd") as stream:
        stream.write(data)
    return path.read_bytes()


def test_packed_files_are_read_in_place(write, tmp_path):
    text = PROGRAM.encode()
    assert codes(read(write("a.txt.gz", gzip.compress(text)))) == ["program"]
    assert codes(read(write("a.txt.zst", framed(text, tmp_path)))) == ["program"]
    path = tmp_path / "all.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("deep/a.txt", text)
        archive.writestr("b.jsonl", json.dumps(RECORD) + "\n")
        archive.writestr("cat.jpg", b"\xff\xd8\xff")
    rows = read(path)
    assert codes(rows) == ["program", "program", "UNSUPPORTED_FILE"]
    assert rows[0]["place"] == "all.zip/deep/a.txt"


def test_a_packed_file_that_breaks_off_keeps_what_came_before(write):
    text = ("\n".join([PROGRAM] * 2_000) + "\n").encode()
    whole = gzip.compress(text)
    found = codes(read(write("mix/cut.txt.gz", whole[: len(whole) * 2 // 3])))
    assert found[-1] == "BAD_ARCHIVE"
    assert 100 < found.count("program") < 2_000


def test_a_bomb_is_refused(write, monkeypatch):
    monkeypatch.setattr(archives, "_HARMLESS", 100_000)
    bomb = gzip.compress(b"a\n" * 2_000_000)
    found = read(write("bomb.txt.gz", bomb))
    assert codes(found) == ["FILE_TOO_LARGE"] and "bomb" in found[0].diagnostics[0].message
    write("mix/bomb.txt.gz", bomb)
    folder = write("mix/good.txt", PROGRAM).parent
    assert codes(read(folder)) == ["FILE_TOO_LARGE", "program"]


def test_a_bomb_in_a_zip_and_a_path_leaving_it(tmp_path, monkeypatch):
    monkeypatch.setattr(archives, "_HARMLESS", 100_000)
    path = tmp_path / "evil.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("bomb.txt", b"a\n" * 2_000_000)
        archive.writestr("../../etc/evil.txt", PROGRAM)
        archive.writestr("/evil.txt", PROGRAM)
        archive.writestr("good.txt", PROGRAM)
    found = read(path)
    assert codes(found) == ["FILE_TOO_LARGE", "BAD_ARCHIVE", "BAD_ARCHIVE", "program"]
    assert "leaves the archive" in found[1].diagnostics[0].message


def test_a_lying_directory_does_not_help_a_bomb(tmp_path, monkeypatch):
    monkeypatch.setattr(archives, "_HARMLESS", 100_000)
    path = tmp_path / "liar.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("bomb.txt", b"a\n" * 2_000_000)
        archive.writestr("good.txt", PROGRAM)
    data = path.read_bytes().replace(struct.pack("<L", 4_000_000), struct.pack("<L", 1_000))
    path.write_bytes(data)
    assert codes(read(path))[-1] == "program"


# Nothing vanishes; found by mutated input


def test_a_batch_with_its_first_line_only_says_so(write):
    (found,) = read(write("batch.csv", mutated_input.SEEDS["descriptions.csv"]().decode().splitlines()[0] + "\n\n"))
    assert (found.code, found.diagnostics[0].line) == ("EMPTY", 1)


def test_a_dataset_whose_programs_lack_a_column_names_it(tmp_path):
    table = pq.read_table(pa.BufferReader(mutated_input.SEEDS[mutated_input.DATASET]())).drop_columns(["title"])
    out = pa.BufferOutputStream()
    pq.write_table(table, out)
    (found,) = read(mutated_input.placed(tmp_path, mutated_input.DATASET, out.getvalue().to_pybytes()))
    assert found.code == "DAMAGED_FILE" and "title" in found.diagnostics[0].message
