"""Sentences as people and language models say household acts: what each asks for, and what asks for nothing here."""

import pytest

from hearth.kb.language.numbered_steps import parse_steps
from hearth.kb.language.reading_modes import Fuzzy
from hearth.schemas.syntax import print_lines

EXACT = {
    # British words, and words of one class.
    "turn on the telly": "[SwitchOn] <television> (1)",
    "nip to the loo": "[Walk] <toilet> (1)",
    "put the pyjamas in the tumble dryer": "[PutIn] <pajamas> (1) <dryer> (1)",
    "put the laundry in the washing machine": "[PutIn] <clothes_pile> (1) <washing_machine> (1)",
    "grab a shoe": "[Grab] <shoes> (1)",
    # What has a switch is not worn.
    "pop the kettle on": "[SwitchOn] <kettle> (1)",
    "put on the radio": "[SwitchOn] <radio> (1)",
    "put the light on": "[SwitchOn] <light> (1)",
    "lights off": "[SwitchOff] <light> (1)",
    "shut down the computer": "[SwitchOff] <computer> (1)",
    "turn the TV back on": "[SwitchOn] <television> (1)",
    "put your coat on": "[PutOn] <clothes_jacket> (1)",
    "kick off your shoes": "[PutOff] <shoes> (1)",
    # Particles and ways.
    "get to the kitchen": "[Walk] <kitchen> (1)",
    "go through to the bathroom": "[Walk] <bathroom> (1)",
    "approach the table": "[Walk] <table> (1)",
    "move towards the fridge": "[Walktowards] <fridge> (1)",
    "get off the couch": "[StandUp]",
    "get up off the sofa": "[StandUp]",
    "get out of the chair": "[StandUp]",
    "get out of bed": "[Leave] <bed> (1)",
    "pull out a chair": "[Pull] <chair> (1)",
    "pull open the curtains": "[Open] <curtain> (1)",
    "plonk yourself down on the sofa": "[Sit] <sofa> (1)",
    "retrieve the milk from the fridge": "[Grab] <milk> (1)",
    "fetch me a beer": "[Grab] <beer> (1)",
    "fill the kettle from the tap": "[Pour] <water> (1) <kettle> (1)",
    "drink a glass of milk": "[Drink] <milk> (1)",
    "chop up the onion": "[Cut] <food_onion> (1)",
    "insert the book into the lamp": "[PutIn] <book> (1) <lamp> (1)",
    "take a seat at the desk": "[Sit] <desk> (1)",
    # People, parts and amounts.
    "grab mum's phone": "[Grab] <phone> (1)",
    "grab the chef's knife": "[Grab] <chef_knife> (1)",
    "open the door of the fridge": "[Open] <fridge> (1)",
    "drink the rest of the juice": "[Drink] <juice> (1)",
    "walk to the kids' bedroom": "[Walk] <kids_bedroom> (1)",
    # Openings.
    "don't forget to close the door": "[Close] <door> (1)",
    "would you be so kind as to close the door?": "[Close] <door> (1)",
    "erm, grab the mug": "[Grab] <mug> (1)",
    "start washing the plate": "[Wash] <plate> (1)",
    "go and get the mug": "[Grab] <mug> (1)",
}


SHORTENED = {
    "use the knife to slice the bread": ("[Cut] <food_bread> (1)", "use the knife to"),
    "turn on the TV with the remote control": ("[SwitchOn] <television> (1)", "with the remote control"),
    "using the sponge, wash the plate": ("[Wash] <plate> (1)", "using the sponge"),
    "grab the mug with your left hand": ("[Grab] <mug> (1)", "with your left hand"),
    "wash your hands with soap and water": ("[Wash] <hands_both> (1)", "with soap and water"),
    "wash each of the plates": ("[Wash] <plate> (1)", "all"),
    "while the water boils, grab a cup": ("[Grab] <cup> (1)", "while the water boils"),
    "once you are in the kitchen, open the fridge": ("[Open] <fridge> (1)", "once you are in the kitchen"),
    "without touching the stove, walk to the table": ("[Walk] <table> (1)", "without touching the stove"),
    "in the kitchen, open the fridge": ("[Open] <fridge> (1)", "in the kitchen"),
    "stir the soup until it thickens": ("[Stir] <soup> (1)", "until it thickens"),
    "turn off the light before leaving": ("[SwitchOff] <light> (1)", "before leaving"),
    "open the window because it is hot": ("[Open] <window> (1)", "because it is hot"),
    "watch a movie on the TV": ("[Watch] <television> (1)", "a movie"),
    "write your name on the paper": ("[Write] <paper> (1)", "your name"),
    "pull the blinds down": ("[Pull] <blinds> (1)", "down"),
    "cut the bread into slices": ("[Cut] <food_bread> (1)", "into slices"),
    "wipe the table clean": ("[Wipe] <table> (1)", "clean"),
    "look at the clock on the wall": ("[LookAt] <wall_clock> (1)", "on the wall"),
    "pick up the mug that is on the table": ("[Grab] <mug> (1)", "that is on the table"),
    "call your mom": ("[Call]", "your mom"),
    "turn on the ligth so you can see": ("[SwitchOn] <light> (1)", "so you can see"),
}


