"""Published ids of failures never change."""

from __future__ import annotations

import pickle

import pytest

from hearth.schemas.failures import Code, Failure


def test_every_code_has_an_id_of_its_own():
    assert len({code.number for code in Code}) == len(Code)


def test_ids_are_those_published():
    """Whoever changes one of these breaks datasets that people have."""
    known = {"EMPTY": 0, "SYNTAX": 11, "NOT_AFFORDED": 21, "GOAL_LOST": 61, "REPLAY_DIFFERS": 65, "TIMED_OUT": 72}
    assert {name: Code[name].number for name in known} == known


@pytest.mark.parametrize("code", Code)
def test_a_code_is_found_by_its_name_alone(code):
    assert code == code.value == code.name == str(code)
    assert Code[code.value] is pickle.loads(pickle.dumps(code)) is code


def test_the_code_of_an_older_dataset_is_found_by_its_old_name():
    assert Code["HEARD_NEARLY"] is Code.FUZZY_MATCH
    assert "HEARD_NEARLY" not in set(map(str, Code))


def test_a_failure_of_no_step_names_none():
    step = Failure(Code.IS_OPEN, 1, 0, "Open", (5,), ("fridge",), "CLOSED", "OPEN")
    assert step.message() == "IS_OPEN: tick 2, [Open] fridge (5); expected CLOSED, found OPEN"
    assert Failure(Code.NO_ROOM, expected="a room").message() == "NO_ROOM: expected a room"
    assert Failure(Code.NO_ROOM).message() == "NO_ROOM"
