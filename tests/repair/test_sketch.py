"""Sketches: the steps that are the activity."""

from __future__ import annotations

import pytest

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.repair.activity_steps import _is_tool, _used_after, asked
from hearth.repair.sketch import inherited, sketch
from hearth.schemas.syntax import parse_program, print_step
from hearth.simulation.world.home import Home


@pytest.fixture(scope="module")
def homes():
    return [Home.from_graph(library.load_graph(name, default()), name, default()) for name in library.names()[:2]]


def program_of(title, description, *steps):
    program, faults = parse_program("\n".join([title, description, "", "", *steps]))
    assert not faults
    return program


def kept(program, homes):
    keep = sketch(program, homes, default())
    return [print_step(step) for step, one in zip(program.steps, keep, strict=True) if one]


def test_the_way_and_what_leads_to_a_step_are_not_the_activity(homes):
    program = program_of(
        "Read", "I read.", "[Walk] <bedroom> (1)", "[Walk] <novel> (1)", "[Grab] <novel> (1)", "[Read] <novel> (1)"
    )
    assert kept(program, homes) == ["[Read] <novel> (1)"]


def test_what_is_opened_to_put_things_in_is_left_out_and_what_is_put_in_stays(homes):
    program = program_of(
        "Wash clothes", "", "[Walk] <clothes_shirt> (1)", "[Grab] <clothes_shirt> (1)", "[Walk] <washing_machine> (1)",
        "[Open] <washing_machine> (1)", "[PutIn] <clothes_shirt> (1) <washing_machine> (1)",
        "[Close] <washing_machine> (1)", "[SwitchOn] <washing_machine> (1)",
    )  # fmt: skip
    assert kept(program, homes) == [
        "[PutIn] <clothes_shirt> (1) <washing_machine> (1)",
        "[SwitchOn] <washing_machine> (1)",
    ]


def test_what_ran_while_something_was_done_is_the_activity_though_it_is_off_at_the_end(homes):
    steps = [
        "[Walk] <computer> (1)",
        "[SwitchOn] <computer> (1)",
        "[Type] <keyboard> (1)",
        "[SwitchOff] <computer> (1)",
    ]
    between = program_of("Work", "", "[Walk] <keyboard> (1)", *steps)
    nothing = program_of("Work", "", *steps[:2], steps[3])
    assert kept(between, homes) == ["[SwitchOn] <computer> (1)", "[Type] <keyboard> (1)"]
    assert kept(nothing, homes) == []


def test_looking_stays_only_where_the_description_asks_for_it(homes):
    steps = ["[Walk] <television> (1)", "[TurnTo] <television> (1)", "[LookAt] <television> (1)"]
    assert kept(program_of("TV", "I look at the television.", *steps), homes) == ["[LookAt] <television> (1)"]
    assert kept(program_of("TV", "", *steps), homes) == []


def test_a_sketch_goes_by_the_rules_that_suit_its_program(homes):
    steps = ["[Walk] <television> (1)", "[TurnTo] <television> (1)", "[Watch] <television> (1)"]
    program = program_of("TV", "", *steps, "[SwitchOn] <television> (1)")
    assert kept(program, homes) == ["[Watch] <television> (1)", "[SwitchOn] <television> (1)"]


def test_words_ask_by_verb_and_by_any_name_of_the_object():
    program = program_of("", "I turn on the tv, and sit down.", "[SwitchOn] <television> (1)", "[Sit] <couch> (1)")
    assert asked(program, default()) == (True, False)


def test_children_inherit_their_parents_steps_and_nothing_that_was_inserted():
    assert inherited((False, True, True), (0, -1, 2, 1)) == (False, False, True, True)


@pytest.mark.slow
def test_people_agree_more_than_with_the_baselines(real_data):
    from hearth.analysis.programs_in_homes import scripts
    from hearth.analysis.sketch_evaluation import annotated, evaluate_sketches
    from hearth.storage.rejects import Reject

    known = default()
    found = scripts([str(real_data / "activityprograms-sample.zip")], known)
    programs = [one for one in found if not isinstance(one, Reject)]
    places = [Home.from_graph(library.load_graph(name, default()), name, known) for name in library.names()[:3]]
    sketches = annotated(real_data / "sketch_annotation.json", "s", programs, known)
    summary = evaluate_sketches(sketches, places, known).summary()
    assert summary["programs"] >= 111
    assert summary["inferred"]["f1"] > max(0.86, summary["keeping_what_people_usually_keep"]["f1"])


@pytest.mark.parametrize(
    ("steps", "expected"),
    [
        (("[Grab] <knife> (1)", "[Cut] <bread> (1)"), True),
        (("[Grab] <knife> (1)", "[Grab] <cup> (1)", "[Cut] <bread> (1)"), False),
        (("[Grab] <knife> (1)", "[Walk] <bread> (1)", "[Cut] <bread> (1)"), True),
        (("[Cut] <bread> (1)", "[Grab] <knife> (1)"), False),
        (("[Grab] <knife> (1)", "[Cut] <knife> (1)"), False),
    ],
)
def test_a_tool_is_what_was_taken_last_before_it_is_of_use(steps, expected):
    program = program_of("Cut", "", *steps)
    assert _is_tool(program, ("knife", 1), default()) == expected


def test_a_thing_is_of_use_after_the_last_time_it_was_acted_on():
    program = program_of("", "", "[Open] <book> (1)", "[Read] <book> (1)", "[Open] <book> (1)", "[Walk] <book> (1)")
    ways = default().group("preparation")
    assert not _used_after(program, "Open", ("book", 1), ways)
    assert _used_after(program.with_steps(program.steps[:2]), "Open", ("book", 1), ways)
    assert _used_after(program, "Close", ("book", 1), ways)


@pytest.mark.parametrize("name", ["coffe_maker", "dishwasher"])
def test_by_set_3_switching_on_what_ends_by_itself_is_part_of_a_sketch(name):
    known = default().of_set(3)
    place = Home.from_graph(library.load_graph("maple", known), "maple", known)
    program = program_of("", "", f"[Walk] <{name}> (1)", f"[Close] <{name}> (1)", f"[SwitchOn] <{name}> (1)")
    assert sketch(program, [place], known)[-1]
