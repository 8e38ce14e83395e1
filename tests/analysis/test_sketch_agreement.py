"""Agreement of two annotators."""

from __future__ import annotations

import json
import os

import pytest

from hearth.analysis.programs_in_homes import Script
from hearth.analysis.sketch_agreement import compare, kappa
from hearth.analysis.sketch_evaluation import annotated
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.syntax import parse_program


def drawn(path, **answers):
    given = [
        {"title": "t", "descr": "", "prog": ["walk sofa"] * sum(flags), "prefix": f"written:{name}"}
        for name, flags in answers.items()
    ]
    path.write_text(json.dumps({"answer": list(answers.values()), "input": given}))
    return path


def test_agreement_by_hand(tmp_path):
    first = drawn(tmp_path / "a.json", P1=[0, 0, 1, 1], P2=[1, 0], P3=[1])
    second = drawn(tmp_path / "b.json", P1=[0, 1, 1, 0], P2=[1, 0], P4=[1])
    found = compare(first, second)
    assert found["programs"] == 2 and found["steps"] == 6
    assert found["f1"] == pytest.approx(2 * 2 / 6, abs=1e-4)
    # Four of six steps agree, and half of them are kept by either: chance agrees on one half.
    assert found["kappa"] == pytest.approx((4 / 6 - 0.5) / 0.5, abs=1e-4)
    assert found["equal"][0] == 0.5


def test_kappa_is_0_for_chance_and_1_for_equal_ones():
    assert kappa([((True, False), (True, False))]) == 1
    assert kappa([((True, True, False, False), (True, False, True, False))]) == 0


def test_repeated_annotations_in_one_file_are_compared(tmp_path):
    given = [{"title": "t", "descr": "", "prog": ["walk sofa"] * kept, "prefix": "written:P1"} for kept in (1, 2)]
    (tmp_path / "a.json").write_text(json.dumps({"answer": [[0, 1], [1, 1]], "input": given}))
    assert compare(tmp_path / "a.json", tmp_path / "a.json")["f1"] == pytest.approx(2 / 3, abs=1e-4)


def test_annotations_of_different_programs_are_an_error(tmp_path):
    with pytest.raises(HearthError, match="no program is annotated twice"):
        compare(drawn(tmp_path / "a.json", P1=[1]), drawn(tmp_path / "b.json", P2=[1]))


@pytest.mark.parametrize("lines", [[""], [" ", "walk sofa"]])
def test_an_annotation_with_empty_lines_is_of_no_program(tmp_path, knowledge, lines):
    given = {"title": "Sit", "descr": "", "prog": lines, "prefix": "b"}
    (tmp_path / "a.json").write_text(json.dumps({"answer": [[1] * len(lines)], "input": [given]}))
    program, _ = parse_program("Sit\n\n\n\n[Walk] <sofa> (1)\n")
    script = Script("text:a", "a.txt", program)
    assert list(annotated(tmp_path / "a.json", "a.json", [script], knowledge)) == [None]


def test_annotations_that_are_no_file_are_not_waited_for(tmp_path, knowledge):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(HearthError, match="MISSING_FILE"):
        list(annotated(tmp_path / "pipe", "pipe", [], knowledge))
