"""Goals that are true before the first step, where a program came with its start."""

import pytest

from hearth.kb.loading.load import default
from hearth.pipelines.checks.meaning_checks import met_at_start
from hearth.schemas.syntax import parse_program

TELEVISION = {"name": "television", "instance": 1}


def grounding(*states, home="h"):
    start = {"nodes": [{"id": 7, "states": list(states)}]}
    return {"home": home, "bindings": [TELEVISION | {"node": 7}], "start": start}


def warned(steps, groundings=(), conditions=()):
    program, faults = parse_program(steps)
    assert not faults
    return [
        (one.code, one.step, one.message.partition("already, ")[2])
        for one in met_at_start(program, groundings, conditions, default())
    ]


ON = "[Walk] <television> (1)\n[SwitchOn] <television> (1)\n"


@pytest.mark.parametrize(
    ("steps", "states", "expected"),
    [
        (ON, ["ON"], [("NO_EFFECT", 1, "in h")]),
        (ON, ["OFF", "PLUGGED_IN"], []),
        ("[SwitchOff] <television> (1)\n" + ON, ["OFF"], [("NO_EFFECT", 0, "in h")]),
        ("[SwitchOff] <television> (1)\n" + ON, ["ON"], []),  # true at the start, and not any more when its turn comes
    ],
)
def test_in_a_graph(steps, states, expected):
    assert warned(steps, [grounding(*states)]) == expected


def test_by_conditions_and_without_any_start():
    conditions = [
        {"name": "is_on", "objects": [TELEVISION]},
        {"name": "sitting", "objects": [{"name": "character", "instance": 1}]},
    ]
    assert warned(ON, [grounding("ON"), grounding("OFF", home="g")], conditions) == [
        ("NO_EFFECT", 1, "by its own conditions, in h")
    ]
    assert warned(ON, [{"home": "h", "bindings": [], "start": None}]) == []
