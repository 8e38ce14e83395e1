"""Lines are read by the lines before them: counts, refused lines, nouns said again, things that stay, carrying."""

import pytest

from hearth.kb.language.numbered_steps import parse_steps
from hearth.schemas.syntax import print_step


def read(knowledge, plan):
    """Return the steps and the faults of the lines of a plan, with the numbers of their lines, and the warnings."""
    lines = plan.split(" / ")
    text = "Task: T\n" + "".join(f"Step {number}: {line}\n" for number, line in enumerate(lines, 1))
    found = parse_steps(text, 0, "a.txt", knowledge)
    steps = [
        f"{line - 1} {print_step(step)}" for line, step in zip(found.program.lines, found.program.steps, strict=True)
    ]
    return steps, {fault.line - 1: fault for fault in found.faults}, [each.message for each in found.warnings]


def last_of(knowledge, plan):
    """Return the steps of the last line of a plan in which every line is understood."""
    steps, faults, _ = read(knowledge, plan)
    number = str(len(plan.split(" / ")))
    assert faults == {}
    return [step.partition(" ")[2] for step in steps if step.partition(" ")[0] == number]


TWO_ON_TABLE = ["[PutBack] <plate> (1) <table> (1)", "[PutBack] <plate> (2) <table> (1)"]


@pytest.mark.parametrize(
    "line",
    [
        "Put the plates on the table.", "Put both plates on the table", "Put both on the table",
        "Put them on the table", "Put both of them on the table", "Put all of them on the table",
        "Put them both on the table",
        "Put each plate on the table", "Put all the plates on the table", "Put these plates on the table",
        "Put the two of them on the table", "Walk to the table / Put them on it",
    ],
)  # fmt: skip
def test_a_plural_is_all_of_the_counted_things(knowledge, line):
    assert last_of(knowledge, f"Take two plates. / {line}") == TWO_ON_TABLE


def test_counted_things_are_remembered_for_the_whole_program(knowledge):
    between = "Walk to sink / Switch on faucet / Grab sponge / Walk to cat / Touch cat / Walk to dog / Touch dog"
    assert last_of(knowledge, f"Take six plates / {between} / Wash the plates") == [
        f"[Wash] <plate> ({number})" for number in range(1, 7)
    ]


@pytest.mark.parametrize(
    ("plan", "steps"),
    [
        ("Grab two glasses / Pour juice into the glasses",
         ["[Pour] <juice> (1) <glass> (1)", "[Pour] <juice> (1) <glass> (2)"]),
        ("Take two mugs / Fill both mugs with coffee",
         ["[Pour] <coffee> (1) <mug> (1)", "[Pour] <coffee> (1) <mug> (2)"]),
        ("Take two mugs / Fill them with coffee",
         ["[Pour] <coffee> (1) <mug> (1)", "[Pour] <coffee> (1) <mug> (2)"]),
        ("Take two plates and wash the plates",
         ["[Grab] <plate> (1)", "[Grab] <plate> (2)", "[Wash] <plate> (1)", "[Wash] <plate> (2)"]),
        ("Take three cups / Wash all three", [f"[Wash] <cup> ({number})" for number in (1, 2, 3)]),
        ("Take two plates / Wash the plate", ["[Wash] <plate> (1)"]),
        ("Take two plates / Wash one of the plates", ["[Wash] <plate> (1)"]),
        ("Take two plates / Wash the second plate", ["[Wash] <plate> (2)"]),
        ("Take the plates / Wash the plates", ["[Wash] <plate> (1)"]),
    ],
)  # fmt: skip
def test_other_things_that_are_counted(knowledge, plan, steps):
    assert last_of(knowledge, plan) == steps


@pytest.mark.parametrize(
    "plan",
    [
        "Take a plate / Put both on the table", "Take three cups / Put both on the table",
        "Take three cups / Wash some of the cups", "Take two plates / Take two forks / Put the forks on the plates",
    ],
)  # fmt: skip
def test_a_number_that_does_not_fit_is_refused(knowledge, plan):
    _, faults, _ = read(knowledge, plan)
    assert [(line, fault.code) for line, fault in faults.items()] == [(len(plan.split(" / ")), "AMBIGUOUS")]


