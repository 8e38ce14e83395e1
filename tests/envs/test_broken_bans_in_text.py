"""Bans in text environments: a broken one is said, and puts the goal out of reach."""

import pytest

from hearth.challenges.text_episode import TextEpisode
from hearth.envs.text_homes import TextHome
from hearth.schemas.diagnostics import HearthError

WAY = ("Walk fridge", "Open fridge", "Grab milk 142")


@pytest.mark.parametrize("ban", ["never OPEN(fridge)", "not ([Open](fridge))"])
def test_a_broken_ban_is_said_and_no_part_of_the_goal_counts_any_longer(ban):
    home = TextHome("maple", f"HOLDS(agent, milk) and {ban}")
    text, info = home.reset(seed=1)
    assert info["broken"] == [] and "Broken" not in text and info["goal_fraction"] == 0.5
    for command in WAY:
        text, _, won, cut, info = home.step(command)
    assert not won and not cut and info["fault"] is None
    assert len(info["broken"]) == 1 and info["goal_fraction"] == 0.0
    assert f"Broken: {info['broken'][0]}. The goal can't be reached any longer." in text


def test_what_is_late_is_not_broken():
    home = TextHome("maple", "HOLDS(agent, milk) within 1 and OPEN(fridge)")
    home.reset(seed=1)
    for command in WAY:
        *_, info = home.step(command)
    assert info["broken"] == [] and info["goal_fraction"] == 0.5


def test_a_goal_that_only_forbids_is_refused():
    for begin in (TextHome, TextEpisode):
        with pytest.raises(HearthError, match="only forbids"):
            begin("maple", "never OPEN(fridge)")
    TextHome("maple", "not (CLOSED(fridge))")  # a state to bring about


def test_episodes_say_it_in_json():
    episode = TextEpisode("maple", "HOLDS(agent, milk) and never OPEN(fridge)")
    episode.reset(seed=1)
    turns = [episode.step(command).as_json() for command in WAY]
    assert turns[0]["broken"] == () and turns[-1]["broken"] == ("never (OPEN(fridge))",)
