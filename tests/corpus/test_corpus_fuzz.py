"""Mutated input: no traceback, nothing without a row or a reject, and cases that can be made again."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.pipelines import fuzzing
from hearth.pipelines.ingest import READERS


def test_good_seeds_give_rows_in_every_reader(knowledge, tmp_path):
    for name, make in fuzzing.SEEDS.items():
        path = tmp_path / name
        path.write_bytes(make())
        report = fuzzing.Report()
        fuzzing._attempt(path, knowledge, report)
        assert report.records and (report.rows or "SPECIAL_BLOCK" in report.codes), name


def test_a_few_hundred_cases(knowledge):
    report = fuzzing.fuzz(knowledge, 1e9, 1, most=600)
    assert report.crashes == []
    assert report.cases == 600 and report.records > 200 and report.rejects > 100


def test_a_case_can_be_made_again():
    assert fuzzing.case(3, 17) == fuzzing.case(3, 17) != fuzzing.case(4, 17)


def test_a_reader_that_breaks_or_swallows_is_told(knowledge, monkeypatch):
    monkeypatch.setitem(READERS, "text", lambda item, salt: 1 / 0)
    monkeypatch.setitem(READERS, "sketches", lambda item, salt: [])
    told = " ".join(fuzzing.fuzz(knowledge, 1e9, 0, most=120).crashes)
    assert "ZeroDivisionError" in told and "nothing came of" in told


@pytest.mark.parametrize("seed", [0])
def test_the_command(seed):
    result = CliRunner().invoke(app, ["corpus", "fuzz", "--cases", "24", "--seed", str(seed), "--json"])
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["cases"] == 24
