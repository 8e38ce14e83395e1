"""Preconditions are what a program needs and no earlier step of it provides, each explained by the step."""

import pytest

from hearth.datasets.format.case_rows import run_row
from hearth.grounding.grounded_run import Trial, attempt
from hearth.grounding.preconditions.precondition_inference import at_odds, infer
from hearth.kb import action_grammar
from hearth.schemas.failures import Code, Failure
from hearth.schemas.literals import CHARACTER
from hearth.schemas.syntax import parse_program
from hearth.simulation.rules import DEFAULT, WATCHING_OFF, suited


def read(knowledge, *steps):
    program, faults = parse_program("A title\n\n\n" + "\n".join(steps))
    program, wrong = action_grammar.check(program, knowledge)
    assert not faults and not wrong
    return program


def conditions_of(knowledge, *steps):
    return infer(read(knowledge, *steps), knowledge)


def facts(found):
    return {str(condition): condition.step for condition in found}


@pytest.mark.parametrize(
    ("steps", "condition", "step"),
    [
        (["[Walk] <television> (1)", "[SwitchOn] <television> (1)"], "is_off(television (1))", 1),
        (["[Walk] <television> (1)", "[SwitchOff] <television> (1)"], "is_on(television (1))", 1),
        (["[Walk] <television> (1)", "[SwitchOn] <television> (1)"], "plugged(television (1))", 1),
        (["[Walk] <television> (1)", "[PlugIn] <television> (1)"], "unplugged(television (1))", 1),
        (["[Walk] <television> (1)", "[PlugOut] <television> (1)"], "plugged(television (1))", 1),
        (["[Walk] <fridge> (1)", "[Open] <fridge> (1)"], "closed(fridge (1))", 1),
        (["[Walk] <fridge> (1)", "[Close] <fridge> (1)"], "open(fridge (1))", 1),
        (["[StandUp]", "[Walk] <bed> (1)"], "sitting(character (1))", 0),
        (["[WakeUp]"], "lying(character (1))", 0),
        (["[Grab] <cup> (1)"], "nearby(cup (1), character (1))", 0),
        (["[Walk] <computer> (1)", "[Grab] <mouse> (1)"], "atreach(mouse (1), computer (1))", 1),
        (["[Walk] <desk> (1)", "[Grab] <mouse> (1)"], "in(mouse (1), desk (1))", 1),
        (["[PutOff] <clothes_shirt> (1)"], "in(clothes_shirt (1), character (1))", 0),
        (["[Walk] <couch> (1)", "[Sit] <couch> (1)"], "free(couch (1))", 1),
        (["[Read] <book> (1)"], "holds(book (1), character (1))", 0),
        (
            ["[Walk] <couch> (1)", "[Sit] <couch> (1)", "[Watch] <television> (1)"],
            "facing(couch (1), television (1))",
            2,
        ),
        (
            ["[Walk] <television> (1)", "[TurnTo] <television> (1)", "[Watch] <television> (1)"],
            "is_on(television (1))",
            2,
        ),
        (
            [
                "[Walk] <kitchen> (1)",
                "[Walk] <fridge> (1)",
                "[Open] <fridge> (1)",
                "[Find] <milk> (1)",
                "[Grab] <milk> (1)",
            ],
            "inside(milk (1), fridge (1))",
            4,
        ),
        (["[Walk] <kitchen> (1)", "[Walk] <fridge> (1)"], "location(fridge (1), kitchen (1))", 1),
    ],
)
def test_a_step_needs(knowledge, steps, condition, step):
    assert facts(conditions_of(knowledge, *steps)).get(condition) == step


def test_what_the_program_provides_is_not_needed(knowledge):
    found = facts(conditions_of(knowledge, "[Walk] <fridge> (1)", "[Open] <fridge> (1)", "[Close] <fridge> (1)"))
    assert "open(fridge (1))" not in found


