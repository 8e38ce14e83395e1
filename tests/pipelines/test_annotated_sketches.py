"""Sketches that somebody annotated, in a dataset."""

import json

import pytest

import hearth
from hearth.datasets.verify import verify

COLUMNS = (
    "HITId", "Origin", "Writer", "AssignmentStatus", "Input.description_id", "Input.title", "Input.description",
    "Answer.rooms", "Answer.props", "Answer.program",
)  # fmt: skip


def answer(name, *steps):
    lines = "\n".join(steps)
    return f'{name},written,short,Approved,,Nap,I lie down and sleep.,bedroom*1,bed*1,"{lines}"'


@pytest.fixture(scope="module")
def dataset(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sketched")
    runs, fails = ("[Walk] <bed> (1)", "[Lie] <bed> (1)"), ("[Walk] <bed> (1)", "[Dance]")
    longer = ("[Find] <bed> (1)", *runs)
    programs = [answer(f"P{n}", *steps) for n, steps in enumerate((runs, fails, longer), 1)]
    (folder / "programs.csv").write_text("\n".join([",".join(COLUMNS), *programs]) + "\n")
    inputs = [
        {"title": "Nap", "descr": "", "prog": steps[1:], "prefix": f"written:P{n}"}
        for n, steps in enumerate((runs, fails, runs), 1)
    ]
    annotated = {"answer": [[0, 1]] * 3, "represent": [1] * 3, "input": inputs}
    (folder / "sketches.json").write_text(json.dumps(annotated))
    sources = [str(folder / name) for name in ("programs.csv", "sketches.json")]
    options = {"homes": ("maple",), "action_set": 2, "variants": 0, "pictures": 0, "videos": 0}
    return hearth.build(sources, str(folder / "out"), **options).dataset


def test_a_written_sketch_stands_beside_the_inferred_one(dataset):
    sketches = hearth.load(dataset)["written:P1"].sketches
    assert {row["origin"] for row in sketches} == {"inferred", "written"}
    (written,) = (row for row in sketches if row["origin"] == "written")
    assert (written["keep"], written["steps"]) == ([False, True], ["[Lie] <bed> (1)"])


def test_the_sketch_of_a_program_that_is_not_published_is_not_either(dataset):
    found = hearth.load(dataset).rows("SELECT DISTINCT program_id FROM sketches ORDER BY 1")[1]
    assert found == [("written:P1",), ("written:P3",)]
    assert not verify(dataset).faults


def test_an_annotation_that_does_not_fit_its_program_is_refused(dataset):
    opened = hearth.load(dataset)
    assert {row["origin"] for row in opened["written:P3"].sketches} == {"inferred"}
    found = opened.rows("SELECT code, file, message, partial FROM rejects WHERE stage = 'publish'")[1]
    assert found == [
        ("BAD_JSON", "sketches.json[3]", "not a sketch of written:P3: flags 2, steps of the program 3", True)
    ]
    assert opened.rows("SELECT partial_rejects FROM ledger WHERE stage = 'publish'")[1] == [(1,)]
