"""`hearth.parse_steps` reads a text as `check` reads its file: chats, requests without answers, several plans."""

from __future__ import annotations

import json

import pytest

import hearth
from hearth.commands import inputs
from hearth.kb.loading.load import default

TV = ["1. Walk to the television", "2. Switch on the television"]
LAMP = ["1. Walk to the lamp", "2. Switch on the lamp"]
NO = "No, not the television, the lamp!"
SPEAKERS = {
    "on its line": ("User: ", "Assistant: "),
    "above": ("User: ", "Assistant:\n"),
    "others": ("Human: ", "AI: "),
    "bold": ("**User:** ", "**Assistant:** "),
}


def said(speakers, *turns):
    user, assistant = SPEAKERS[speakers]
    return "".join(f"{(user, assistant)[n % 2]}{turn}\n" for n, turn in enumerate(turns))


def steps_of(found):
    return [(step.action, *(ref.name for ref in step.objects)) for step in found.program.steps]


def from_file(tmp_path, text, name="chat.txt"):
    (tmp_path / name).write_text(text)
    return list(inputs.read_programs(tmp_path / name, default(), name))


@pytest.mark.parametrize("speakers", SPEAKERS)
def test_the_last_answer_of_a_chat_counts(tmp_path, speakers):
    text = said(speakers, "Make a plan to watch TV.", "\n".join(TV), NO, "\n".join(LAMP))
    found, (checked,) = hearth.parse_steps(text), from_file(tmp_path, text)
    assert steps_of(found) == steps_of(checked) == [("Walk", "lamp"), ("SwitchOn", "lamp")]
    assert found.program.lines == checked.program.lines
    assert (found.program.title, found.warnings) == (checked.program.title, ())


@pytest.mark.parametrize("speakers", SPEAKERS)
@pytest.mark.parametrize("last", ["Thanks!", "ok thanks"])
def test_no_step_is_lost_above_thanks(tmp_path, speakers, last):
    text = said(speakers, "Make a plan to watch TV.", "\n".join(TV), last)
    found, (checked,) = hearth.parse_steps(text), from_file(tmp_path, text)
    assert steps_of(found) == steps_of(checked) == [("Walk", "television"), ("SwitchOn", "television")]


@pytest.mark.parametrize("speakers", SPEAKERS)
def test_a_correction_without_an_answer_warns(tmp_path, speakers):
    text = said(speakers, "Make a plan to watch TV.", "\n".join(TV), NO)
    found, (checked,) = hearth.parse_steps(text), from_file(tmp_path, text)
    line = text.split("\n").index(SPEAKERS[speakers][0] + NO) + 1
    for each in (found, checked):
        assert steps_of(each) == [("Walk", "television"), ("SwitchOn", "television")]
        assert [(one.line, "has no answer" in one.message) for one in each.warnings] == [(line, True)]


def test_a_correction_without_an_answer_warns_in_json_too(tmp_path):
    roles = ("user", "assistant", "user")
    turns = zip(roles, ("Make a plan to watch TV.", "\n".join(TV), NO), strict=True)
    chat = {"messages": [{"role": role, "content": content} for role, content in turns]}
    (checked,) = from_file(tmp_path, json.dumps(chat), "chat.jsonl")
    assert ["has no answer" in one.message for one in checked.warnings] == [True]


def test_tasks_of_a_chat_whose_answers_begin_with_a_number_are_programs(tmp_path):
    text = said("on its line", "Make a plan to watch TV.", "\n".join(TV), "Now a plan for the lamp.", "\n".join(LAMP))
    assert [len(each.program.steps) for each in from_file(tmp_path, text)] == [2, 2]
    found = hearth.parse_steps(text)
    assert steps_of(found) == [("Walk", "television"), ("SwitchOn", "television")]
    assert [(one.line, "another chat" in one.message) for one in found.warnings] == [(4, True)]


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("TV\n" + "\n".join(TV) + "\n\nLamp\n" + "\n".join(LAMP), 5),
        ("TV\n" + "\n".join(TV) + "\n" + "\n".join(LAMP), 4),
        ("# Evening\n\n## TV\n- Walk to the television\n\n## Lamp\n1. Walk to the lamp\n", 6),
    ],
)
def test_a_text_of_several_plans_says_so(tmp_path, text, line):
    assert len(from_file(tmp_path, text)) == 2
    assert [(one.line, "another plan" in one.message) for one in hearth.parse_steps(text).warnings] == [(line, True)]


def test_one_plan_says_nothing_of_others():
    for text in ("TV\n" + "\n".join(TV), "# TV\n\n- Walk to the bed\n- Lie on the bed\n", "Walk to the bed"):
        assert hearth.parse_steps(text).warnings == ()
