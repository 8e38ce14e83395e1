"""Agents of others that say something instead of doing something: over JSON lines, in text, and in what is recorded."""

from __future__ import annotations

import json
import sys

import pytest

from hearth.challenges.agent_channels import ProcessChannel
from hearth.challenges.episode_loop import Player, play
from hearth.challenges.wire_protocol import WireAgent
from hearth.envs.agent_answers import by_words
from hearth.envs.json_observations import observation
from hearth.envs.text_agent import TextAgent
from hearth.kb.loading.load import default
from hearth.schemas.agent_messages import Message
from hearth.schemas.diagnostics import HearthError
from hearth.simulation.env import Env
from hearth.simulation.episode import Episode
from hearth.simulation.episode_files import read, write
from hearth.simulation.goal_text import read_goal

ASKING = """
import json, sys
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "observe":
        said = message["observation"]["messages"]
        print(json.dumps({"tick": message["tick"], "act": None if said else "Ask"}), flush=True)
"""
TELLING = "Tell ON(plate, 55) 2"


@pytest.fixture(scope="module")
def start(maple):
    env = Env(knowledge=default())
    env.reset(maple, 2, seed=1)
    return env.world


def conversation(start, messages=True):
    """A program asks in every tick until it is answered; a model answers what it is asked."""
    program = WireAgent(ProcessChannel([sys.executable, "-c", ASKING]), 20.0, messages=messages)
    prompts, rows = [], []

    def ask(prompt):
        prompts.append(prompt)
        return TELLING if "Agent 0 said: Ask." in prompt else "wait"

    goal = read_goal("HOLDS(agent, milk)", start.home)
    players = [Player(program, goal), Player(TextAgent(ask, rows.append, messages), goal)]
    try:
        return play(start, goal, players, 7, limit=4, messages=messages), program, prompts, rows
    finally:
        program.channel.close(0.5)


def test_a_program_asks_and_a_model_answers(start):
    done, program, prompts, rows = conversation(start)
    said = [{n: str(message) for n, message in each.items()} for each in done.said]
    assert said == [{0: "Ask"}, {0: "Ask", 1: TELLING}, {1: TELLING}, {}]
    assert not program.faults and all(not tick.instructions for tick in done.env.ticks)
    assert [row["said"] for row in rows] == [None, TELLING, TELLING, None]
    assert "`Tell ON(plate, 55) 2`" in prompts[0] and "said" not in prompts[0].partition("What you can do")[0]


def test_where_messages_are_not_allowed_they_are_faults(start):
    done, program, prompts, _ = conversation(start, messages=False)
    assert done.said == ({}, {}, {}, {})
    assert [(fault.tick, str(fault.fault.code)) for fault in program.faults] == [
        (n, "UNKNOWN_ACTION") for n in range(4)
    ]
    assert not any("Tell" in prompt for prompt in prompts)


@pytest.mark.parametrize("text", ["Tell", "Ask me", "Tell ON(plate, table) 2", "Tell ON(plate, 55) 2\nWalk"])
def test_what_is_no_message_is_refused_with_an_example(start, text):
    env = Env(knowledge=default())
    env.restore(start)
    with pytest.raises(HearthError) as caught:
        by_words(text, env.observe(0), env.legal(0), messages=True)
    (fault,) = caught.value.diagnostics
    assert str(fault.code) == "SYNTAX" and TELLING in fault.suggestion


def test_an_observation_has_what_others_said(start):
    env = Env(knowledge=default())
    env.restore(start)
    assert observation(env.observe(0))["messages"] == []
    done, *_ = conversation(start)
    assert isinstance(done.said[1][1], Message) and json.dumps(observation(env.observe(1)))


def test_an_episode_keeps_what_was_said_and_a_changed_word_is_found(start, tmp_path):
    done, *_ = conversation(start)
    file = tmp_path / "episode.jsonl"
    write(file, [Episode.of(done.env, done.said)])
    (found,) = read(file, default())
    assert found.said == done.said and found.verify() is None
    assert found != Episode.of(done.env)
    file.write_text(file.read_text().replace("plate, 55", "plate, 56"))
    (altered,) = read(file, default())
    assert altered.verify().line == 2


@pytest.mark.parametrize("text", ["Tell", "<script>alert(1)</script>", "\x1b[2J"])
def test_what_is_no_message_is_no_episode(start, text, tmp_path):
    done, *_ = conversation(start)
    file = tmp_path / "episode.jsonl"
    write(file, [Episode.of(done.env, done.said)])
    file.write_text(file.read_text().replace('"Ask"', json.dumps(text)))
    with pytest.raises(HearthError) as caught:
        list(read(file, default()))
    assert str(caught.value.diagnostics[0].code) == "BAD_JSON" and caught.value.diagnostics[0].line == 2
