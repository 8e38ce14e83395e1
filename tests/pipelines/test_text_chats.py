"""Chats as plain text: an answer that a request corrects is left out, and every step stands on its line of the file."""

import json

import pytest

from hearth.commands.inputs import read_programs
from hearth.schemas.syntax import print_step

FIRST = ("1. Walk to the kitchen", "2. Grab the cup")
LAST = ("1. Walk to the kitchen", "2. Grab the mug")
NAMES = {
    "plain": ("User: ", "Assistant:\n"),
    "on its line": ("Human: ", "AI: "),
    "bold": ("**User:** ", "**Assistant:**\n\n"),
    "letters": ("Q: ", "A: "),
    "numbered": ("Question 1: ", "Answer 1:\n"),
    "headings": ("### Human\n", "### Assistant\n"),
    "copied": ("You said:\n", "ChatGPT said:\n"),
    "tokens": ("<|im_start|>user\n", "<|im_start|>assistant\n"),
    "quoted": ("> User: ", "Model: Sure!\n"),
}


def found(write, knowledge, text, name="a.txt"):
    programs = [each.program for each in read_programs(write(name, text), knowledge, name)]
    return [(program.title, program.description, list(map(print_step, program.steps))) for program in programs]


def chat(names, *turns):
    return "\n\n".join(names[at % 2] + turn for at, turn in enumerate(turns)) + "\n"


def as_json(*turns):
    roles = ("user", "assistant")
    return json.dumps({"messages": [{"role": roles[at % 2], "content": turn} for at, turn in enumerate(turns)]})


@pytest.mark.parametrize("names", NAMES.values(), ids=NAMES)
@pytest.mark.parametrize(
    "correction", ["No, that's wrong. Use the mug.", "Ok, but use the mug", "You forgot the mug", "Wrong!"]
)
def test_the_last_answer_of_a_text_counts_as_in_json(write, knowledge, names, correction):
    turns = ("Make tea", "\n".join(FIRST), correction, "\n".join(LAST))
    expected = [("Make tea", correction, ["[Walk] <kitchen> (1)", "[Grab] <mug> (1)"])]
    assert found(write, knowledge, as_json(*turns), "a.json") == expected
    assert found(write, knowledge, chat(names, *turns)) == expected


@pytest.mark.parametrize("names", [NAMES["plain"], NAMES["letters"], NAMES["bold"]])
def test_a_chat_of_several_tasks_has_a_program_for_each(write, knowledge, names):
    turns = ("Make tea", "\n".join(FIRST), "Drink water", "\n".join(FIRST), "No, use the mug", "\n".join(LAST))
    assert [(title, steps[-1]) for title, _, steps in found(write, knowledge, chat(names, *turns))] == [
        ("Make tea", "[Grab] <cup> (1)"),
        ("Drink water", "[Grab] <mug> (1)"),
    ]


@pytest.mark.parametrize("thanks", ["Thanks!", "Great, thank you", "Perfect."])
def test_an_answer_to_thanks_is_no_plan(write, knowledge, thanks):
    turns = ("Make tea", "\n".join(FIRST), "No, the mug", "\n".join(LAST), thanks, "You're welcome!")
    expected = [("Make tea", "No, the mug", ["[Walk] <kitchen> (1)", "[Grab] <mug> (1)"])]
    assert found(write, knowledge, as_json(*turns), "a.json") == expected
    assert found(write, knowledge, chat(NAMES["plain"], *turns)) == expected


def test_every_line_of_an_answer_may_begin_with_its_speaker(write, knowledge):
    lines = ["Human: Get a cup", "Robot: 1. find cup", "Robot: 2. grab cup", "Human: No, the mug", "Robot: 1. find mug"]
    file = write("a.txt", "\n".join([*lines, "Robot: 2. grab zorgle", "Robot: 3. grab mug"]))
    (given,) = read_programs(file, knowledge, "a.txt")
    assert (given.program.title, given.program.lines) == ("Get a cup", (5, 7))
    assert [(fault.line, fault.column, fault.found) for fault in given.faults] == [(6, 11, "grab zorgle")]


@pytest.mark.parametrize("names", NAMES.values(), ids=NAMES)
def test_steps_and_faults_of_an_answer_have_their_places_in_the_file(write, knowledge, names):
    text = chat(names, "Make tea", "\n".join(FIRST), "No, the mug", "1. Walk to the kitchen\n2. Grab the zorgle")
    (given,) = read_programs(write("a.txt", text), knowledge, "a.txt")
    lines = text.split("\n")
    assert [lines[line - 1].endswith("1. Walk to the kitchen") for line in given.program.lines] == [True]
    (fault,) = given.faults
    assert lines[fault.line - 1][fault.column - 1 :] == "Grab the zorgle"


@pytest.mark.parametrize("second", ["Drink water", "Thanks! And now drink water", "Ok, next"])
def test_a_chat_without_a_correction_loses_no_answer(write, knowledge, second):
    turns = ("Make tea", "\n".join(FIRST), second, "\n".join(LAST))
    read = found(write, knowledge, chat(NAMES["plain"], *turns))
    assert [steps[-1] for _, _, steps in read] == ["[Grab] <cup> (1)", "[Grab] <mug> (1)"]


@pytest.mark.parametrize("names", [NAMES["on its line"], NAMES["letters"], ("Human: ", "Robot: "), ("Anna: ", "Bot: ")])
@pytest.mark.parametrize("steps", [FIRST, (*FIRST, "3. Close the fridge")])
def test_the_list_of_an_answer_goes_on_below_its_speaker(write, knowledge, names, steps):
    ((_, _, found_steps),) = found(write, knowledge, names[0] + "Make tea\n" + names[1] + "\n".join(steps) + "\n")
    expected = ["[Walk] <kitchen> (1)", "[Grab] <cup> (1)", "[Close] <fridge> (1)"]
    assert found_steps == expected[: len(steps)]