@pytest.mark.parametrize(
    ("steps", "needing", "violating"),
    [
        (["[Walk] <television> (1)", "[SwitchOn] <television> (1)", "[SwitchOn] <television> (1)"], 3, 2),
        (["[Walk] <fridge> (1)", "[Open] <fridge> (1)", "[Open] <fridge> (1)"], 3, 2),
        (["[Grab] <cup> (1)", "[PutBack] <cup> (1) <table> (1)", "[Drink] <cup> (1)"], 3, 2),
    ],
)
def test_a_contradiction_names_both_steps(knowledge, steps, needing, violating):
    found = conditions_of(knowledge, *steps)
    assert isinstance(found, Failure)
    assert found.code is Code.CONTRADICTION
    assert found.expected.endswith(f"at step {needing}")
    assert f"by step {violating}," in found.actual


@pytest.mark.parametrize(
    ("actions", "off"),
    [
        (["Watch", "SwitchOn"], True),
        (["SwitchOn", "SwitchOff", "Watch"], True),
        (["SwitchOff", "Watch"], True),
        (["Watch"], False),
        (["SwitchOn", "Watch", "SwitchOff"], False),
        (["Watch", "SwitchOff", "SwitchOn"], False),
        (["Watch", "SwitchOff", "SwitchOn", "Watch"], False),
    ],
)
def test_who_keeps_off_what_is_watched_means_it(knowledge, maple, actions, off):
    program = read(knowledge, *(f"[{action}] <television> (1)" for action in ("Walk", "TurnTo", *actions)))
    assert suited(program, knowledge) == (WATCHING_OFF if off else DEFAULT)
    found = attempt(program, maple)
    assert isinstance(found, Trial) and found.execution.executable
    assert run_row(found.execution)["rules"] == ("leaves_seat_watching_off" if off else "leaves_seat")


def test_a_third_thing_in_two_hands_is_a_contradiction(knowledge):
    steps = [f"[{verb}] <{name}> (1)" for name in ("cup", "plate", "book") for verb in ("Walk", "Grab")]
    found = conditions_of(knowledge, *steps)
    assert isinstance(found, Failure) and "NO_FREE_HAND" in found.expected


def test_an_action_that_is_not_executed_stays_that(knowledge):
    found = conditions_of(knowledge, "[Walk] <book> (1)", "[Write] <book> (1)")
    assert isinstance(found, Failure) and found.code is Code.NOT_SIMULATED


def test_the_character_has_a_name_of_its_own(knowledge):
    assert conditions_of(knowledge, "[StandUp]").has("sitting", CHARACTER)


@pytest.mark.parametrize(
    ("steps", "needing", "violating"),
    [
        # A walk between two acts of the hands does not belong to the contradiction.
        (["[Walk] <sofa> (1)", "[Sit] <sofa> (1)", "[Touch] <sofa> (1)", "[Walk] <kitchen> (1)"], 4, (2,)),
        (["[Grab] <cup> (1)", "[Grab] <plate> (1)", "[Walk] <sofa> (1)", "[Grab] <book> (1)"], 4, (1, 2)),
        (["[Walk] <tv> (1)", "[SwitchOn] <tv> (1)", "[Walk] <sofa> (1)", "[SwitchOn] <tv> (1)"], 4, (2,)),
        (["[Walk] <tv> (1)", "[SwitchOn] <tv> (1)", "[Find] <cup> (1)", "[SwitchOn] <tv> (1)"], 4, (2,)),
        (["[Walk] <tv> (1)", "[Watch] <tv> (1)"], 2, ()),
        (["[StandUp]", "[Walk] <bed> (1)", "[StandUp]"], 3, (1,)),
    ],
)
def test_a_contradiction_names_the_steps_that_make_it(knowledge, steps, needing, violating):
    """Without one of the named steps, the program up to the failing step runs from some start."""
    program = read(knowledge, *steps)
    found = infer(program, knowledge)
    assert isinstance(found, Failure) and found.code is Code.CONTRADICTION, found
    assert at_odds(program, knowledge) == (*(number - 1 for number in violating), needing - 1), found
    until = program.steps[:needing]
    for number in violating if steps[0] != "[StandUp]" else ():  # there, only both steps before it together prevent it
        rest = [step for k, step in enumerate(until) if k != number - 1]
        assert not isinstance(infer(program.with_steps(rest), knowledge), Failure)
