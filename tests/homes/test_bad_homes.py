"""Plans that cannot be: every error names the thing, where it is, and what would mend it."""

import pytest

from hearth.homes.plans.layout import read
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

KITCHEN = "home: x\nrooms:\n- name: kitchen\n  at: [0, 0]\n  size: [4, 4]\n"


def faults(text):
    with pytest.raises(HearthError) as caught:
        read(text, "x.yaml", default())
    return caught.value.diagnostics


@pytest.mark.parametrize(
    ("text", "code", "named", "line"),
    [
        (KITCHEN + "- name: bedroom\n  at: [3, 1]\n  size: [3, 3]\ndoors:\n- {between: [kitchen, bedroom]}\n",
         Code.CONTRADICTION, ("kitchen", "bedroom"), 6),
        (KITCHEN + "- name: bedroom\n  at: [4, 0]\n  size: [3, 3]\ndoors: []\n", Code.NO_PATH, ("bedroom",), 6),
        (KITCHEN + "  furniture:\n  - table: {spot: [3.9, 2.0]}\ndoors: []\n", Code.NO_PLACE, ("table",), 7),
    ],
    ids=["overlapping rooms", "a room nobody can enter", "furniture through a wall"],
)  # fmt: skip
def test_what_cannot_be_is_named_with_its_line_and_a_remedy(text, code, named, line):
    found = [fault for fault in faults(text) if fault.code == code]
    assert any(all(name in fault.message for name in named) for fault in found), [f.message for f in faults(text)]
    first = next(fault for fault in found if all(name in fault.message for name in named))
    assert (first.file, first.line) == ("x.yaml", line) and first.suggestion
