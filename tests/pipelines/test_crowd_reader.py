"""The reader of crowd-sourcing batches: descriptions, programs, and what a bad row costs."""

from __future__ import annotations

import pytest
from read_sources import HEADER, answer, batch, faults, read, rows

from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items
from hearth.pipelines.readers import crowd


def test_descriptions(write):
    first, second = rows(read(write("d.csv", batch(answer(1), answer(2, '"Sleep, well"', '"Lie ""down"".\nSleep."')))))
    assert first["program_id"] == first["description_id"] == "crowd:D1"
    assert (first["kind"], first["scene"], first["title"]) == ("description", "bedroom", "Sleep")
    assert (second["title"], second["description"]) == ("Sleep, well", 'Lie "down".\nSleep.')


def test_worker_ids_are_hashed_with_a_salt(write):
    (row, other) = rows(read(write("d.csv", batch(answer(1, worker="A3JJEUH4TV6UC"), answer(2, worker="B")))))
    assert "A3JJEUH4TV6UC" not in str(row)
    assert row["worker"] != other["worker"]
    ((_, item),) = items(labelled([str(write("e.csv", batch(answer(1))))]))
    assert crowd.read(item, "one")["worker"] != crowd.read(item, "two")["worker"]


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
@pytest.mark.parametrize("mark", ["", "\ufeff"])
def test_marks_and_separators(write, delimiter, mark):
    text = mark + batch(answer(1), answer(2, worker="W2")).replace(",", delimiter)
    assert [row["title"] for row in rows(read(write("d.csv", text)))] == ["Sleep", "Sleep"]


@pytest.mark.parametrize("column", ["WorkerId", "Answer.description", "AssignmentStatus"])
def test_a_missing_column_is_named(write, column):
    header = HEADER.replace(column, "Other")
    ((_, reject),) = read(write("d.csv", batch(answer(1), header=header)))
    assert reject.code == "BAD_TABLE"
    assert f"lacks the column `{column}`" in reject.diagnostics[0].message


def test_answers_that_are_not_used(write):
    lines = [
        answer(1, status="Rejected"),
        answer(2, description=""),
        answer(3),
        answer(4),
        answer(3, title="Other"),
        answer(5, worker="W2"),
    ]
    found = read(write("d.csv", batch(*lines)))
    assert [row["program_id"] for row in rows(found)] == ["crowd:D3", "crowd:D5"]
    assert faults(found) == [
        ("REJECTED_ANSWER", "d.csv", 2),
        ("EMPTY", "d.csv", 3),
        ("DUPLICATE", "d.csv", 5),  # the same answer of the same worker
        ("DUPLICATE", "d.csv", 6),  # the same id
    ]


@pytest.mark.parametrize(
    "bad",
    ['D9,W1,Approved,bedroom,"Sleep,Go to bed.', "D9,W1,Approved,bedroom", "D9,W1,Approved,bedroom,a,b,c,d"],
)
def test_a_broken_row_costs_no_other_row(write, bad):
    several = answer(3, description='"Lie down.\nSleep.\nWake up."')
    found = read(write("d.csv", batch(answer(1), bad, several, answer(4, worker="W2"))))
    assert [row["program_id"] for row in rows(found)] == ["crowd:D1", "crowd:D3", "crowd:D4"]
    assert faults(found) == [("BAD_TABLE", "d.csv", 3)]


def test_a_row_that_is_not_text_costs_no_other_row(write):
    data = batch(answer(1), answer(2, "Caf\xe9\xff"), answer(3, worker="W2")).encode("latin-1")
    found = read(write("d.csv", data))
    assert [row["program_id"] for row in rows(found)] == ["crowd:D1", "crowd:D3"]
    assert faults(found) == [("NOT_TEXT", "d.csv", 3)]


def test_programs_of_the_second_stage(write):
    header = ",".join([*crowd.PROGRAMS, "Platform"])
    line = 'P1,W1,Approved,D1,Watch TV,Watch it.,living room*1,"Remote Control*2, television","[Walk] <tv> (1)\n",AMT'
    (row,) = rows(read(write("p.csv", batch(line, header=header))))
    assert (row["kind"], row["program_id"], row["description_id"]) == ("program", "crowd:P1", "crowd:D1")
    assert row["rooms"] == [{"name": "living_room", "quantity": 1}]
    assert row["props"] == [{"name": "remote_control", "quantity": 2}, {"name": "television", "quantity": 1}]
    assert (row["platform"], row["line"], row["place"]) == ("AMT", 1, "p.csv")
    assert (row["origin"], row["style"], len(row["worker"])) == ("crowd", None, 16)
