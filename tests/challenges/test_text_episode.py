"""An episode for the hubs: plain values in, plain values out, and every wrong value a typed fault."""

from __future__ import annotations

import json

import pytest

import hearth
from hearth.challenges.published_tasks import tasks
from hearth.challenges.text_episode import TextEpisode, text_tasks
from hearth.schemas.diagnostics import HearthError

MILK = ("Walk kitchen", "Walk fridge", "Open fridge", "Grab milk 142")


def code_of(work):
    with pytest.raises(HearthError) as caught:
        work()
    return str(caught.value.diagnostics[0].code)


def test_rewards_and_texts_are_those_of_the_engine():
    episode, home = TextEpisode("maple", "HOLDS(agent, milk)"), hearth.TextHome("maple", "HOLDS(agent, milk)")
    turn, (text, _) = episode.reset(4), home.reset(4)
    assert turn.observation == text
    total = 0.0
    for number, command in enumerate(MILK, 1):
        turn = episode.step(command)
        text, reward, terminated, truncated, info = home.step(command)
        total += reward
        assert (turn.observation, turn.reward, turn.won, turn.truncated) == (text, reward, terminated, truncated)
        assert (turn.turn, turn.ticks, turn.total) == (number, info["ticks"], total)
    assert turn.won and turn.done and episode.admissible == []
    assert json.loads(json.dumps(turn.as_json()))["done"] is True


def test_a_seed_draws_the_same_task_again():
    episode = TextEpisode(tasks="wah:train:40")
    first, second = episode.reset(7), episode.reset(8)
    assert episode.reset(7) == first != second
    assert episode.reset(index=3).task == tasks("wah", "train", limit=4)[3].id


def test_a_second_episode_counts_from_zero():
    episode = TextEpisode("maple", "HOLDS(agent, milk)", limit=2)
    episode.reset(1)
    episode.step("wait")
    assert episode.step("wait").truncated
    turn = episode.reset(1)
    assert (turn.turn, turn.total, turn.ticks, turn.truncated) == (0, 0.0, 0, False)


@pytest.mark.parametrize("seed", [-1, 2**63, True, "1", 1.0, None, [1]])
def test_a_seed_is_a_whole_number(seed):
    assert code_of(lambda: TextEpisode("maple", "HOLDS(agent, milk)").reset(seed)) == "BAD_ARGUMENT"


@pytest.mark.parametrize("index", [-1, 4, True, "1"])
def test_an_index_is_that_of_a_task(index):
    assert code_of(lambda: TextEpisode(tasks="wah:train:4").reset(index=index)) == "BAD_ARGUMENT"


@pytest.mark.parametrize(
    ("given", "code"),
    [
        ({"home": "castle", "goal": "HOLDS(agent, milk)"}, "UNKNOWN_HOME"),
        ({"home": "data_raw/homes/maple.yaml", "goal": "HOLDS(agent, milk)"}, "UNKNOWN_HOME"),
        ({"home": 3, "goal": "HOLDS(agent, milk)"}, "UNKNOWN_HOME"),
        ({"home": "maple"}, "BAD_ARGUMENT"),
        ({"home": "maple", "goal": 7}, "BAD_ARGUMENT"),
        ({"home": "maple", "goal": "x" * 3_000}, "BAD_ARGUMENT"),
        ({"home": "maple", "tasks": "wah:train:2"}, "BAD_ARGUMENT"),
        ({"tasks": "wah:nowhere"}, "BAD_ARGUMENT"),
        ({"tasks": "wah:train:many"}, "BAD_ARGUMENT"),
        ({"tasks": "household:train"}, "BAD_ARGUMENT"),
        ({"tasks": "no-such-file.json"}, "MISSING_FILE"),
    ],
)
def test_what_is_asked_for_wrongly_is_a_typed_fault(given, code):
    assert code_of(lambda: TextEpisode(**given)) == code


def test_what_is_out_of_order_is_said():
    episode = TextEpisode("maple", "HOLDS(agent, milk)", limit=1)
    assert code_of(lambda: episode.step("wait")) == "OUT_OF_ORDER"
    assert code_of(lambda: episode.admissible) == "OUT_OF_ORDER"
    episode.reset()
    assert episode.step({"action": "wait"}).fault["code"] == "NOT_TEXT"
    assert code_of(lambda: episode.step("wait")) == "OUT_OF_ORDER"


def test_a_source_names_its_tasks():
    assert [task.id for task in text_tasks("wah:train:3")] == [task.id for task in tasks("wah", "train", limit=3)]


def test_an_expert_reaches_the_goal_where_one_is_asked_for():
    episode = TextEpisode("maple", "ON(milk, table)", expert=True)
    turn = episode.reset(2)
    while not turn.done:
        turn = episode.step(episode.expert)
    assert turn.won
    plain = TextEpisode("maple", "ON(milk, table)")
    plain.reset(2)
    assert code_of(lambda: plain.expert) == "BAD_ARGUMENT"
