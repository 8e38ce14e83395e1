"""Language models and people: a scripted one reads what it is given, answers in text, and its words are kept."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from hearth.agents.protocol import Resigned
from hearth.challenges.episode_loop import Player, play
from hearth.envs.agent_answers import by_text
from hearth.envs.json_observations import observation, seen_goal
from hearth.envs.text_agent import MOST_LISTED, TextAgent, description, menu, plain, understood
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.simulation.actions.legal import legal
from hearth.simulation.env import Env
from hearth.simulation.goal_text import read_goal

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def env(maple):
    env = Env(knowledge=default())
    env.reset(maple, 2, seed=1)
    return env


def scripted(*answers):
    """A language model that says these, then waits."""
    rest, prompts = list(answers), []

    def ask(prompt):
        prompts.append(prompt)
        return rest.pop(0) if rest else "wait"

    return ask, prompts


def played(env, *answers, goal="HOLDS(agent, milk)", limit=12):
    ask, prompts = scripted(*answers)
    rows = []
    agent = TextAgent(ask, rows.append)
    found = read_goal(goal, env.world.home)
    done = play(env.world, found, [Player(agent, found)], 1, limit=limit)
    return done, agent, prompts, rows


def test_a_model_reads_the_menu_and_reaches_its_goal(env):
    """It takes numbers from the lines of the menu, and writes what is not listed."""

    def ask(prompt):
        for action, thing in (("Grab", "milk"), ("Open", "fridge"), ("Walk", "fridge"), ("Walk", "kitchen")):
            line = re.search(rf"^  {action}: (.*)$", prompt, re.MULTILINE)
            number = line and re.search(rf"(?:^|; )([0-9]+) {thing} ", line[1])
            if number:
                return f"I think that I should {action.lower()} the {thing}.\n\n{number[1]}."
        return "wait"

    found = read_goal("HOLDS(agent, milk)", env.world.home)
    rows = []
    done = play(env.world, found, [Player(TextAgent(ask, rows.append), found)], 1, limit=10)
    assert done.success and done.ticks == 4, [(row["answer"], row["fault"]) for row in rows]


def test_answers_in_text_and_what_was_wrong_with_them(env):
    done, agent, prompts, rows = played(
        env, "Walk kitchen", "fly", "[Walk] <fridge> (1)", "open fridge.", "GRAB milk", "99999", "Grab milk 142"
    )
    assert done.success and done.ticks == 7
    assert [(fault.tick, str(fault.fault.code)) for fault in agent.faults] == [
        (1, "UNKNOWN_ACTION"), (4, "AMBIGUOUS"), (5, "BAD_ARGUMENT"),
    ]  # fmt: skip
    assert prompts[2].startswith("Your last answer was not used, and you waited. UNKNOWN_ACTION")
    assert prompts[3].startswith("Tick 3.")
    assert "you see 142, 143" in prompts[5] and "You last tried: Open fridge 137." in prompts[5]
    assert [row["instruction"] for row in rows][:3] == ["[Walk] <kitchen> (1.109)", None, "[Walk] <fridge> (1.137)"]
    assert [row["prompt"] for row in rows] == prompts and rows[0]["answer"] == "Walk kitchen"
    assert json.loads(json.dumps(rows)) == rows


@pytest.mark.parametrize(
    ("answer", "code"),
    [
        ("", "EMPTY"), (" \n\n", "EMPTY"), (None, "NOT_TEXT"), (b"3", "NOT_TEXT"), ("Walk bed", "NOT_SEEN"),
        ("go to the kitchen", "UNKNOWN_OBJECT"), ("12 or 13", "NOT_UNDERSTOOD"), ("Walk bed 82", "UNBOUND"),
        ("Grab", "WRONG_ARITY"), ("Walk door 3, door 5", "WRONG_ARITY"), ("Walk zebra", "UNKNOWN_OBJECT"),
        ("Walk bed 4000", "NOT_SEEN"), ("999999999999", "NOT_UNDERSTOOD"), ("Grab bookshelf", "NOT_AFFORDED"),
        ("[Walk] <desk> (7)", "NOT_SEEN"), ("Walk desk " + "9" * 5000, "LINE_TOO_LONG"), ("[Walk <desk>", "SYNTAX"),
        ("<char1> [Walk] <desk> (1)", "UNKNOWN_AGENT"), ("Walk \x1b[31m", "NOT_UNDERSTOOD"),
        ("StandUp", "NOT_SITTING_OR_LYING"), ("Type keyboard", "NOT_CLOSE"),
    ],
)  # fmt: skip
def test_an_answer_that_means_nothing_is_typed(env, answer, code):
    may = env.legal(0)
    with pytest.raises(HearthError) as caught:
        understood(answer, env.observe(0), may, list(may))
    fault = caught.value.diagnostics[0]
    assert str(fault.code) == code and fault.message


def test_every_listed_instruction_is_one_and_the_list_is_bounded(env):
    env.step({0: "[Walk] <fridge> (1)"})
    env.step({0: "[Open] <fridge> (1)"})
    may, seen = env.legal(0), env.observe(0)
    options = list(may)
    text = menu(options, seen)
    bare = re.sub(r"(?:; |: )[0-9]+ more can be written", "", text.split("\n", 1)[1])
    listed = re.findall(r"(?:: |; )([0-9]+)(?: ([^;\n]*))?", bare)
    assert len(listed) > 100
    for number, words in listed:
        step = options[int(number)]
        assert plain(step) == f"{step.action} {words}".rstrip()
        assert by_text(plain(step), seen, may) == step
    for line in text.splitlines()[1:]:
        assert line.count(";") <= MOST_LISTED
    left_out = next(step for step in options if step.objects and step.objects[0].name == "wall")
    assert f" {plain(left_out).partition(' ')[2]};" not in text and by_text(plain(left_out), seen, may) == left_out
    assert text == menu(list(env.legal(0)), env.observe(0))


def test_the_goal_names_what_is_missing_as_far_as_it_is_seen(env):
    goal = read_goal("ON(plate, table): 6 and not CLOSED(fridge) and (OPEN(fridge) then WATCH)", env.world.home)
    assert next((each.wanted, each.seen) for each in seen_goal(goal, env.observe(0))) == (6, 0)
    env.step({0: "[Walk] <fridge> (1)"})
    seen = env.observe(0)
    assert [(each.wanted, each.seen) for each in seen_goal(goal, seen)] == [(6, 4), (1, 0), (1, 0), (1, None)]
    text = description(seen, goal)
    assert "ON(plate, table): you see 4 of 6; 2 missing as far as you see" in text
    assert observation(seen, goal)["goal"]["literals"][0] == {"literal": "ON(plate, table)", "wanted": 6, "seen": 4}


def test_the_other_and_its_last_action_are_described(env):
    env.step({0: "[Walk] <fridge> (1)", 1: "[Walk] <fridge> (1)"})
    env.step({0: "[Open] <fridge> (1)", 1: "[Close] <fridge> (1)"})
    text = description(env.observe(0))
    assert (
        "Agent 1 is here, standing in kitchen 109, and holds nothing. It last tried: Close fridge 137, which failed."
        in text
    )
    assert "In fridge 137: food_chicken 138" in text and "door 3 (open, to living_room 1)" in text
    assert "Agent 0 is here" in description(env.observe(1))


def test_a_failure_names_no_door_that_is_not_seen(maple):
    """Willow has a room behind a room: a walk there ends at a door that is not seen from here."""
    from hearth.homes import library
    from hearth.simulation.world.bits import indices
    from hearth.simulation.world.edit import edit
    from hearth.simulation.world.home import Home

    home = Home.from_graph(library.load_graph("willow", default()), "willow", default())
    env = Env(knowledge=default())
    env.reset(home)
    doors = [
        home.ids[i] for i in indices(home.doors & home.properties["CAN_OPEN"]) if not env.observe().sees(home.ids[i])
    ]
    env.restore(edit(env.world, set=[(door, "CLOSED") for door in doors], check=False))
    offered = [step for step in env.legal() if step.action == "Walk" and step not in legal(env.world)]
    assert offered
    failure = env.step(offered[0]).failures[0]
    assert str(failure.code) == "DOOR_CLOSED" and failure.objects[0] in doors
    shown = observation(env.observe())["me"]["last"]["failure"]
    assert shown["code"] == "DOOR_CLOSED" and f"({failure.objects[0]})" not in shown["message"]
    assert f"({failure.objects[0]})" not in description(env.observe())


def test_a_person_who_leaves_ends_the_episode(env):
    def ask(prompt):
        raise EOFError

    found = read_goal("HOLDS(agent, milk)", env.world.home)
    done = play(env.world, found, [Player(TextAgent(ask), found)], 1)
    assert done.ticks == 0 and not done.success
    with pytest.raises(Resigned):
        TextAgent(ask).act(env.observe(), env.legal())


def test_one_plays_at_the_terminal(tmp_path):
    words = ["play", "maple", "--goal", "HOLDS(agent, milk)", "--text", "--actions", "Walk,Open,Grab"]
    kept, file = tmp_path / "t.jsonl", tmp_path / "e.jsonl"
    done = subprocess.run(
        [sys.executable, str(ROOT / "cli.py"), *words, "--transcript", str(kept), "--out", str(file)],
        input="Walk kitchen\nWalk fridge\nTurnleft\nOpen fridge\nGrab milk 142\n",
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "Goal: reached after 5 ticks." in done.stdout and "NOT_ALLOWED" in done.stdout
    assert [json.loads(line)["answer"].strip() for line in kept.read_text().splitlines()][3] == "Open fridge"
    assert json.loads(file.read_text().splitlines()[1])["ticks"][2] == {}
