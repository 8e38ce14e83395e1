"""Hostile input, and input that a spreadsheet would run: refused or made harmless, and reported."""

import csv
import gzip
import io
import json
import stat
import zipfile

import pyarrow as pa
import pytest
from oracles import mutated_input

from hearth.analysis import completeness_ratings
from hearth.analysis.spreadsheet_cells import original_cell
from hearth.analysis.synthesis import load
from hearth.datasets.export.release_layout import stem
from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import READERS, items
from hearth.pipelines.readers.crowd import PROGRAMS
from hearth.pipelines.readers.recognition_by_content import recognise
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.program import Program
from hearth.storage.csv_files import safe_cell
from hearth.storage.rejects import Reject

PROGRAM = "Nap\nOn it.\n\n[Walk] <bed> (1)\n"


def codes(*paths):
    found = []
    for _, item in items(labelled(map(str, paths))):
        outputs = READERS[item.reader](item, "salt")
        listed = [outputs] if isinstance(outputs, dict | Reject) else list(outputs)
        found.extend(one.code if isinstance(one, Reject) else one["kind"] for one in listed)
    return found


@pytest.mark.parametrize("text", ["=1+1", "+1", "-1", "@SUM(A1)", "\t=1", "'=1", "plain", "", "a=1"])
def test_cells_come_back_and_none_is_a_formula(text):
    assert original_cell(safe_cell(text)) == text
    assert not safe_cell(text).startswith(("=", "+", "-", "@", "\t", "\r"))


def test_a_sheet_for_raters_holds_no_formulas_and_knows_its_programs_again(tmp_path):
    evil = Program("=cmd|' /C calc'!A0", "@SUM(1)", ())
    text = completeness_ratings.sheet([("=evil", evil)], 1)
    assert not any(cell[:1] in "=+-@" for row in csv.reader(io.StringIO(text)) for cell in row if cell)
    file = tmp_path / "filled.csv"
    file.write_text(text.rstrip("\n") + "2\n", encoding="utf-8-sig")
    assert completeness_ratings.medians(completeness_ratings.read_sheets([file])) == {"=evil": 2}
    file.write_text("program_id;rater;rating\n'=evil;r;3\n")
    assert completeness_ratings.medians(completeness_ratings.read_sheets([file])) == {"=evil": 3}


@pytest.mark.parametrize("name", ["../../x", "release:../../x", "/etc/x", "a/../../x", "a\\..\\..\\x", "line\nbreak"])
def test_ids_that_leave_their_folder(write, name):
    assert (
        codes(write("a.jsonl", json.dumps({"id": name, "title": "T", "steps": ["[Sleep]"]}) + "\n" + "{}\n"))[0]
        == "BAD_JSON"
    )
    assert ".." not in stem(f"release:{name}").split("/")


def test_a_link_in_an_archive_is_not_followed(tmp_path):
    path = tmp_path / "a.zip"
    link = zipfile.ZipInfo("link.txt")
    link.external_attr = (stat.S_IFLNK | 0o777) << 16
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr(link, "/etc/passwd")
        archive.writestr("good.txt", PROGRAM)
    assert codes(path) == ["BAD_ARCHIVE", "program"]


def test_tags_in_yaml_make_nothing(tmp_path, knowledge):
    path = tmp_path / "grammar.yaml"
    path.write_text("plan: !!python/object/apply:os.system ['touch harmed']\n")
    with pytest.raises(HearthError):
        load(path, knowledge)
    assert not (tmp_path / "harmed").exists()


def packed(tmp_path, name, data, form):
    path = tmp_path / f"{name}{form}"
    if form == ".zip":
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr(name, data)
    else:
        path.write_bytes(gzip.compress(data) if form == ".gz" else pa.Codec("zstd").compress(data, asbytes=True))
    return path


@pytest.mark.parametrize("form", [".gz", ".zst", ".zip"])
@pytest.mark.parametrize(
    "name", [name for name in mutated_input.SEEDS if not name.endswith((".zip", ".gz", ".zst", ".parquet"))]
)
def test_every_reader_reads_packed_files_in_place(tmp_path, name, form):
    data = mutated_input.SEEDS[name]()
    plain = tmp_path / name
    plain.write_bytes(data)
    path = packed(tmp_path, name, data, form)
    assert [one.reader for one in recognise(path, "x")] == [one.reader for one in recognise(plain, "x")]
    assert codes(path) == codes(plain)


def test_thousands_of_rows_of_one_worker(tmp_path):
    """One answer for as many descriptions is pasted: all are refused, each with its line."""
    path = tmp_path / "one.csv"
    steps = '"' + "\n".join(f"[Walk] <{name}> (1)" for name in ("bed", "sofa", "table", "chair")) + '"'
    with path.open("w") as file:
        file.write(",".join(PROGRAMS) + "\n")
        file.writelines(f"P{n},W1,Approved,D{n},Nap,On it.,,,{steps}\n" for n in range(3_000))
    found = [item for _, item in items(labelled([str(path)]))]
    assert len(found) == 3_000 and {item.reader for item in found} == {"refused"}
    assert [item.line for item in found[:3]] == [2, 6, 10]
