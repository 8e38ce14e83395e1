"""The codebook of an export has every column of every table, and the names of all values that have one."""

from __future__ import annotations

import csv

from studies.small import simulated

from hearth.studies.participant_flags import FLAGS
from hearth.studies.study_tables import TABLES, archive, export


def rows_of(folder):
    with (folder / "codebook.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_an_export_explains_itself(tmp_path):
    collected = simulated(tmp_path / "run")
    export(collected, tmp_path / "tables")
    rows = rows_of(tmp_path / "tables")
    columns = {(row["table"], row["column"]) for row in rows if not row["value"]}
    assert columns == {(name, each.name) for name, schema in TABLES.items() for each in schema}
    assert all(row["meaning"] for row in rows) and all(row["type"] for row in rows if not row["value"])
    named = {(row["column"], row["value"]): row["meaning"] for row in rows if row["value"]}
    assert named["condition", "hp_rg"] == "HP_RG"
    assert named["question", "helpful"] == "How helpful was it? (1 to 7; 1 hurting, 7 helpful)"
    assert named["question", "age"] == "How old are you? (young, old)"
    assert {value for column, value in named if column == "flags"} == set(FLAGS)
    assert b"codebook.csv" in archive(collected)
