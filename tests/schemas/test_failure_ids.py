"""Published ids of failures never change."""

from __future__ import annotations

from hearth.schemas.failure_ids import FAILURE_IDS
from hearth.schemas.failures import Code


def test_every_code_has_an_id_of_its_own():
    assert set(FAILURE_IDS) == set(Code)
    assert len({*FAILURE_IDS.values()}) == len(FAILURE_IDS)


def test_ids_are_those_published():
    """Whoever changes one of these breaks datasets that people have."""
    known = {"EMPTY": 0, "SYNTAX": 11, "NOT_AFFORDED": 21, "GOAL_LOST": 61, "REPLAY_DIFFERS": 65}
    assert {name: FAILURE_IDS[Code(name)] for name in known} == known
