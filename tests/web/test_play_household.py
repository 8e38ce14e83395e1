"""Household tasks on the page: offered, asked in words, played to their end by the socket, verified afterwards."""

from __future__ import annotations

import pytest
from web.playing import Player

from hearth.challenges.episodes import read_instruction
from hearth.challenges.household import household_task
from hearth.challenges.household_as_challenge import as_task
from hearth.challenges.household_definition import settings
from hearth.challenges.instruction_object_names import label
from hearth.challenges.result_files import read
from hearth.challenges.verification import verify
from hearth.envs.json_observations import instruction_text
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal
from hearth.web.play.game_messages import goal_words
from hearth.web.play.games import Game
from hearth.web.play.play_trials import offered, read_trial, trial

TASK = "household-train-00001"


@pytest.fixture(scope="module")
def task():
    return as_task(household_task(TASK))


def new(person, **form):
    return person.post("/play/new", data={"challenge": "household", **form}, follow_redirects=False)


def test_the_page_offers_every_family(person):
    page = person.get("/play/").text
    assert 'id="household-title"' in page and all(words in page for words in settings()["titles"].values())
    assert settings()["titles"].keys() == set(settings()["families"])


def test_a_task_is_asked_in_words_and_ends_when_its_goal_holds(person, task, tmp_path):
    answer = new(person, id=TASK, task="0")
    assert answer.status_code == 303
    address = answer.headers["location"]
    page = person.get(address).text
    assert task.instruction in page.replace("&#39;", "'") and settings()["titles"][task.family] in page
    home = task.start(default()).home
    allowed = default().group(settings()["actions"])
    with Player(person, address.rpartition("/")[2]) as player:
        assert all(each["count"] < each["wanted"] or not each["wanted"] for each in player.state["goal"])
        things = player.state["things"].values()
        plain = [each for each in things if each[1] != "rooms"]
        assert plain and all(words.startswith(label(name)) for name, _, _, words in plain)
        for text in task.origin.expert:
            assert not player.state["over"]
            step = read_instruction(text, 0, home, allowed) if text else None
            assert player.patient_act(step and instruction_text(step))["type"] == "tick", text
        assert player.state["over"] and player.state["success"] and player.state["tick"] == task.origin.min_ticks
        assert all(each["count"] == each["wanted"] for each in player.state["goal"])
    file = tmp_path / "episode.jsonl"
    file.write_bytes(person.get(f"{address}/episode.jsonl").content)
    found = read(file)
    assert verify(found, task.id, default) == []
    assert next(iter(found.records)).metrics["success"]
    assert f"<td>{settings()['titles'][task.family]}</td>" in (page := person.get("/play/").text)
    assert task.home not in page and "goal reached" in page


def test_a_task_is_begun_by_its_number(person):
    address = new(person, task="5", id=" ").headers["location"]
    assert settings()["titles"]["look_in_light"] in person.get(address).text


@pytest.mark.parametrize("form", [{"id": "household-train-99999"}, {"id": "wah-test-1-0001"}, {"task": "x"}, {}])
def test_a_task_that_there_is_not_is_refused(person, form):
    answer = new(person, **form)
    assert answer.status_code == 400 and "household" in answer.text


def test_nobody_helps_where_tasks_are_for_one(task):
    assert set(offered(trial(task, default()).challenge)) == {"none"}
    for helper in ("hp", "person", "program"):
        with pytest.raises(HearthError, match="its tasks are for one agent"):
            trial(task, default(), helper)


def test_a_trial_of_a_household_task_is_read_as_it_was_written(task):
    made = trial(task, default(), "none", "symbolic", 2)
    assert read_trial(made.as_json()) == made


@pytest.mark.parametrize(
    ("literal", "words"),
    [
        (Literal.of("HOLDS", "agent", "milk"), "Hold milk"), (Literal.of("ON", "agent", "couch"), "Sit on couch"),
        (Literal.of("INSIDE", "milk", "fridge"), "Put milk in fridge"),
        (Literal.of("ON", "tablelamp"), "Switch a table lamp on"),
        (Literal("ON", ("tablelamp",), True), "Every table lamp off"),
        (Literal.of("ON", "shoes", "agent"), "With a pair of shoes on"),
        (Literal.of("ON", "mouse", "cpuscreen"), "Put mouse on computer screen"),
    ],
)  # fmt: skip
def test_every_part_of_a_goal_has_words(task, literal, words):
    assert goal_words(literal, task.start(default()).home) == words


def test_names_are_words():
    assert [label(each) for each in ("cpuscreen", "milk", "chest_of_drawers", "clothes_hat")] == [
        "computer screen", "milk", "chest of drawers", "hat"]  # fmt: skip


def test_an_activity_is_asked_by_its_goal_alone():
    """Its person's own words tell of more: one closed a window too, and only sitting down counts."""
    task = as_task(household_task("household-test_seen-00000"))
    assert task.instruction.startswith("Close the window at night. ")
    assert trial(task, default()).instruction == "Your task is to find the bed and sit or lie on it."


def test_what_was_seen_is_remembered_in_another_room(task):
    """Of a class of things that are out of sight, what was last seen counts."""
    game = Game(trial(task, default()), default())
    seen = game.seen[0]
    seen.goal = Goal.of(Literal("ON", ("light",), True))
    seen._look(game.view(0))
    before = seen.counts
    hidden = game.view(0)
    object.__setattr__(hidden, "mask", 0)
    seen._look(hidden)
    assert seen.counts == before


def test_the_home_is_drawn(person, server):
    pytest.importorskip("trimesh")
    address = new(person, id="household-test_unseen-00003", interface="visual").headers["location"]
    with Player(person, address.rpartition("/")[2]) as player:
        drawn = player.state["drawn"]
    assert drawn["on"] and person.get(drawn["base"]).status_code == 200
