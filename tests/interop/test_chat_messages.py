"""Chats for fine-tuning: turns of the text environment, of an expert and of recorded episodes."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from hearth.challenges.episode_agents import Lineup
from hearth.challenges.household_definition import NAME, RULES
from hearth.challenges.result_files import is_results
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite, write
from hearth.commands.challenge_export import export as command
from hearth.envs.action_codes import played
from hearth.envs.text_homes import TextHome
from hearth.envs.text_protocol_settings import protocol
from hearth.envs.text_worlds import Play, begun, commanded, observed, seen
from hearth.interop import chat_messages
from hearth.interop.chat_messages import TWO, UNSEEN, messages
from hearth.interop.episode_export import export, export_messages
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


@pytest.fixture(scope="module")
def some():
    return suite(NAME, "test_unseen", limit=3)


@pytest.fixture(scope="module")
def results(some, tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    mains = ("human_like", "random", "oracle")
    return {main: run(some, Lineup(main), 1, folder / f"{main}.jsonl", default) for main in mains}


def chats(source, folder, limit=None):
    folder.mkdir()
    done = messages(source, folder, default(), limit)
    return [json.loads(line) for line in (folder / "messages.jsonl").read_text().splitlines()], done


def check_form(chat):
    first, *turns = chat["messages"]
    assert first == {"role": "system", "content": protocol().instructions}
    assert [turn["role"] for turn in turns] == ["user", "assistant"] * (len(turns) // 2) and turns
    assert chat["fingerprint"] == protocol().fingerprint and chat["protocol"] == "hearth-text/1"
    return turns[::2], turns[1::2]


def test_an_experts_chat_is_what_the_environment_says(some, tmp_path):
    found, done = chats(some, tmp_path / "out")
    assert (len(found), done.episodes, done.by_tick, dict(done.left_out)) == (3, 3, 0, {})
    for chat, task in zip(found, some.tasks, strict=True):
        asked, answered = check_form(chat)
        home = TextHome(task)
        text, _ = home.reset()
        for user, assistant in zip(asked, answered, strict=True):
            assert user["content"] == text
            text, _, won, _, info = home.step(assistant["content"])
            assert info["fault"] is None
        assert won and chat["won"] and chat["ticks"] == info["ticks"] and chat["agent"] == "expert"


@pytest.mark.parametrize("main", ["human_like", "random"])
def test_a_recorded_episodes_chat_is_played_again_word_for_word(results, tmp_path, knowledge, main):
    found, done = chats(results[main], tmp_path / "out")
    assert len(found) == done.episodes == 3 and not done.left_out
    tasks = {task.id: task for task in results[main].header.suite.tasks}
    for chat, record in zip(found, results[main].records, strict=True):
        play = Play(protocol(), frozenset(played(knowledge)), 250, travel=chat["travel"], rules=RULES)
        now = begun(tasks[chat["task"]], play, knowledge)
        for user, assistant in zip(*check_form(chat), strict=True):
            shown = seen(now, play)
            assert user["content"] == observed(now, play, shown)
            now, _ = commanded(now, assistant["content"], play, shown)
        assert now.won == chat["won"] == record.metrics["success"] and now.ticks == chat["ticks"]
        assert chat["travel"] or len(record.actions) == chat["ticks"]


def test_most_walks_are_one_turn(results, tmp_path):
    found, done = chats(results["human_like"], tmp_path / "out")
    whole = [chat for chat in found if chat["travel"]]
    assert whole and len(whole) == len(found) - done.by_tick
    assert all(len(chat["messages"]) // 2 < chat["ticks"] for chat in whole)


def test_what_an_observation_does_not_show_is_left_out_and_counted(results, tmp_path):
    found, done = chats(results["oracle"], tmp_path / "out")
    assert done.left_out[UNSEEN] == 3 - len(found) > 0


def test_episodes_with_a_helper_are_left_out_and_counted(tmp_path):
    lineup = Lineup("human_like", "random")
    both = run(suite("wah", "test-1", limit=1), lineup, 1, tmp_path / "both.jsonl", default)
    found, done = chats(both, tmp_path / "out")
    assert len(found) == 1 and found[0]["messages"][1]["content"].startswith("Goal: ") and done.left_out == {TWO: 1}


def test_an_agent_that_talks_is_left_out_and_counted(results, tmp_path):
    (record, *_), header = results["human_like"].records, results["human_like"].header
    talking = replace(results["human_like"], header=header, records=(replace(record, actions=(("ask",),)),))
    assert chats(talking, tmp_path / "out")[1].left_out == {chat_messages.TALKS: 1}


def test_the_expert_that_fails_is_left_out_and_counted(some, tmp_path, monkeypatch):
    monkeypatch.setattr(chat_messages, "challenge", lambda name: type("Short", (), {"ticks": 2}))
    assert chats(some, tmp_path / "out")[1].left_out == {chat_messages.UNSOLVED: 3}


def test_the_first_episodes_and_the_same_bytes(some, tmp_path):
    assert len(chats(some, tmp_path / "one", 1)[0]) == 1
    chats(some, tmp_path / "two", 1)
    assert (tmp_path / "one" / "messages.jsonl").read_bytes() == (tmp_path / "two" / "messages.jsonl").read_bytes()


def test_the_command_takes_tasks_and_results(some, results, tmp_path, capsys):
    write(tmp_path / "tasks.json", some)
    path = results["oracle"].records._path
    assert is_results(path) and not is_results(tmp_path / "tasks.json")
    command(tmp_path / "tasks.json", "messages", out=tmp_path / "a", limit=1, as_json=True)
    assert json.loads(capsys.readouterr().out)["episodes"] == 1
    command(path, "messages", out=tmp_path / "b", limit=2)
    assert f"left out: 2 episodes: {UNSEEN}" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("content", "code"),
    [(b"", Code.BAD_JSON), (b"\x00\xff", Code.BAD_JSON), (b"[1]", Code.BAD_JSON), (b'{"format": 3}', Code.BAD_JSON)],
)
def test_other_files_are_refused(tmp_path, content, code):
    (tmp_path / "file").write_bytes(content)
    with pytest.raises(HearthError) as caught:
        command(tmp_path / "file", "messages", out=tmp_path / "out")
    assert caught.value.diagnostics[0].code is code and not (tmp_path / "out").exists()


def test_a_folder_that_is_not_empty_and_an_unknown_form_are_refused(some, results, tmp_path):
    (tmp_path / "there").touch()
    with pytest.raises(HearthError) as caught:
        export_messages(some, tmp_path, default())
    assert caught.value.diagnostics[0].code is Code.UNWRITABLE
    with pytest.raises(HearthError, match="unknown form") as caught:
        export(results["oracle"], "chats", tmp_path / "x", 0, default())
    assert "messages" in caught.value.diagnostics[0].suggestion
