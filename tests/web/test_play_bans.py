"""Bans of a goal in a game: a row of their own, and a word once one is broken; in the room Play and at the terminal."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from web.playing import Player, session_of

from hearth.challenges.episodes import read_instruction
from hearth.challenges.household import household_task
from hearth.challenges.household_as_challenge import as_task
from hearth.challenges.household_definition import settings
from hearth.challenges.instruction_object_names import noun
from hearth.envs.json_observations import instruction_text
from hearth.kb.loading.load import default
from hearth.schemas.goals import Goal
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.world.world import World
from hearth.web.play import start_trial
from hearth.web.play.game_messages import joined_rows, part_words
from hearth.web.play.play_trials import trial

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def without():
    """A household task that forbids to open a kind of furniture."""
    for number in range(40):
        found = household_task(f"household-train-{number:05d}")
        if found.family == "without":
            return as_task(found)
    raise AssertionError("no task with a ban")


def first_taken(task):
    """The place of the first `Grab` in the acts of the task's expert, and the class of what it takes."""
    home = task.start(default()).home
    place = next(n for n, act in enumerate(task.origin.expert) if act and act.startswith("Grab"))
    return place, home.classes[home.index[int(task.origin.expert[place].split(" ")[1])]]


@pytest.fixture
def game(server, person, without):
    home = without.start(default()).home
    forbidden = replace(without, goal=without.goal & read_goal(f"never [Grab]({first_taken(without)[1]})", home))
    forbidden = replace(forbidden, origin=replace(forbidden.origin, goal=forbidden.goal))
    chosen = trial(forbidden, default())
    return server.store.write(lambda connection: start_trial(connection, session_of(server, person), chosen))


def test_a_ban_has_a_row_and_is_said_when_it_is_broken(person, game, without):
    home = without.start(default()).home
    place, name = first_taken(without)
    never = f"Never grab the {noun(name)}"
    allowed = default().group(settings()["actions"])
    page = person.get(f"/play/game/{game}").text
    with Player(person, game) as player:
        rows = [each for each in player.state["goal"] if "holds" in each]
        assert [each["text"] for each in rows] == [part_words(without.goal.parts[0], home), never]
        assert all(each["ban"] and each["holds"] and not each["lost"] for each in rows)
        assert rows[0]["text"] in page and "_" not in rows[0]["text"]
        for number, text in enumerate(without.origin.expert[: place + 1]):
            assert not any(each["lost"] for each in player.state["goal"] if "holds" in each), number
            player.patient_act(text and instruction_text(read_instruction(text, 0, home, allowed)))
        broken = [each for each in player.state["goal"] if each.get("lost")]
        assert [each["text"] for each in broken] == [never] and not broken[0]["holds"]
        player.patient_act("[Turnleft]")
        assert any(each.get("lost") for each in player.state["goal"]), "a broken ban stays broken"


@pytest.mark.parametrize(
    ("goal", "kept", "lost"),
    [
        ("never OPEN(fridge)", True, False), ("never CLOSED(fridge)", False, True),
        ("always CLOSED(fridge)", True, False), ("not (OPEN(fridge) and CLOSED(fridge))", True, False),
        ("not (CLOSED(fridge))", False, False), ("HOLDS(agent, milk) or OPEN(fridge)", False, False),
        ("HOLDS(agent, milk) within 0", False, True), ("HOLDS(agent, milk) within 5", False, False),
    ],
)  # fmt: skip
def test_what_is_lost_for_good_is_told_from_what_is_not_so_now(maple, goal, kept, lost):
    parts = read_goal(goal, maple).parts
    (row,) = joined_rows(Progress.start(Goal(parts=parts), World.start(maple)))
    assert (row["holds"], row["lost"]) == (kept, lost), row


def test_a_ban_is_said_at_the_terminal(tmp_path):
    command = [sys.executable, str(ROOT / "cli.py"), "play", "maple", "--text", "--ticks", "3", "--goal"]
    goal = "HOLDS(agent, milk) and never [Walk](couch)"
    done = subprocess.run(
        [*command, goal], input="wait\nWalk couch 51\nwait\n", capture_output=True, text=True, timeout=300, check=False
    )
    ban = [line.strip() for line in done.stdout.splitlines() if line.startswith("  never ")]
    kept = "never ([Walk](couch)): kept so far"
    broken = "never ([Walk](couch)): broken; the goal can't be reached any longer"
    assert ban == [kept, kept, broken], done.stdout
    assert "could not be reached any longer: never ([Walk](couch))" in done.stdout
