"""Every repair, by the smallest program and world that need it."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from repair_worlds import ROOMS, small_world, steps_of

from hearth.kb.loading.load import default
from hearth.repair.handlers import registry
from hearth.repair.handlers.common import Edit, Splice
from hearth.repair.repair_loop import repair, successes
from hearth.schemas.failures import Code
from hearth.schemas.literals import Literal
from hearth.simulation.engine import run

CASES = {
    "already_open": (
        "20 fridge OPEN inside 1",
        "[Walk] <fridge> (1.20)\n[Open] <fridge> (1.20)",
        "[Walk] <fridge> (1.20)",
    ),
    "already_closed": (
        "20 fridge CLOSED inside 1",
        "[Walk] <fridge> (1.20)\n[Close] <fridge> (1.20)",
        "[Walk] <fridge> (1.20)",
    ),
    "neither_open_nor_closed": (
        "20 fridge inside 1",
        "[Walk] <fridge> (1.20)\n[Open] <fridge> (1.20)",
        "[Walk] <fridge> (1.20)",
    ),
    "closed_to_put_in": (
        "20 fridge CLOSED inside 1\n21 milk inside 1",
        "[Walk] <milk> (1.21)\n[Grab] <milk> (1.21)\n[Walk] <fridge> (1.20)\n[PutIn] <milk> (1.21) <fridge> (1.20)",
        "[Walk] <milk> (1.21)\n[Grab] <milk> (1.21)\n[Walk] <fridge> (1.20)\n[Open] <fridge> (1.20)\n"
        "[PutIn] <milk> (1.21) <fridge> (1.20)",
    ),
    "closed_to_put_back": (
        "20 fridge OPEN inside 1\n21 milk inside 20",
        "[Walk] <milk> (1.21)\n[Grab] <milk> (1.21)\n[Close] <fridge> (1.20)\n[TurnTo] <milk> (1.21)\n"
        "[PutObjBack] <milk> (1.21)",
        "[Walk] <milk> (1.21)\n[Grab] <milk> (1.21)\n[Close] <fridge> (1.20)\n[TurnTo] <milk> (1.21)\n"
        "[Open] <fridge> (1.20)\n[PutObjBack] <milk> (1.21)",
    ),
    "inside_closed": (
        "20 fridge CLOSED inside 1\n21 milk inside 20",
        "[Walk] <milk> (1.21)\n[Grab] <milk> (1.21)",
        "[Walk] <milk> (1.21)\n[Open] <fridge> (1.20)\n[Grab] <milk> (1.21)",
    ),
    "already_on": (
        "20 television ON PLUGGED_IN inside 1",
        "[Walk] <television> (1.20)\n[SwitchOn] <television> (1.20)",
        "[Walk] <television> (1.20)",
    ),
    "on_to_open": (
        "20 washing_machine ON CLOSED PLUGGED_IN inside 1",
        "[Walk] <washing_machine> (1.20)\n[Open] <washing_machine> (1.20)",
        "[Walk] <washing_machine> (1.20)\n[SwitchOff] <washing_machine> (1.20)\n[Open] <washing_machine> (1.20)",
    ),
    "already_off": (
        "20 television OFF inside 1",
        "[Walk] <television> (1.20)\n[SwitchOff] <television> (1.20)",
        "[Walk] <television> (1.20)",
    ),
    "off_to_watch": (
        "20 television OFF PLUGGED_IN inside 1",
        "[Walk] <television> (1.20)\n[TurnTo] <television> (1.20)\n[Watch] <television> (1.20)",
        "[Walk] <television> (1.20)\n[TurnTo] <television> (1.20)\n[SwitchOn] <television> (1.20)\n"
        "[Watch] <television> (1.20)",
    ),
    "already_plugged": (
        "20 television PLUGGED_IN inside 1",
        "[Walk] <television> (1.20)\n[PlugIn] <television> (1.20)",
        "[Walk] <television> (1.20)",
    ),
    "already_unplugged": (
        "20 television PLUGGED_OUT inside 1",
        "[Walk] <television> (1.20)\n[PlugOut] <television> (1.20)",
        "[Walk] <television> (1.20)",
    ),
    "unplugged_to_switch_on": (
        "20 television OFF PLUGGED_OUT inside 1",
        "[Walk] <television> (1.20)\n[SwitchOn] <television> (1.20)",
        "[Walk] <television> (1.20)\n[PlugIn] <television> (1.20)\n[SwitchOn] <television> (1.20)",
    ),
    "not_close": (
        "20 cup inside 2",
        "[Grab] <cup> (1.20)",
        "[Walk] <cup> (1.20)\n[Grab] <cup> (1.20)",
    ),
    "not_in_room": (
        "20 television ON inside 2",
        "[TurnTo] <television> (1.20)\n[Watch] <television> (1.20)",
        "[TurnTo] <television> (1.20)\n[Walk] <television> (1.20)\n[TurnTo] <television> (1.20)\n"
        "[Watch] <television> (1.20)",
    ),
    "not_facing": (
        "20 television ON inside 1",
        "[LookAt] <television> (1.20)",
        "[TurnTo] <television> (1.20)\n[LookAt] <television> (1.20)",
    ),
    "not_sitting_to_stand": (
        "20 couch inside 1",
        "[StandUp]\n[Walk] <couch> (1.20)",
        "[Walk] <couch> (1.20)",
    ),
    "not_lying_to_sleep": (
        "20 bed inside 2",
        "[Walk] <bed> (1.20)\n[Sleep]",
        "[Walk] <bed> (1.20)\n[Lie] <bed> (1.20)\n[Sleep]",
    ),
    "sitting_to_sit": (
        "20 couch inside 1",
        "[Walk] <couch> (1.20)\n[Sit] <couch> (1.20)\n[Sit] <couch> (1.20)",
        "[Walk] <couch> (1.20)\n[Sit] <couch> (1.20)",
    ),
    "lying_to_lie": (
        "20 bed inside 1",
        "[Walk] <bed> (1.20)\n[Lie] <bed> (1.20)\n[Lie] <bed> (1.20)",
        "[Walk] <bed> (1.20)\n[Lie] <bed> (1.20)",
    ),
    "sitting_to_walk": (
        "20 couch inside 1\n21 cup inside 1",
        "[Walk] <couch> (1.20)\n[Sit] <couch> (1.20)\n[Walk] <cup> (1.21)",
        "[Walk] <couch> (1.20)\n[Sit] <couch> (1.20)\n[StandUp]\n[Walk] <cup> (1.21)",
    ),
    "lying_to_walk": (
        "20 bed inside 1\n21 cup inside 1",
        "[Walk] <bed> (1.20)\n[Lie] <bed> (1.20)\n[Run] <cup> (1.21)",
        "[Walk] <bed> (1.20)\n[Lie] <bed> (1.20)\n[StandUp]\n[Run] <cup> (1.21)",
    ),
    "occupied": (
        "20 chair inside 1\n21 cat on 20 inside 1",
        "[Walk] <chair> (1.20)\n[Sit] <chair> (1.20)",
        "[Walk] <chair> (1.20)\n[Grab] <cat> (1.21)\n[Release] <cat> (1.21)\n[Sit] <chair> (1.20)",
    ),
    "occupied_by_itself": (
        "20 loveseat inside 1\n21 curtain on 20 inside 1",
        "[Walk] <loveseat> (1.20)\n[Sit] <loveseat> (1.20)\n[Lie] <loveseat> (1.20)",
        "[Walk] <loveseat> (1.20)\n[Lie] <loveseat> (1.20)",
    ),
    "not_holding": (
        "20 book inside 2",
        "[Read] <book> (1.20)",
        "[Find] <book> (1.20)\n[Grab] <book> (1.20)\n[Read] <book> (1.20)",
    ),
    "not_worn": (
        "20 clothes_jacket inside 1",
        "[Walk] <clothes_jacket> (1.20)\n[PutOff] <clothes_jacket> (1.20)",
        "[Walk] <clothes_jacket> (1.20)",
    ),
    "nothing_to_eat": (
        "20 plate inside 1\n21 food_apple inside 2",
        "[Walk] <plate> (1.20)\n[Eat] <plate> (1.20)",
        "[Walk] <plate> (1.20)\n[Walk] <food_apple> (1.21)\n[Grab] <food_apple> (1.21)\n[Walk] <plate> (1.20)\n"
        "[PutBack] <food_apple> (1.21) <plate> (1.20)\n[Eat] <plate> (1.20)",
    ),
    "never_taken": (
        "20 cup inside 1",
        "[Walk] <cup> (1.20)\n[PutObjBack] <cup> (1.20)",
        "[Walk] <cup> (1.20)",
    ),
}
"""World (beside the rooms and the character), program, repaired program, by the name of the repair."""


@pytest.mark.parametrize("name", CASES)
def test_a_repair_does_what_it_says(name, repaired):
    world, program, expected = CASES[name]
    result, steps, names = repaired(ROOMS + world, program)
    assert result.failure is None
    assert steps == expected.split("\n")
    assert name in names
    assert result.execution.executable


def test_a_door_is_opened_from_whichever_side(repaired):
    rooms = "1 kitchen\n2 bedroom\n9 door CLOSED inside {} between 1 2\n10 character inside 1\n20 bed inside 2"
    for side in (1, 2):
        result, steps, names = repaired(rooms.format(side), "[Walk] <bed> (1.20)")
        assert result.failure is None
        assert steps == ["[Walk] <door> (1.9)", "[Open] <door> (1.9)", "[Walk] <bed> (1.20)"]
        assert names == ["door_closed"]


def test_a_door_that_is_in_no_room_is_opened_too(repaired):
    rooms = "1 kitchen\n2 bedroom\n9 door CLOSED between 1 2\n10 character inside 1\n20 bed inside 2"
    _, steps, _ = repaired(rooms, "[Walk] <bed> (1.20)")
    assert steps == ["[Walk] <door> (1.9)", "[Open] <door> (1.9)", "[Walk] <bed> (1.20)"]


def test_a_thing_is_put_down_and_taken_up_again_after(repaired):
    held = "20 fridge CLOSED inside 1\n21 cup inside 1\n22 book inside 1\n"
    rooms = ROOMS.replace("10 character inside 1", "10 character inside 1 right 21 left 22") + held
    _, steps, names = repaired(rooms, "[Walk] <fridge> (1.20)\n[Open] <fridge> (1.20)")
    assert steps == [
        "[Walk] <fridge> (1.20)",
        "[Release] <cup> (1.21)",
        "[Open] <fridge> (1.20)",
        "[Grab] <cup> (1.21)",
    ]
    assert names == ["no_free_hand"]


def test_what_a_program_needs_is_kept_in_the_hand(repaired):
    held = "20 table inside 1\n21 cup inside 1\n22 book inside 1\n23 plate inside 1\n"
    rooms = ROOMS.replace("10 character inside 1", "10 character inside 1 right 21 left 22") + held
    program = (
        "[Walk] <plate> (1.23)\n[Grab] <plate> (1.23)\n[Walk] <table> (1.20)\n[PutBack] <cup> (1.21) <table> (1.20)"
    )
    _, steps, _ = repaired(rooms, program)
    assert "[Release] <book> (1.22)" in steps
    assert "[Release] <cup> (1.21)" not in steps


def test_who_sits_on_a_couch_fetches_first(repaired):
    world = ROOMS + "20 couch inside 1\n21 book inside 2"
    program = (
        "[Walk] <couch> (1.20)\n[Sit] <couch> (1.20)\n[Find] <book> (1.21)\n[Grab] <book> (1.21)\n[Read] <book> (1.21)"
    )
    goal = (Literal.of("SITTING", ("character", 1)), Literal.of("HOLDS", ("character", 1), ("book", 1)))
    result, steps, _ = repaired(world, program, goal)
    assert result.failure is None
    assert steps == [
        "[Find] <book> (1.21)",
        "[Grab] <book> (1.21)",
        "[Walk] <couch> (1.20)",
        "[Sit] <couch> (1.20)",
        "[Read] <book> (1.21)",
    ]


def test_who_sits_on_a_chair_sits_down_later_instead(repaired):
    """A chair takes one, and who has sat on it stays ON it until the end, as in the release."""
    world = ROOMS + "20 chair inside 1\n21 book inside 2"
    program = (
        "[Walk] <chair> (1.20)\n[Sit] <chair> (1.20)\n[Find] <book> (1.21)\n[Grab] <book> (1.21)\n[Read] <book> (1.21)"
    )
    goal = (Literal.of("SITTING", ("character", 1)), Literal.of("HOLDS", ("character", 1), ("book", 1)))
    result, steps, _ = repaired(world, program, goal)
    assert result.failure is None
    assert (
        steps.index("[Grab] <book> (1.21)") < steps.index("[Sit] <chair> (1.20)") < steps.index("[Read] <book> (1.21)")
    )
    assert steps.count("[Sit] <chair> (1.20)") == 1


def test_a_place_is_found_for_what_was_never_taken_from_one(repaired):
    world = (
        ROOMS.replace("10 character inside 1", "10 character inside 1 right 21") + "20 table inside 1\n21 cup inside 1"
    )
    result, steps, names = repaired(world, "[PutObjBack] <cup> (1.21)")
    assert result.failure is None
    assert steps == ["[Walk] <table> (1.20)", "[PutBack] <cup> (1.21) <table> (1.20)"]
    assert names[0] == "no_origin"


def test_wiping_takes_a_cloth_and_cutting_a_knife(repaired):
    world = ROOMS + "20 table inside 1\n21 towel inside 2\n22 knife inside 2\n23 food_bread inside 1"
    _, steps, _ = repaired(world, "[Walk] <table> (1.20)\n[Wipe] <table> (1.20)")
    assert "[Grab] <towel> (1.21)" in steps
    _, steps, _ = repaired(world, "[Walk] <food_bread> (1.23)\n[Cut] <food_bread> (1.23)")
    assert "[Grab] <knife> (1.22)" in steps


def test_a_lost_goal_is_brought_about_at_the_end(repaired):
    world = ROOMS + "20 table inside 1\n21 cup inside 2\n22 television OFF PLUGGED_IN inside 2"
    goal = (Literal.of("ON", ("cup", 1), ("table", 1)), Literal.of("ON", ("television", 1)))
    program = "[Walk] <table> (1.20)\n[TurnTo] <cup> (1.21)\n[TurnTo] <television> (1.22)"
    result, steps, names = repaired(world, program, goal)
    assert result.failure is None
    assert names == ["goal_lost", "goal_lost"]
    assert {"[PutBack] <cup> (1.21) <table> (1.20)", "[SwitchOn] <television> (1.22)"} <= set(steps)


def test_another_character_lets_go_first(repaired):
    world = "1 kitchen\n10 character inside 1\n11 character inside 1 right 20\n20 cup inside 1"
    result, steps, names = repaired(world, "[Walk] <cup> (1.20)\n[Grab] <cup> (1.20)")
    assert result.failure is None
    assert steps == ["[Walk] <cup> (1.20)", "<char1> [Release] <cup> (1.20)", "[Grab] <cup> (1.20)"]
    assert names == ["held_by_other"]


def test_what_can_not_be_done_together_is_done_one_after_the_other(repaired):
    world = "1 kitchen\n10 character inside 1 close 20\n11 character inside 1 close 20\n20 television OFF inside 1"
    program = "<char0> [SwitchOn] <television> (1.20) | <char1> [SwitchOn] <television> (1.20)"
    result, steps, names = repaired(world, program)
    assert result.failure is None
    assert names == ["conflict", "already_on"]
    assert steps == ["[SwitchOn] <television> (1.20)"]


def test_every_code_is_handled_hopeless_or_of_another_stage():
    assert registry.unclassified() == ()
    assert all(reason for reason in registry.UNREPAIRABLE.values())


def test_a_code_that_nobody_thought_of_is_noticed(monkeypatch):
    monkeypatch.delitem(registry.HANDLERS, Code.IS_OPEN)
    assert registry.unclassified() == (Code.IS_OPEN,)
    monkeypatch.setitem(registry.UNREPAIRABLE, Code.IS_ON, "said twice")
    assert set(registry.unclassified()) == {Code.IS_OPEN, Code.IS_ON}


def test_every_check_of_an_action_has_its_code_handled_or_hopeless():
    codes = {check.code for action in default().actions.values() for check in action.preconditions}
    assert codes <= registry.HANDLERS.keys() | registry.UNREPAIRABLE.keys()


def test_the_repairs_of_the_knowledge_have_a_handler_of_the_same_code():
    for row in default().repairs.values():
        assert row.code in registry.HANDLERS
        assert re.fullmatch("[a-z_]+", row.name)


@pytest.mark.parametrize("row", [r.name for r in default().repairs.values() if r.source == "A.4"])
def test_every_row_of_table_a4_is_used_by_the_handlers_that_carry_its_name(row):
    tested = {*CASES, "no_free_hand", "door_closed"}
    assert row in tested, "add the smallest program that needs it"


HOPELESS = {
    Code.NOT_AFFORDED: "[Walk] <cup> (1.20)\n[Sit] <cup> (1.20)",
    Code.NOT_SIMULATED: "[Jump]",
    Code.NO_ROOM: "[Walk] <ghost> (1.30)",
    Code.UNBOUND: "[Walk] <cup> (2.99)",
    Code.UNKNOWN_AGENT: "<char3> [StandUp]",
}


def test_only_plans_of_homes_and_bare_text_lead_to_the_rest():
    assert registry.UNREPAIRABLE.keys() - HOPELESS.keys() == {Code.NO_PATH, Code.UNKNOWN_ACTION}


@pytest.mark.parametrize("code", HOPELESS)
def test_what_is_hopeless_is_given_up_at_once(code):
    world = small_world(ROOMS + "20 cup inside 1\n30 book")
    result = repair(steps_of(HOPELESS[code]), world, (), world.home.knowledge)
    assert result.failure.code is Code.NO_HANDLER
    assert str(code) in result.failure.expected
    assert registry.UNREPAIRABLE[code] in result.failure.actual
    assert [a.after for a in result.attempts] == [()]


def _broken(context):
    raise ValueError("no idea")


def _useless(context):
    return Edit("useless", (Splice(0, 0, ()),))


def _growing(context):
    return Edit("growing", (Splice(0, 0, (context.does("TurnTo", context.object()),)),))


@pytest.mark.parametrize(
    ("handler", "code", "tries"),
    [(_broken, Code.HANDLER_ERROR, 1), (_useless, Code.LOOP, 1), (_growing, Code.TOO_MANY_TRIES, 20)],
)
def test_a_handler_that_raises_or_goes_round_in_circles_costs_only_its_program(handler, code, tries, repaired):
    world, program, _ = CASES["already_open"]
    result, _, names = repaired(ROOMS + world, program, handlers={Code.IS_OPEN: handler})
    assert result.failure.code is code
    assert len(names) == tries


def test_an_attempt_tells_failure_step_and_both_programs(repaired):
    world, program, _ = CASES["inside_closed"]
    result, _, _ = repaired(ROOMS + world, program)
    (attempt,) = result.attempts
    assert (attempt.number, attempt.step, attempt.failure.code) == (0, 1, Code.INSIDE_CLOSED)
    assert len(attempt.before) == 2
    assert len(attempt.after) == 3
    start = result.execution.worlds[0]
    assert run(start, result.program.with_steps(attempt.before)).failure == attempt.failure


def test_a_container_that_is_not_close_is_walked_to_and_opened_in_one_repair(repaired):
    world = ROOMS + "20 fridge CLOSED inside 1\n21 milk inside 20 close 22\n22 table inside 1"
    result, steps, handlers = repaired(world, "[Walk] <table> (1.22)\n[Grab] <milk> (1.21)")
    assert result.failure is None
    assert steps[1:] == ["[Walk] <fridge> (1.20)", "[Open] <fridge> (1.20)", "[Grab] <milk> (1.21)"]
    assert handlers == ["inside_closed"]


def test_an_attempt_succeeded_if_its_failure_did_not_come_back(repaired):
    world, program, _ = CASES["inside_closed"]
    (first,) = repaired(ROOMS + world, program)[0].attempts
    second = replace(first, number=1, step=3, failure=replace(first.failure, code=Code.NOT_CLOSE))
    assert successes((first, second), None) == (True, True)
    assert successes((first, second), second.failure) == (True, False)
    assert successes((first, first), None) == (False, True)
    assert successes((replace(first, after=()),), None) == (False,)
    assert successes((), first.failure) == ()
