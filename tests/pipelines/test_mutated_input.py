"""Mutated input: no traceback, nothing without a row or a reject, and cases that can be made again."""

from __future__ import annotations

import json
import zipfile

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from oracles import mutated_input
from typer.testing import CliRunner

from hearth.cli import app
from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import READERS, items
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


def test_good_seeds_give_rows_in_every_reader(knowledge, tmp_path):
    for name, make in mutated_input.SEEDS.items():
        report = mutated_input.Report()
        row = mutated_input._attempt(mutated_input.placed(tmp_path, name, make()), knowledge, report)
        assert row.records and row.adds_up and (row.accepted or name == "programs.csv"), (name, report)


def test_a_few_hundred_cases(knowledge):
    report = mutated_input.fuzz(knowledge, 1e9, 1, most=600)
    assert report.crashes == []
    assert report.cases == sum(row.inputs for row in report.table()) == 600
    assert all(row.adds_up and row.records + row.refused_whole >= row.inputs for row in report.table())
    assert len(report.readers) > 10 and sum(row.accepted for row in report.table()) > 100


def test_a_case_can_be_made_again():
    assert mutated_input.case(3, 17) == mutated_input.case(3, 17) != mutated_input.case(4, 17)


def test_a_reader_that_breaks_or_swallows_is_told(knowledge, monkeypatch):
    monkeypatch.setitem(READERS, "text", lambda item, salt: 1 / 0)
    monkeypatch.setitem(READERS, "sketches", lambda item, salt: [])
    report = mutated_input.fuzz(knowledge, 1e9, 0, most=120)
    assert "ZeroDivisionError" in " ".join(report.crashes) and report.readers["text"].tracebacks
    assert report.readers["sketches"].silent and not report.readers["sketches"].adds_up


@pytest.mark.parametrize("seed", [0])
def test_the_command(seed):
    result = CliRunner().invoke(app, ["corpus", "fuzz", "--cases", "24", "--seed", str(seed), "--json"])
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["cases"] == 24


@pytest.mark.parametrize("text", ["[]", "[ ]\n", "", "\n\n"])
def test_a_file_without_records_is_refused_not_lost(tmp_path, text):
    file = tmp_path / "steps.json"
    file.write_text(text)
    (found,) = items(labelled([str(file)]))
    assert found[1].reader == "refused"


def test_an_archive_whose_names_are_no_text_is_refused(tmp_path):
    file = tmp_path / "plain.zip"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("caf\u00e9.txt", "Tea\nA cup.\n\n\n[Walk] <cup> (1)\n")
    file.write_bytes(file.read_bytes().replace("\u00e9".encode(), b"\xe9\xe9"))
    with pytest.raises(HearthError) as caught:
        list(items(labelled([str(file)])))
    assert caught.value.diagnostics[0].code is Code.BAD_ARCHIVE


@pytest.mark.parametrize("kind", [pa.binary(), pa.int64()])
def test_a_dataset_whose_ids_are_no_text_is_refused(tmp_path, kind):
    folder = mutated_input.placed(tmp_path, mutated_input.DATASET, mutated_input.SEEDS[mutated_input.DATASET]())
    (file,) = (folder / "programs").glob("*.parquet")
    table = pq.read_table(file)
    place = table.schema.get_field_index("program_id")
    ids = pa.array([b"1" if kind == pa.binary() else 1] * table.num_rows, kind)
    pq.write_table(table.set_column(place, "program_id", ids), file)
    found = [item for _, item in items(labelled([str(folder)]))]
    assert found and found[-1].reader == "refused"
