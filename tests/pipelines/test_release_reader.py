"""The reader of the release: folder and zip, what belongs to a program, and what a missing or bad file costs."""

from __future__ import annotations

import shutil
import zipfile

import pytest
from read_sources import PROGRAM, faults, read, rows, zipped

from hearth.schemas.diagnostics import HearthError

ROOT = "programs_processed_precond_nograb_morepreconds"


def test_zip_and_folder_give_the_same(release, tmp_path):
    one = rows(read(zipped(release, tmp_path / "release.zip")))
    two = rows(read(release))
    for row in (*one, *two):
        row.pop("place")
    assert one == two
    assert [row["program_id"] for row in one] == [
        "release:batch-1/file1_1",
        "release:batch-1/file1_2",
        "release:batch-2/file7_1",
    ]


def test_what_belongs_to_a_program_of_the_release(release):
    row = rows(read(release))[0]
    (grounding,) = row["groundings"]
    assert (row["title"], row["description_id"]) == ("Fetch milk", "release:batch-1/file1")
    assert grounding["home"] == "cottage"
    assert row["text"].endswith("[PutBack] <milk> (1) <table> (1)\n")
    assert (24, "ON", 20) in grounding["final"]["added"]
    assert (24, "INSIDE", 23) in grounding["final"]["removed"]
    objects = [{"name": "milk", "instance": 1}, {"name": "fridge", "instance": 1}]
    assert {"name": "inside", "objects": objects, "step": None, "hard": None} in row["conditions"]
    assert len(grounding["start"]["sources"]) > 30


@pytest.mark.parametrize("gone", ["withoutconds", "init_and_final_graphs", "executable_programs", "initstate"])
def test_any_folder_may_be_missing(release, gone):
    shutil.rmtree(release / ROOT / gone)
    found = read(release)
    assert len(rows(found)) == 3
    starts = [grounding["start"] is not None for row in rows(found) for grounding in row["groundings"]]
    expected = {"init_and_final_graphs": [False] * 3, "executable_programs": []}
    assert starts == expected.get(gone, [True] * 3)
    # Graphs are of no use without a program that says which of their nodes it means.
    assert len(faults(found)) == (3 if gone == "executable_programs" else 0)


def test_graphs_without_any_program_are_rejected(release):
    shutil.rmtree(release / ROOT / "withoutconds")
    shutil.rmtree(release / ROOT / "executable_programs")
    found = read(release)
    assert [code for code, _, _ in faults(found)] == ["MISSING_FILE"] * 3


def test_both_spellings_of_the_graphs_folder(release):
    expected = rows(read(release))
    (release / ROOT / "init_and_final_graphs").rename(release / ROOT / "init_and_final_graph")
    assert [row["groundings"] for row in rows(read(release))] == [row["groundings"] for row in expected]


def test_the_text_is_taken_from_the_grounded_program_where_there_is_no_other(release):
    expected = [row["text"].lower().replace(" ", "") for row in rows(read(release))]
    shutil.rmtree(release / ROOT / "withoutconds")
    assert [row["text"].lower().replace(" ", "") for row in rows(read(release))] == expected


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b"{", "BAD_JSON"),
        (b"[]", "BAD_GRAPH"),
        (b'{"init_graph": {"nodes": [{"id": 1}], "edges": []}}', "BAD_GRAPH"),
        (b'{"init_graph": {"nodes": [], "edges": [{"from_id": "a", "relation_type": "ON", "to_id": 2}]}}', "BAD_GRAPH"),
    ],
)
def test_a_bad_graph_costs_its_own_grounding(release, content, code):
    path = release / ROOT / "init_and_final_graphs/cottage_graph/batch-1/file1_2.json"
    path.write_bytes(content)
    found = read(release)
    assert [len(row["groundings"]) for row in rows(found)] == [1, 0, 1]
    assert faults(found)[0][:2] == (code, f"release/{path.relative_to(release).as_posix()}")


def test_a_damaged_member_costs_its_own_program(release, tmp_path):
    path = zipped(release, tmp_path / "release.zip")
    with zipfile.ZipFile(path) as archive:
        info = archive.getinfo(f"{ROOT}/withoutconds/batch-1/file1_2.txt")
    data = bytearray(path.read_bytes())
    start = info.header_offset + 30 + len(info.filename)
    data[start : start + 12] = b"\xff" * 12
    path.write_bytes(data)
    found = read(path)
    assert [row["program_id"][-7:] for row in rows(found)] == ["file1_1", "file7_1"]
    assert [code for code, _, _ in faults(found)] == ["BAD_ARCHIVE"]


def test_a_truncated_archive_is_an_error(release, tmp_path):
    path = zipped(release, tmp_path / "release.zip")
    path.write_bytes(path.read_bytes()[:-200])
    with pytest.raises(HearthError, match=r"BAD_ARCHIVE.*truncated"):
        read(path)


def test_a_truncated_archive_among_others_is_a_reject(release, tmp_path, write):
    path = write("mix/release.zip", b"")
    zipped(release, path)
    path.write_bytes(path.read_bytes()[:-200])
    write("mix/tv.txt", PROGRAM)
    found = read(path.parent)
    assert len(rows(found)) == 1
    assert faults(found)[0][0] == "BAD_ARCHIVE"


def test_a_member_that_claims_too_much_is_not_unpacked(release, tmp_path, monkeypatch):
    from hearth.pipelines.readers import release as reader

    monkeypatch.setattr(reader, "LARGEST_FILE", 1_000)
    found = read(zipped(release, tmp_path / "release.zip"))
    assert {code for code, _, _ in faults(found)} == {"FILE_TOO_LARGE"}
