"""Titles of chats: the task that was asked for, and not what was corrected since."""

import json

import pytest

from hearth.commands.inputs import read_programs

FIRST, LAST = "1. Walk to the kitchen\n2. Grab the cup", "1. Walk to the kitchen\n2. Grab the mug"


def titles(write, knowledge, *asked):
    turns = [{"role": "system", "content": "You plan."}]
    for number, each in enumerate(asked, 1):
        turns += [{"role": "user", "content": each}]
        turns += [{"role": "assistant", "content": LAST if number == len(asked) else FIRST}]
    found = list(read_programs(write("a.json", json.dumps({"messages": turns})), knowledge, "a.json"))
    return [(each.program.title, each.program.description, len(each.program.steps)) for each in found]


@pytest.mark.parametrize(
    "correction",
    [
        "no, use the other cup",
        "That is wrong.",
        "Actually, take the mug",
        "You forgot to grab the mug",
        "Please use the mug instead",
        "Can you change the cup?",
        "thanks",
        "Step 2 is wrong",
        "Make it shorter",
        "Use the mug",
    ],
)
def test_a_correction_is_no_title_and_is_kept(write, knowledge, correction):
    assert titles(write, knowledge, "Make tea", correction) == [("Make tea", correction, 2)]
    both = f"{correction}\nOk, go on."
    assert titles(write, knowledge, "Make tea", correction, "Ok, go on.") == [("Make tea", both, 2)]


@pytest.mark.parametrize("second", ["Drink coffee", "Now drink coffee", "Task: Drink coffee"])
def test_another_task_is_the_title(write, knowledge, second):
    ((title, description, _),) = titles(write, knowledge, "Make tea", second)
    assert (title, description) == (second.removeprefix("Task: "), "")


@pytest.mark.parametrize(
    "request_text",
    [
        "Write a plan for: Drink coffee",
        "Can you write me a plan for: Drink coffee?",
        "Please give me the steps to Drink coffee.",
        "I need a plan to Drink coffee",
        "Could you please generate a step-by-step guide to Drink coffee",
        'Create an action sequence for "Drink coffee"',
        "Plan for: Drink coffee",
    ],
)
def test_the_title_of_a_request_is_its_task(write, knowledge, request_text):
    assert titles(write, knowledge, request_text)[0][0] == "Drink coffee"


TURNS = [{"speaker": "Commander", "text": "Please drink"}, {"speaker": "assistant", "text": FIRST}]


@pytest.mark.parametrize(("title", "chat"), [("task", "dialogue"), ("name", "messages"), ("goal", "conversation")])
def test_the_task_beside_a_chat_is_its_title_and_its_keys_are_printed(write, knowledge, capsys, title, chat):
    file = write("a.json", json.dumps([{title: "Drink", chat: TURNS}]))
    (found,) = read_programs(file, knowledge, "a.json")
    assert (found.program.title, len(found.program.steps)) == ("Drink", 2)
    assert f"program={chat}, title={title}" in capsys.readouterr().err


def test_a_chat_without_a_plan_is_refused_with_its_own_keys(write, knowledge):
    file = write(
        "a.json", json.dumps([{"task": "Drink", "dialogue": [{"speaker": "user", "text": "Hello there"}] * 2}])
    )
    (reject,) = read_programs(file, knowledge, "a.json")
    assert "its keys are task, dialogue" in reject.diagnostics[0].message
