"""Tasks of a challenge are played in text by the challenge's rules, as `challenge run` plays them."""

from __future__ import annotations

import random

import pytest

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.household import household_task
from hearth.challenges.household_as_challenge import as_task
from hearth.challenges.published_tasks import tasks
from hearth.envs.session import opening
from hearth.envs.text_homes import TextHome
from hearth.kb.loading.load import default
from hearth.simulation.actions.legal import legal
from hearth.simulation.rules import DEFAULT

TASKS = {
    "wah": lambda: tasks("wah", "train", limit=1)[0],
    "owah": lambda: tasks("owah", "train", limit=1)[0],
    "household": lambda: household_task("household-train-00001"),
    "household as a task of a challenge": lambda: as_task(household_task("household-train-00001")),
}


@pytest.mark.parametrize("name", TASKS)
def test_what_may_be_done_is_what_the_challenge_says(name):
    which, differing = challenge(name.partition(" ")[0]), 0
    home, chooser = TextHome(TASKS[name](), limit=60), random.Random(4)
    _, info = home.reset()
    for _ in range(40):
        now, (_, may) = home._homes._places[0].now, home._homes._places[0].shown
        by_challenge, by_default = (
            legal(now.world, 0, rules, only_visible=True, actions=which.allowed(default()))
            for rules in (which.rules, DEFAULT)
        )
        assert dict(may.masks) == dict(by_challenge.masks)
        differing += dict(may.masks) != dict(by_default.masks)
        _, _, terminated, truncated, info = home.step(chooser.choice(list(info["admissible"])))
        if terminated or truncated:
            break
    assert differing or name == "owah", "the usual rules would have done, so that nothing was tested"


def test_a_goal_of_ones_own_is_played_by_the_usual_rules():
    home = TextHome(opening("maple", "ON(milk, table)", agents=1))
    home.reset(1)
    now, (_, may) = home._homes._places[0].now, home._homes._places[0].shown
    by_default = legal(now.world, 0, DEFAULT, only_visible=True, actions=challenge("wah").allowed(default()))
    assert dict(may.masks) == dict(by_default.masks)
