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
    (folder / "programs.csv").write_text(
        "\n".join([",".join(COLUMNS), answer("P1", *runs), answer("P2", *fails)]) + "\n"
    )
    inputs = [
        {"title": "Nap", "descr": "", "prog": steps[1:], "prefix": f"written:P{n}"}
        for n, steps in enumerate((runs, fails), 1)
    ]
    annotated = {"answer": [[0, 1], [0, 1]], "represent": [1, 1], "input": inputs}
    (folder / "sketches.json").write_text(json.dumps(annotated))
    sources = [str(folder / name) for name in ("programs.csv", "sketches.json")]
    return hearth.build(sources, str(folder / "out"), homes=("maple",), variants=0, pictures=0, videos=0).dataset


def test_a_written_sketch_stands_beside_the_inferred_one(dataset):
    sketches = hearth.load(dataset)["written:P1"].sketches
    assert {row["origin"] for row in sketches} == {"inferred", "written"}
    (written,) = (row for row in sketches if row["origin"] == "written")
    assert (written["keep"], written["steps"]) == ([False, True], ["[Lie] <bed> (1)"])


def test_the_sketch_of_a_program_that_is_not_published_is_not_either(dataset):
    assert hearth.load(dataset).rows("SELECT DISTINCT program_id FROM sketches")[1] == [("written:P1",)]
    assert not verify(dataset).faults
