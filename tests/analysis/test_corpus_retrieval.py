"""Retrieval before and after the larger corpus: tests are the same, and no training program is like one."""

from __future__ import annotations

from hearth.analysis import corpus_retrieval as study
from hearth.datasets.format.split_columns import SplitProgram


def program(name, activity, steps, text):
    return SplitProgram(name, activity, "", None, tuple(steps), text)


def test_training_programs_of_tested_activities_and_near_duplicates_are_left_out():
    test = [program("t", "read", ["[Grab] <novel> (1)", "[Read] <novel> (1)"], "I take my novel and read it in bed.")]
    train = [
        program("same activity", "read", ["[Sit] <sofa> (1)"], "Something quite different from all others here."),
        program("same text", "rest", ["[Lie] <bed> (1)"], "I take my novel and read it in bed!"),
        program("same steps", "relax", ["[Grab] <novel> (1)", "[Read] <novel> (1)"], "An evening with a good story."),
        program("apart", "cook", ["[Walk] <kitchen> (1)"], "I go to the kitchen and cook some soup."),
    ]
    assert study._apart(test, train) == {"apart"}


def test_both_are_tested_on_the_same_programs(knowledge, tmp_path):
    text = "Read\nI take the novel and read it.\n\n\n[Grab] <novel> (1)\n[Read] <novel> (1)\n"
    (tmp_path / "read.txt").write_text(text)
    found = study.before_and_after(knowledge, tested=[str(tmp_path / "read.txt")])
    assert found["tested"] == 1
    before, after = found["trained_on"].values()
    assert 0 < before["programs"] < after["programs"]
    assert set(after["scores"]) == set(study.SCORES)
