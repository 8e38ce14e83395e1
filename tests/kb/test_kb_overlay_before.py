"""Overlays written for the actions and affordances of version 0.1, which named no groups, load as they did."""

from __future__ import annotations

import pytest

from hearth.kb.loading.load import load

# Entries as 0.1 had them, to the letter; the needs of `Read` are a user's own.
ACTIONS = """
Grab:
  id: 17
  roles: [thing]
  needs: [{any: [GRABBABLE], classes: [child, water]}]
  before:
  - NOT_AFFORDED: affords(o)
  - NOT_CLOSE: close(a, o)
  - INSIDE_CLOSED: not hidden(o)
  - NO_FREE_HAND: free_hand(a)
  effects:
  - "for x: not ON(o, x)"
  - "for x: not ON(x, o)"
  - "for x: not INSIDE(o, x)"
  - "for x: not INSIDE(x, o)"
  - "for x: not CLOSE(o, x)"
  - CLOSE(a, o)
  - "free_right(a) -> HOLDS_RH(a, o)"
  - "not free_right(a) -> HOLDS_LH(a, o)"
  - INSIDE(o, room(a))
  - REMEMBERS(o, place(o))
  - CLOSE(a, place(o))
  say: Grab {0}
  words: [pick up, take, get, take hold of, fetch]

SwitchOn:
  id: 61
  roles: [device]
  needs: [{any: [HAS_SWITCH]}]
  before:
  - NOT_AFFORDED: affords(o)
  - NOT_CLOSE: close(a, o)
  - IS_ON: state(o, OFF)
  - IS_UNPLUGGED: not state(o, PLUGGED_OUT)
  effects: ["state(o, ON)"]
  say: Switch on {0}
  words: [turn on, start]
  aliases: [turn on]
"""

READ = """
Read:
  id: 40
  roles: [text]
  needs: [{any: [GRABBABLE]}]
  before:
  - NOT_AFFORDED: affords(o)
  - NOT_HOLDING: holds(a, o)
  effects: []
  say: Read {0}
  words: [read from, study]
"""

AFFORDANCES = """
Cut: [{any: [CUTTABLE]}]
Pour:
- any: [DRINKABLE, POURABLE]
- any: [BODY_PART, CLOTHES, RECIPIENT]
  also: {sponge: "programs pour soap on it; it holds what is poured but is not a vessel"}
Type: [{classes: [cellphone, computer, keyboard, laptop, phone, telephone]}]
"""


@pytest.fixture
def laid(tmp_path):
    def load_over(**files):
        for name, text in files.items():
            (tmp_path / f"{name}.yaml").write_text(text)
        return load(overlay=tmp_path)

    return load_over


def test_entries_of_before_say_what_ours_say(laid, knowledge):
    found = laid(actions=ACTIONS, affordances=AFFORDANCES)
    differing = {name for name, action in found.actions.items() if action != knowledge.actions[name]}
    assert differing == {"Grab", "SwitchOn"}  # which takes seats in use, and fills no sink by set 3, as they did
    ours, theirs = (known.actions["Grab"].preconditions for known in (knowledge, found))
    assert [check for check in ours if check.option != "leaves_seat"] == list(theirs)
    for action, role in (("Cut", 0), ("Pour", 0), ("Pour", 1), ("Type", 0)):
        for name in knowledge.objects:
            assert found.affords(action, role, name) == knowledge.affords(action, role, name), (action, role, name)


def test_what_an_overlay_of_before_changes_is_changed_and_no_more(laid, knowledge):
    found = laid(actions=READ, affordances="Wipe: [{any: [GRABBABLE]}]")
    differing = {name for name, action in found.actions.items() if action != knowledge.actions[name]}
    assert differing == {"Read", "Wipe"}
    assert found.actions["Read"].groups == knowledge.actions["Read"].groups
    assert found.affords("Read", 0, "cup") and not knowledge.affords("Read", 0, "cup")
    assert knowledge.affords("Wipe", 0, "table") and not found.affords("Wipe", 0, "table")


def test_a_repair_of_version_0_1_loads_without_its_edits(tmp_path):
    entry = "already_open:\n  on: IS_OPEN\n  actions: [Open]\n  do: [remove]\n  say: leave it open\n"
    (tmp_path / "repairs.yaml").write_text(entry)
    assert load(overlay=tmp_path).repairs["already_open"].say == "leave it open"