@pytest.mark.parametrize(
    ("plan", "pronoun"),
    [
        ("Grab the milk / Fondle the sprocket / Drink it", "it"),
        ("Grab the milk / Polish the rocket on the table / Put it on the chair", "it"),
        ("Grab two cups / Zap the gizmo / Put them on the table", "them"),
        ("Put the cup on the table / Zap the gizmo / Leave it there", "it"),
        ("Put the milk in the fridge / Zap the gizmo / Put the juice there", "there"),
        ("Grab the milk / [Fly] <sprocket> (1) / Drink it", "it"),
    ],
)
def test_a_pronoun_never_means_what_was_said_before_a_refused_line(knowledge, plan, pronoun):
    steps, faults, _ = read(knowledge, plan)
    assert not any(step.startswith("3 ") for step in steps) and sorted(faults) == [2, 3]
    refused = plan.split(" / ")[1]
    assert faults[3].code == "AMBIGUOUS"
    assert faults[3].message == f"`{pronoun}` may mean a thing of `{refused}`, which could not be read"


@pytest.mark.parametrize(
    ("plan", "step"),
    [
        ("Grab the milk / Preheat the oven to 200 / Open it", "3 [Open] <oven> (1)"),  # its one thing
        ("Grab the milk / Breathe deeply / Drink it", "3 [Drink] <milk> (1)"),  # no thing
        ("Find the coffee maker / Make sure it is warm / Switch it on", "3 [SwitchOn] <coffe_maker> (1)"),
        ("Zap the gizmo / Walk to the fridge / Open it", "3 [Open] <fridge> (1)"),  # said since
    ],
)
def test_a_refused_line_that_names_one_known_thing_or_none_hides_nothing(knowledge, plan, step):
    assert read(knowledge, plan)[0][-1] == step


def test_a_clause_that_is_refused_hides_what_the_line_said_before(knowledge):
    steps, faults, _ = read(knowledge, "Grab the milk and zap the gizmo, then drink it")
    assert steps == ["1 [Grab] <milk> (1)"] and list(faults) == [1]


@pytest.mark.parametrize(
    ("plan", "step"),
    [
        ("Grab the dog food / Pour the food into the bowl", "[Pour] <pet_food> (1) <bowl> (1)"),
        ("Grab the coffee mug / Rinse the mug", "[Rinse] <mug> (1)"),
        ("Walk to the dining table / Wipe the table", "[Wipe] <dining_table> (1)"),
        ("Walk to the washing machine / Open the machine", "[Open] <washing_machine> (1)"),
        ("Walk to the kitchen counter / Wipe the counter", "[Wipe] <kitchen_counter> (1)"),
        ("Take two wine glasses / Rinse the glasses", "[Rinse] <wine_glass> (1)"),
        ("Walk to the dining table / Find a table", "[Find] <table> (1)"),  # another one
        ("Walk to dining table / Wipe table", "[Wipe] <table> (1)"),  # names of classes
        ("Walk to the table / Walk to the dining table / Wipe the table", "[Wipe] <table> (1)"),  # said itself
        ("Grab the peanut butter / Grab the butter", "[Grab] <food_butter> (1)"),  # nothing is grabbed twice
    ],
)
def test_a_noun_that_ends_a_compound_is_the_compound(knowledge, plan, step):
    assert last_of(knowledge, plan)[0] == step


def test_a_noun_that_ends_two_compounds_is_refused(knowledge):
    _, faults, _ = read(knowledge, "Walk to the dining table / Walk to the coffee table / Wipe the table")
    assert faults[3].message == "`table` may mean `coffee table` or `dining table`"


@pytest.mark.parametrize(
    "plan",
    [
        "Put the cup on the table / Leave it there", "Put the milk in the fridge / Leave it in the fridge",
        "Put the milk in the fridge / Keep it there for an hour", "Put the cup on the table / Let it be",
        "Put the cup on the table / Leave the cup on the table", "Switch on the light / Leave it on",
        "Open the door / Leave the door open",
    ],
)  # fmt: skip
def test_what_stays_is_no_second_act(knowledge, plan):
    steps, faults, warnings = read(knowledge, plan)
    assert len(steps) == 1 and faults == {}
    assert warnings == ["nothing to do: the thing stays as the last step has left it"]


