"""Rows of processes.yaml laid over ours: what never ends, goes in a circle or asks for nothing is a fault."""

from __future__ import annotations

import pytest

from hearth.kb.loading.load import load
from hearth.schemas.diagnostics import HearthError

ON = "class(x, radio) & state(x, ON)"

FAULTS = {
    "never ends": f'a:\n  while: "{ON}"\n  after: 3\n  becomes: ["state(x, HOT)"]\n',
    "is 0: it never ends": f'a:\n  while: "{ON} & not state(x, HOT)"\n  after: 0\n  becomes: ["state(x, HOT)"]\n',
    "is 99999": f'a:\n  while: "{ON} & not state(x, HOT)"\n  after: 99999\n  becomes: ["state(x, HOT)"]\n',
    "lead to each other for ever": 'a:\n  while: "state(x, WRITTEN) & not state(x, CUT)"\n  after: 1\n'
    '  becomes: ["state(x, CUT)"]\nb:\n  while: "state(x, CUT) & not state(x, WRITTEN)"\n  after: 1\n'
    '  becomes: ["state(x, WRITTEN)"]\n',
    "undo each other for ever": f'a:\n  while: "{ON} & not state(x, HOT)"\n  after: 3\n  becomes: ["state(x, HOT)"]\n'
    f'b:\n  while: "{ON} & not state(x, COLD)"\n  after: 3\n  becomes: ["state(x, COLD)"]\n',
    "lacks `becomes`": f'a:\n  while: "{ON}"\n  after: 3\n',
    "is not part of a process": f'a:\n  while: "{ON}"\n  after: 3\n  becomes: ["state(x, OFF)"]\n  until: 4\n',
    "nothing starts": 'a:\n  while: "class(x, radio) & not state(x, HOT)"\n  after: 3\n  becomes: ["state(x, HOT)"]\n',
    "is nothing that a process asks for": 'a:\n  while: "close(x, x) & state(x, ON)"\n  after: 3\n'
    '  becomes: ["state(x, OFF)"]\n',
    "is more than literals": 'a:\n  while: "state(x, ON) | state(x, HOT)"\n  after: 3\n  becomes: ["state(x, OFF)"]\n',
    "does not say which x": 'a:\n  while: "state(x, ON) & state(d, ON)"\n  after: 3\n  becomes: ["state(x, OFF)"]\n',
    "nothing can be brought into": f'a:\n  while: "{ON}"\n  after: 3\n  becomes: ["state(x, PURPLE)"]\n',
    "is not a state that x enters": f'a:\n  while: "{ON}"\n  after: 3\n  becomes: ["CLOSE(x, x)"]\n',
    "it is a list": f'a:\n  while: "{ON}"\n  after: 3\n  becomes: soon\n',
}


@pytest.mark.parametrize("words", FAULTS)
def test_a_row_that_cannot_go_on_is_a_fault_with_its_line(tmp_path, words):
    (tmp_path / "processes.yaml").write_text("# ours\n" + FAULTS[words])
    with pytest.raises(HearthError) as raised:
        load(overlay=tmp_path)
    faults = [fault for fault in raised.value.diagnostics if words in f"{fault.message}; {fault.suggestion}"]
    assert faults, raised.value
    for fault in raised.value.diagnostics:
        assert fault.file.endswith("processes.yaml") and fault.line >= 2, fault


def test_a_row_of_a_user_is_one_more(tmp_path, knowledge):
    (tmp_path / "processes.yaml").write_text(
        f'radio_ends:\n  while: "{ON}"\n  after: 3\n  becomes: ["state(x, OFF)"]\n'
    )
    found = load(overlay=tmp_path).processes
    assert set(found) == {*knowledge.processes, "radio_ends"} and found["radio_ends"].after == 3


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ("set: 4\n  effects: []", "`set` of Break is 4"),
        ("set: 3\n  ticks: 0\n  effects: []", "`ticks` of Break is 0"),
        ("set: 3\n  like: Fold\n  effects: []", "an action that sets 1 and 2 execute"),
        ('set: 3\n  effects: ["gone(a, o)"]', "is not an effect"),
        ('set: 3\n  effects: ["state(o, PURPLE)"]', "nothing can be brought into that state"),
        ('effects: []\n  unless: [{IS_OFF: "state(o, ON)"}]', "sets 1 and 2 make no check IS_OFF"),
        ('effects: []\n  besides: [{WRONG_STATE: "state(o, CUT)"}]', "not state(o, STATE)"),
        ('effects: []\n  besides: [{WRONG_STATE: "not state(o, PURPLE)"}]', "PURPLE"),
        ('set: 3\n  before: [{WRONG_STATE: "not state(o, PURPLE)"}]\n  effects: []', "PURPLE"),
        ('set: 3\n  effects: ["state(o, PURPLE) -> state(o, CUT)"]', "PURPLE"),
        ('set: 3\n  effects: []\n  besides: [{WRONG_STATE: "not state(o, CUT)"}]', "set 3 makes all its checks"),
        ('before: [{IS_OFF: "state(o, ON)"}]\n  unless: [{IS_OFF: "property(o, CLOTHES)"}]', "state(o, STATE)"),
    ],
)
def test_an_action_of_set_3_that_cannot_be_read_is_a_fault(tmp_path, entry, words):
    text = "Break:\n  id: 0\n  roles: [thing]\n  needs: [{any: [GRABBABLE]}]\n  say: Break {0}\n  " + entry + "\n"
    (tmp_path / "actions.yaml").write_text(text)
    with pytest.raises(HearthError) as raised:
        load(overlay=tmp_path)
    assert any(words in f"{f.message}; {f.suggestion}" and f.line == 1 for f in raised.value.diagnostics), raised.value


def test_an_overlay_of_before_that_renames_a_written_action_is_read(tmp_path, knowledge):
    text = 'Break: {id: 0, roles: [thing], needs: [{any: [GRABBABLE]}], say: "Smash {0}", words: [snap]}\n'
    (tmp_path / "actions_written.yaml").write_text(text)
    found = load(overlay=tmp_path).actions["Break"]
    assert found.template == "Smash {0}" and not found.executed
    assert found.later == knowledge.actions["Break"].later
