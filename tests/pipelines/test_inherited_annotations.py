"""Annotated sketches that augmented programs inherit from their parents."""

from hypothesis import given
from hypothesis import strategies as st

from hearth.datasets.format.row_conversion import step_rows
from hearth.pipelines.engine.annotated_sketches import inherited_annotations, places
from hearth.schemas.syntax import parse_program

WATCH = "[Walk] <couch> (1)\n[SwitchOn] <television> (1)\n[Sit] <couch> (1)\n[Watch] <television> (1)"
LONGER = "[Walk] <couch> (1)\n[StandUp]\n[SwitchOn] <television> (1)\n[Find] <couch> (1)\n[Sit] <couch> (1)\n" + (
    "[Watch] <television> (1)"
)


def _row(name, parent, text):
    return {"program_id": name, "parent_id": parent, "steps": step_rows(parse_program(text)[0])}


def _inherited(*programs):
    keep = [False, True, True, False]
    annotation = {"program_id": "p", "origin": "written", "keep": keep, "steps": []}
    return list(inherited_annotations([_row(*each) for each in programs], {"p": annotation}))


def test_a_child_keeps_the_same_steps_wherever_they_now_stand():
    (row,) = _inherited(("p", None, WATCH), ("p+maple.0", "p", LONGER))
    assert row == {
        "program_id": "p+maple.0",
        "origin": "written_parent",
        "keep": [False, False, True, False, True, False],
        "steps": ["[SwitchOn] <television> (1)", "[Sit] <couch> (1)"],
    }


def test_children_may_come_before_their_parents_and_others_have_none():
    rows = _inherited(("p+maple.0", "p", WATCH), ("p", None, WATCH), ("q", None, WATCH), ("q+maple.0", "q", WATCH))
    assert [row["program_id"] for row in rows] == ["p+maple.0"]


def test_an_annotation_of_other_steps_is_not_inherited():
    assert _inherited(("p", None, LONGER), ("p+maple.0", "p", LONGER)) == []


@given(st.lists(st.sampled_from("abcd"), max_size=12), st.data())
def test_inserted_steps_are_nobodys(parent, data):
    child, expected = [], []
    for number, step in enumerate(parent):
        new = data.draw(st.integers(0, 2))
        child += ["new"] * new + [step]
        expected += [-1] * new + [number]
    assert [child[n] for n, place in enumerate(places(parent, child)) if place >= 0] == [
        parent[place] for place in places(parent, child) if place >= 0
    ]
    if len(set(parent)) == len(parent):
        assert places(parent, child) == expected