def test_a_clause_that_asks_for_nothing_is_left_out_and_counted(knowledge):
    steps, _, warnings = read(knowledge, "Put the cup on the table and leave it there, then walk to the kitchen")
    assert steps == ["1 [PutBack] <cup> (1) <table> (1)", "1 [Walk] <kitchen> (1)"]
    assert warnings == ["taken for `Put cup on table`; left out: leave it there"]


@pytest.mark.parametrize(
    ("plan", "step"),
    [
        ("Leave the cup on the table", "[PutBack] <cup> (1) <table> (1)"),
        ("Grab the cup / Walk to the table / Leave it there", "[PutBack] <cup> (1) <table> (1)"),
        (
            "Put the cup on the table / Walk to the sink / Grab the plate / Put it there",
            "[PutIn] <plate> (1) <sink> (1)",
        ),
        ("Leave the bathroom", "[Leave] <bathroom> (1)"),
    ],
)
def test_what_is_left_where_it_is_not_yet_is_put_there(knowledge, plan, step):
    assert last_of(knowledge, plan) == [step]


@pytest.mark.parametrize(
    ("plan", "steps"),
    [
        ("Grab the clothes / Carry them to the washing machine / Open it / Put the clothes in it",
         ["2 [Walk] <washing_machine> (1)", "3 [Open] <washing_machine> (1)",
          "4 [PutIn] <clothes_pile> (1) <washing_machine> (1)"]),
        ("Grab the milk / Bring the milk to the fridge / Open the fridge / Put it inside",
         ["2 [Walk] <fridge> (1)", "3 [Open] <fridge> (1)", "4 [PutIn] <milk> (1) <fridge> (1)"]),
        ("Take two plates / Carry them to the table / Put them there",
         ["1 [Grab] <plate> (2)", "2 [Walk] <table> (1)", "3 [PutBack] <plate> (1) <table> (1)",
          "3 [PutBack] <plate> (2) <table> (1)"]),
        ("Grab the cup / Put the clothes in the washing machine after opening it",
         ["2 [Open] <washing_machine> (1)", "2 [PutIn] <clothes_pile> (1) <washing_machine> (1)"]),
        ("Grab the milk / Once you have opened the fridge, put the milk in it",
         ["2 [Open] <fridge> (1)", "2 [PutIn] <milk> (1) <fridge> (1)"]),
        ("Open the fridge / After opening the fridge, take the milk out",
         ["1 [Open] <fridge> (1)", "2 [Grab] <milk> (1)"]),
        ("Grab the cup / Bring the book to the table", ["2 [PutBack] <book> (1) <table> (1)"]),
        ("Grab the clothes / Put the clothes in the washing machine",  # nothing is added
         ["1 [Grab] <clothes_pile> (1)", "2 [PutIn] <clothes_pile> (1) <washing_machine> (1)"]),
    ],
)  # fmt: skip
def test_steps_come_in_the_order_in_which_the_words_say_that_they_are_done(knowledge, plan, steps):
    found, faults, _ = read(knowledge, plan)
    assert found[-len(steps) :] == steps and faults == {}


@pytest.mark.parametrize(
    ("sentence", "step"),
    [
        *((f"{verb} into bed", "[Lie] <bed> (1)") for verb in ("Get", "Climb", "Hop", "Jump", "Crawl", "Get back")),
        ("Jump in bed", "[Lie] <bed> (1)"),
        *((f"{verb} the shower", "[Enter] <shower> (1)") for verb in ("Hop in", "Step into", "Jump into", "Get in")),
        *((f"{verb} out of the shower", "[Leave] <shower> (1)") for verb in ("Hop", "Climb", "Step", "Get")),
        ("Climb into the bathtub", "[Enter] <bathtub> (1)"),
        ("Climb out of bed", "[Leave] <bed> (1)"),
    ],
)
def test_beds_are_lain_on_and_showers_entered(knowledge, sentence, step):
    assert last_of(knowledge, sentence) == [step]
