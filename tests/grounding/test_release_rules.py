"""The release's rules beside ours: the same, not needed, or refused with the step that says why."""

import pytest

from hearth.grounding.preconditions.precondition_inference import at_odds, infer
from hearth.grounding.preconditions.release_rules import by_rules, compare
from hearth.kb import action_grammar
from hearth.schemas.literals import CHARACTER, Literal
from hearth.schemas.syntax import parse_program


@pytest.fixture
def read(knowledge):
    def parse(*lines):
        program, faults = parse_program("Title\nWords.\n\n\n" + "\n".join(lines) + "\n")
        program, wrong = action_grammar.check(program, knowledge)
        assert not faults and not wrong
        return program

    return parse


@pytest.mark.parametrize(
    ("lines", "fact"),
    [
        (("[PlugIn] <television> (1)",), ("unplugged", (("television", 1),))),
        (("[SwitchOn] <television> (1)",), ("is_off", (("television", 1),))),
        (("[SwitchOn] <television> (1)",), ("plugged", (("television", 1),))),
        (("[Close] <fridge> (1)",), ("open", (("fridge", 1),))),
        (("[Sit] <couch> (1)", "[Touch] <phone> (1)"), ("atreach", (("couch", 1), ("phone", 1)))),
        (("[StandUp]",), ("sitting", (CHARACTER,))),
        (("[Grab] <cup> (1)",), ("nearby", (("cup", 1), CHARACTER))),
        (("[Walk] <table> (1)", "[Grab] <cup> (1)"), ("atreach", (("cup", 1), ("table", 1)))),
        (("[PutOff] <hat> (1)",), ("in", (("clothes_hat", 1), CHARACTER))),
        (("[Walk] <kitchen> (1)", "[Walk] <cup> (1)"), ("location", (("cup", 1), ("kitchen", 1)))),
        (("[Open] <fridge> (1)", "[Grab] <milk> (1)"), ("inside", (("milk", 1), ("fridge", 1)))),
        (("[Walk] <desk> (1)", "[Grab] <pen> (1)"), ("in", (("pen", 1), ("desk", 1)))),
        (("[Sit] <couch> (1)", "[Watch] <television> (1)"), ("facing", (("couch", 1), ("television", 1)))),
        (("[Walk] <bed> (1)",), ("free", (("bed", 1),))),
    ],
)
def test_each_rule_says_its_condition(read, knowledge, lines, fact):
    assert Literal(*fact) in {condition.literal for condition in by_rules(read(*lines), knowledge)}


def test_what_is_not_ours_is_explained(read, knowledge):
    program = read("[Walk] <desk> (1)", "[Walk] <pen> (1)", "[Grab] <pen> (1)", "[Walk] <bed> (1)")
    found = {c.condition.name: c for c in compare(program, infer(program, knowledge), knowledge)}
    assert not found["free"].ours and found["free"].why.startswith("not needed")
    opened = read("[Walk] <fridge> (1)", "[Open] <fridge> (1)")
    assert all(c.ours for c in compare(opened, infer(opened, knowledge), knowledge))


def test_the_steps_at_odds_are_named(read, knowledge):
    lines = "[Walk] <fridge> (1)", "[Open] <fridge> (1)", "[Walk] <fridge> (1)", "[Open] <fridge> (1)"
    assert at_odds(read(*lines), knowledge) == (1, 3)
    assert at_odds(read("[Walk] <television> (1)"), knowledge) == ()