REFUSED = [
    # The act is another, is forbidden, or hangs on a condition.
    "Don't open the fridge", "Keep the door open until noon", "Leave the pan on the stove until noon",
    "If the light is off, turn on the light", "Open the window unless it is cold", "Replace the light bulb",
    "Change the battery",
    "Sit in front of the TV", "Turn down the radio", "Hang up the coat", "Take the lid off the pot",
    # Two things may be meant.
    "Turn on the TV with the stereo", "Grab either the milk or the juice", "Bring the cup to the child",
    # A dog's bed is not a person's.
    "Wash the dog's bed", "Grab the other cup",
]  # fmt: skip


def read(knowledge, *lines, fuzzy=Fuzzy.TYPOS):
    text = "Task: T\n" + "".join(f"Step {number}: {line}\n" for number, line in enumerate(lines, 1))
    found = parse_steps(text, 0, "a.txt", knowledge, fuzzy)
    return list(print_lines(found.program)), found


@pytest.mark.parametrize(("sentence", "step"), EXACT.items())
def test_a_usual_wording_reads_exactly(knowledge, sentence, step):
    lines, found = read(knowledge, sentence)
    assert lines == [step] and not found.faults and not found.warnings


@pytest.mark.parametrize(("sentence", "step", "left_out"), [(said, *meant) for said, meant in SHORTENED.items()])
def test_what_is_left_out_of_a_sentence_is_counted(knowledge, sentence, step, left_out):
    lines, found = read(knowledge, sentence)
    assert lines == [step] and not found.faults
    (warning,) = found.warnings
    assert warning.code == "FUZZY_MATCH" and warning.message.endswith(f"left out: {left_out}")
    assert read(knowledge, sentence, fuzzy=Fuzzy.OFF)[1].faults


@pytest.mark.parametrize("sentence", REFUSED)
def test_what_is_not_sure_is_refused(knowledge, sentence):
    lines, found = read(knowledge, sentence)
    assert not lines and found.faults


TALKS = {
    "Put the socks in the washing machine / Put the shirt in there too":
        "[PutIn] <clothes_shirt> (1) <washing_machine> (1)",
    "Put the cup on the table / Put the plate there": "[PutBack] <plate> (1) <table> (1)",
    "Open the fridge / Grab the milk / Put it back in": "[PutIn] <milk> (1) <fridge> (1)",
    "Grab the soap / Put that in the sink as well": "[PutIn] <soap> (1) <sink> (1)",
    "Walk to the kitchen / Find the honey": "[Find] <honey> (1)",
    "Walk to the kitchen / Grab the milk, honey": "[Grab] <milk> (1)",
    "Grab the soap / Grab the shoes / Put them on": "[PutOn] <shoes> (1)",
    "Grab a cup / Grab another cup": "[Grab] <cup> (2)",
    "Grab two cups / Put the first cup on the table / Put the other cup on the table":
        "[PutBack] <cup> (2) <table> (1)",
    "Grab two cups / Pour tea into the second cup": "[Pour] <tea> (1) <cup> (2)",
    "Open the fridge / When the milk is cold, drink it": "[Drink] <milk> (1)",
}  # fmt: skip


@pytest.mark.parametrize(("lines", "step"), TALKS.items())
def test_things_said_before_are_spoken_of(knowledge, lines, step):
    steps, found = read(knowledge, *lines.split(" / "))
    assert steps[-1] == step and not found.faults


@pytest.mark.parametrize(
    ("lines", "things"),
    [
        (["Grab two forks", "Put them on the table"], ["<fork> (1)", "<fork> (2)"]),
        (["Grab the cup and the plate", "Put them on the table"], ["<cup> (1)", "<plate> (1)"]),
        (
            ["Grab the cup", "Grab the plate", "Walk to the table", "Put those on the table"],
            ["<cup> (1)", "<plate> (1)"],
        ),
        (["Grab the soap", "Grab the shoes", "Put them on the table"], ["<shoes> (1)"]),
    ],
)
def test_them_are_the_things_of_the_last_act(knowledge, lines, things):
    steps, found = read(knowledge, *lines)
    assert steps[-len(things) :] == [f"[PutBack] {thing} <table> (1)" for thing in things] and not found.faults
    assert not steps[-len(things) - 1].startswith("[PutBack]")


@pytest.mark.parametrize(
    ("line", "steps"),
    [
        ("eat the toast + drink the coffee", ["[Eat] <food_bread> (1)", "[Drink] <coffee> (1)"]),
        ("get a needle & find the thread", ["[Grab] <needle> (1)", "[Find] <thread> (1)"]),
        ("grab a couple of eggs", ["[Grab] <food_egg> (1)", "[Grab] <food_egg> (2)"]),
    ],
)
def test_one_line_asks_for_several_steps(knowledge, line, steps):
    assert read(knowledge, line)[0] == steps


@pytest.mark.parametrize(
    ("sentence", "step"),
    [
        ("grabing the novell", "[Grab] <novel> (1)"),
        ("wlak to the dgo", "[Walk] <dog> (1)"),
        ("moveed the ladder", "[Move] <ladder> (1)"),
        ("pick up teh cup", "[Grab] <cup> (1)"),
        ("soak a shirt in the waater", "[Soak] <clothes_shirt> (1) <water> (1)"),
    ],
)
def test_typos_of_forms_and_of_short_words_are_corrected(knowledge, sentence, step):
    lines, found = read(knowledge, sentence)
    assert lines == [step] and [each.code for each in found.warnings] == ["FUZZY_MATCH"]
