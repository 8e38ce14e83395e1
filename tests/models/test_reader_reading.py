"""The reader: the acts that a text asks for, in order, about things of a home."""

import pytest

from hearth.grounding.environments.default_state import prepared
from hearth.homes.library import load_graph
from hearth.kb.action_sets import LATEST
from hearth.kb.loading.load import default
from hearth.models.reading.instruction_reading import read_text
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

KNOWN = default().of_set(LATEST)


@pytest.fixture(scope="module")
def maple():
    return World.start(prepared(Home.from_graph(load_graph("maple", KNOWN), "maple", KNOWN)).home)


def acts(text, world):
    reading = read_text(text, KNOWN, world)
    assert not reading.unread, reading.unread
    return [" ".join((act.action, *(ref.name for ref in act.objects))) for act in reading.acts if act.action != "Wait"]


READINGS = {
    "Turn on the TV and sit down on the couch": ["SwitchOn television", "Sit couch"],
    "Could you please switch the computer off?": ["SwitchOff computer"],
    "The TV should be off.": ["SwitchOff television"],
    "TV off, please.": ["SwitchOff television"],
    "Would you mind closing the fridge?": ["Close fridge"],
    "The fridge is open, shut it.": ["Close fridge"],
    "Put the fork on the table and the knife in the sink.": ["PutBack fork table", "PutIn knife sink"],
    "Take the milk out of the fridge, pour it into a glass and drink it.": [
        "Grab milk",
        "Pour milk glass",
        "Drink milk",
    ],
    "Store the juice in the fridge and shut the door": ["PutIn juice fridge", "Close fridge"],
    "Put one pillow on the couch and another on the bed": ["PutBack pillow couch", "PutBack pillow bed"],
    "Wash two plates and put them in the cupboard": ["Wash plate"] * 2 + ["PutIn plate cupboard"] * 2,
    "Before you sit on the couch, switch the TV on": ["SwitchOn television", "Sit couch"],
    "Sit on the couch after you have switched on the TV": ["SwitchOn television", "Sit couch"],
    "Sit down, but close the fridge first": ["Close fridge", "Sit couch"],
    "Don't go to bed until you have closed the fridge": ["Close fridge", "Lie bed", "Sleep"],
    "Heat up the milk in the microwave": ["PutIn milk microwave", "Close microwave", "SwitchOn microwave"],
    "Give the mirror a wipe": ["Wipe mirror"],
    "The plate needs rinsing": ["Rinse plate"],
    "The plate should be washed and put in the sink": ["Wash plate", "PutIn plate sink"],
    "Open and close the fridge": ["Open fridge", "Close fridge"],
    "Slice the bread": ["Grab knife", "Cut food_bread"],
    "Movie night: curtains closed, TV on": ["Close curtain"] * 8 + ["SwitchOn television"],
    "It is dark in here, switch on the floor lamp": ["SwitchOn floor_lamp"],
    "Go to bed": ["Lie bed", "Sleep"],
    "Hit the hay": ["Lie bed", "Sleep"],
    "Trun off teh TV": ["SwitchOff television"],
    "Set the table for two": [
        f"PutBack {name} table" for name in ("plate", "fork", "knife", "glass") for _ in range(2)
    ],
}


@pytest.mark.parametrize(("text", "wanted"), READINGS.items())
def test_what_a_text_asks_for(text, wanted, maple):
    assert acts(text, maple) == wanted


REFUSED = [
    *("Fly to the moon", "Mow the lawn", "asdf qwer zxcv", "Schalte bitte den Fernseher ein", "Eat the sofa"),
    *("Put the fridge in the cup", "Put seventy plates on the table", "Turn the lamp into gold"),
    *("You stupid piece of junk", "What is the capital of France?", "Turn the cup on", "Read the spoon"),
    *("Teleport the cup to the bedroom", "", "   ", "!!!", "the the the", "w" * 9000, "please " * 2000),
]


@pytest.mark.parametrize("text", REFUSED, ids=lambda text: text[:20])
def test_what_no_home_can_do_asks_for_nothing(text, maple):
    assert not read_text(text, KNOWN, maple).acts


def test_a_part_that_is_not_understood_is_named(maple):
    reading = read_text("Turn on the TV and launch the rocket", KNOWN, maple)
    assert [act.action for act in reading.acts] == ["SwitchOn"] and reading.unread == ("launch the rocket",)


def test_what_the_home_lacks_is_named(maple):
    assert read_text("Bring me the hairdryer", KNOWN, maple).missing[:1] == ("the hairdryer",)


def test_what_is_not_to_be_done_is_not_done(maple):
    reading = read_text("Grab the milk, but don't close the fridge", KNOWN, maple)
    assert [act.action for act in reading.acts] == ["Grab"]
    assert [(act.action, act.objects[0].name) for act in reading.forbidden] == [("Close", "fridge")]


def test_a_place_chooses_among_things_of_a_class(maple):
    (act,) = read_text("Open the window in the bedroom", KNOWN, maple).acts
    home = maple.home
    room = home.classes[home.direct_room[home.index[act.objects[0].node]]]
    assert room == "bedroom"


def test_all_but_some(maple):
    every = read_text("Turn off all the lights", KNOWN, maple).acts
    some = read_text("Turn off all the lights except the one in the kitchen", KNOWN, maple).acts
    kitchen = read_text("Turn off all the lights in the kitchen", KNOWN, maple).acts
    nodes = [{act.objects[0].node for act in each} for each in (every, some, kitchen)]
    assert nodes[1] == nodes[0] - nodes[2] and nodes[2] < nodes[0]


def test_without_a_home_the_acts_name_classes():
    reading = read_text("Put two plates in the sink", KNOWN)
    assert [[ref.node for ref in act.objects] for act in reading.acts] == [[None, None]] * 2
    assert [act.objects[0].instance for act in reading.acts] == [1, 2]


def test_a_first_sentence_that_sums_up_the_others_is_not_done_twice(maple):
    text = "I make toast. I take the bread. I put it in the toaster and switch the toaster on."
    assert acts(text, maple).count("SwitchOn toaster") == 1
