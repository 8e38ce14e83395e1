"""A person at the terminal: sentences, pages of commands, walks that go on, and a way out."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from hearth.challenges.episode_loop import Player, play
from hearth.envs.terminal_agent import HELP, PAGE, TerminalAgent
from hearth.kb.loading.load import default
from hearth.simulation.env import Env
from hearth.simulation.goal_text import read_goal

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def env(maple):
    env = Env(knowledge=default())
    env.reset(maple, 1, seed=1)
    return env


def played(env, *lines, goal="HOLDS(agent, milk)", actions=None):
    """Return an episode, the agent and the pages that a person saw; without more lines the person leaves."""
    rest, pages = list(lines), []

    def ask(page):
        pages.append(page)
        if not rest:
            raise EOFError
        return rest.pop(0)

    wanted = read_goal(goal, env.world.home)
    agent = TerminalAgent(ask)
    return play(env.world, wanted, [Player(agent, wanted)], 1, actions=actions, limit=60), agent, pages


def test_a_person_plays_in_sentences(env):
    said = ("go to the kitchen", "walk to the fridge", "open the fridge", "take milk 142 out of the fridge")
    done, agent, _ = played(env, *said)
    assert done.success and done.ticks == 4 and not agent.faults


def test_pages_take_no_time_and_their_numbers_answer(env):
    done, agent, pages = played(env, "help", "list", "more", "list desk 82", "look", "list unicorns", "quit")
    assert done.ticks == 0 and not done.success and not agent.faults
    prompt, first, page, more, desk, look, none = pages
    assert "quit" in prompt and len(prompt) < 1600
    assert first == HELP
    assert page.count("\n") == PAGE + 1 and " wall " not in page and "Find" not in page
    assert not set(page.splitlines()[:PAGE]) & set(more.splitlines()[:PAGE])
    assert all("desk 82" in line for line in desk.splitlines() if not line.startswith("...")) and "Open desk 82" in desk
    assert "book 66" in look and "unicorns" in none
    number = next(line.split()[0] for line in desk.splitlines() if line.endswith("Open desk 82"))
    done, agent, _ = played(env, number, goal="OPEN(desk)")
    assert done.success and not agent.faults


def test_a_walk_by_meters_goes_on_until_one_arrives(env):
    done, agent, pages = played(env, "walk to the fridge", "walk to the kitchen", "walk to the fridge", "quit",
                                actions=default().group("played"))  # fmt: skip
    assert [fault.fault.code for fault in agent.faults] == ["NOT_SEEN"]
    assert done.ticks > 5 and len(pages) < done.ticks


def test_a_line_that_is_not_understood_says_why(env):
    _, _, pages = played(env, "Grab milk", "fly")
    assert "NOT_SEEN: you do not see `milk` (you see none; open " in pages[1]
    assert "or look in kitchen 109 or bedroom 237" in pages[1] and "UNKNOWN_ACTION" in pages[2]


@pytest.mark.parametrize("goal", ["never OPEN(fridge)", "always CLOSED(fridge)", "not ([Open](fridge))"])
def test_a_goal_that_only_forbids_is_refused(goal):
    command = [sys.executable, str(ROOT / "cli.py"), "play", "maple", "--text", "--goal", goal]
    done = subprocess.run(command, input="quit\n", capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 1 and "only forbids" in done.stderr and "reached" not in done.stdout
