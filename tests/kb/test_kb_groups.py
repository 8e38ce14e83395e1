"""Groups of actions: derived from literals, named in the file, kept under an overlay that names none."""

from __future__ import annotations

import pytest

from hearth.kb.action_groups import DECLARED, DERIVED
from hearth.kb.loading.load import load
from hearth.schemas.diagnostics import HearthError

OPEN_ANEW = """
Open:
  id: 27
  roles: [container]
  needs: [{any: [CAN_OPEN]}]
  before:
  - NOT_CLOSE: close(a, o)
  effects: ["state(o, OPEN)"]
  say: Open {0}
"""


@pytest.mark.parametrize(
    ("group", "actions"),
    [
        ("walks", "Run Walk"),
        ("goes", "Crawl Find Run Walk Walktowards"),
        ("takes", "Grab"),
        ("frees_hand", "Drop PutBack PutIn PutObjBack PutOn Release"),
        ("lets_go", "Drop Release"),
        ("forgets", "Drop PutObjBack Release"),
        ("puts", "PutBack PutIn"),
        ("rests", "Lie Sit"),
        ("rises", "StandUp"),
        ("dresses", "PutOff PutOn"),
        ("operates", "Close Open PlugIn PlugOut SwitchOff SwitchOn"),
    ],
)
def test_a_group_follows_from_literals(knowledge, group, actions):
    assert sorted(knowledge.group(group)) == actions.split()


def test_every_group_has_actions(knowledge):
    assert all(knowledge.group(name) for name in (*DECLARED, *DERIVED, "operates"))


def test_what_brings_a_state_about(knowledge):
    assert knowledge.achieving("CLEAN") == {"Rinse", "Scrub", "Wash", "Wipe"}
    assert knowledge.achieving("ON") == {"SwitchOn"}  # what is put ON something is another matter
    assert knowledge.achiever("CLEAN") == "Wash" and knowledge.achiever("DIRTY") == ""
    assert knowledge.state_of("Close") == "CLOSED" and knowledge.state_of("Sit") == ""


def test_where_a_thing_is_put(knowledge):
    found = {name: knowledge.relation_of(name) for name in knowledge.actions if knowledge.relation_of(name)}
    assert found == {"PutBack": "ON", "PutIn": "INSIDE"}


def test_what_is_needed_in_hand_without_being_named(knowledge):
    found = {name: knowledge.tool_of(name) for name in knowledge.actions if knowledge.tool_of(name) is not None}
    assert found == {"Cut": "knife", "Wipe": ""}


def test_an_overlay_without_groups_keeps_ours(tmp_path, knowledge):
    (tmp_path / "actions.yaml").write_text(OPEN_ANEW)
    laid = load(overlay=tmp_path)
    assert laid.actions["Open"].preconditions != knowledge.actions["Open"].preconditions
    for name in (*DECLARED, *DERIVED, "operates"):
        assert laid.group(name) == knowledge.group(name), name


def test_an_overlay_may_change_groups(tmp_path):
    (tmp_path / "actions.yaml").write_text(f"{OPEN_ANEW}  groups: [unsaid]\n")
    laid = load(overlay=tmp_path)
    assert laid.actions["Open"].groups == {"unsaid"} and "Open" in laid.group("hand")
    assert "Open" not in laid.group("preparation")


def test_an_unknown_group_is_refused_with_its_place(tmp_path):
    (tmp_path / "actions.yaml").write_text(f"{OPEN_ANEW}  groups: [opens]\n")
    with pytest.raises(HearthError) as error:
        load(overlay=tmp_path)
    (fault,) = error.value.diagnostics
    assert "`opens` is not a group" in fault.message and fault.line == 2
