"""Two plans of plain lines in a text: each has its title; a plan with a blank line stays one; a doubt is said."""

import pytest
from test_forms_of_text import programs

TEA = "{}Walk to the kitchen\nGrab the cup\n"
TV = "{}Walk to the living room\nSwitch on the tv\n"
TEA_STEPS = ["[Walk] <kitchen> (1)", "[Grab] <cup> (1)"]
TV_STEPS = ["[Walk] <living_room> (1)", "[SwitchOn] <television> (1)"]


@pytest.mark.parametrize(
    ("tea", "tv"),
    [
        ("Make tea", "Watch TV"),
        ("make tea", "watch tv"),
        ("Make a cup of tea", "Watch television"),
        ("Making tea", "Watching TV"),
        ("Morning tea", "Evening TV"),
        ("A cup of tea", "The late news"),
        ("Make tea:", "Watch TV:"),
        ("# Make tea", "# Watch TV"),
        ("**Make tea**", "**Watch TV**"),
        ("Title: Make tea", "Title: Watch TV"),
    ],
)
def test_two_titles_above_plain_steps_are_two_plans(write, knowledge, tea, tv):
    text = TEA.format(f"{tea}\n") + "\n" + TV.format(f"{tv}\n")
    found = [(title.rstrip(":"), steps, faults) for title, steps, faults, _ in programs(write, knowledge, text)]
    titles = [each.removeprefix("# ").removeprefix("Title: ").strip("*:") for each in (tea, tv)]
    assert found == [(titles[0], TEA_STEPS, []), (titles[1], TV_STEPS, [])]


def test_a_step_of_the_second_plan_has_the_line_of_the_file(write, knowledge):
    text = TEA.format("Make tea\n") + "\n" + TV.format("Watch TV\n") + "Polish the moon\n"
    assert programs(write, knowledge, text)[1][2] == [("NOT_UNDERSTOOD", 8)]


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("Walk to the kitchen\nOpen the fridge\n\nGrab the milk\nClose the fridge\n", 4),
        ("Grab the cup\nWalk to the table\nPut the cup on the table\n\nGrab the plate\nWalk to the table\n", 5),
        ("Walk to the kitchen\n\nOpen the fridge\n\nGrab the milk\n\nClose the fridge\n", 4),
        ("Walk to the kitchen\n\nOpen the fridge\nGrab the milk\n", 3),
        ("Wake up\nWalk to the kitchen\nOpen the fridge\n\nStand up\nWalk to the sofa\nSit on the sofa\n", 6),
        ("Drinking milk\nWalk to the kitchen\nOpen the fridge\n\nClose the fridge\nDrink the milk\n", 4),
    ],
)
def test_a_plan_with_blank_lines_is_one_and_loses_no_step(write, knowledge, text, steps):
    ((_, found, faults, warnings),) = programs(write, knowledge, text)
    assert (len(found), faults, warnings) == (steps, [], [])


@pytest.mark.parametrize(
    ("text", "steps", "faults", "warnings"),
    [
        ("Grab cup\n" + TEA.format("") + "\nGrab book\n" + TV.format(""), 0, [("SYNTAX", 5)], []),
        (TEA.format("") + "\n" + TV.format("Watch TV\n"), 5, [], ["AMBIGUOUS"]),
        (TV.format("Watch TV\n"), 3, [], ["AMBIGUOUS"]),
    ],
)
def test_where_a_title_may_be_a_step_it_is_said(write, knowledge, text, steps, faults, warnings):
    ((_, found, *said),) = programs(write, knowledge, text)
    assert (len(found), *said) == (steps, faults, warnings)


def test_parts_of_a_plan_are_no_plans(write, knowledge):
    text = "Tidy up\n\nIn the kitchen:\nGrab the cup\n\nIn the bedroom:\nGrab the book\n"
    assert len(programs(write, knowledge, text)) == 1
