"""Games: a person is an agent like any other; what was accepted is in the store, and nowhere else."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
import time
from dataclasses import replace

import pytest
from web.playing import Player, alone, begun, connected, session_of

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.published_tasks import tasks
from hearth.challenges.result_files import read
from hearth.challenges.verification import verify
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import lacking
from hearth.simulation.world.bits import indices
from hearth.web.play import game_store, recorded_episode, start_trial
from hearth.web.play.game_messages import Telling, legal_json
from hearth.web.play.game_results import results
from hearth.web.play.games import Game
from hearth.web.play.live_games import LiveGame, games
from hearth.web.play.play_trials import helpers, offered, published, read_trial, trial

OWAH = challenge("owah")
TASK = published("wah", "test-1", 0)
TURN = "[Turnleft]"


@pytest.fixture
def game(server, person):
    return begun(server, person, TASK)


@pytest.mark.parametrize("helper", ["none", "hp_true", "nopa", "person", "program"])
def test_a_trial_is_read_as_it_was_written(helper):
    made = trial(TASK, default(), helper, "visual", 3, False)
    assert read_trial(made.as_json()) == made
    assert made.helped == (helper != "none")


@pytest.mark.parametrize("wrong", [{"helper": "oracle_ab"}, {"interface": "smell"}, {"goal": "mine"}])
def test_a_trial_of_nothing_is_refused(wrong):
    with pytest.raises(HearthError, match="BAD_ARGUMENT"):
        trial(TASK, default(), **wrong)


def test_a_helper_that_asks_a_network_is_not_offered_without_it(monkeypatch):
    monkeypatch.setattr("hearth.challenges.episode_agents.lacking", lambda extra: ["torch"])
    with pytest.raises(HearthError, match="asks the network `helping-subgoals`, and torch is not installed"):
        trial(TASK, default(), "hybrid")
    assert {"hybrid", "hrl", "hp_gpn", "nopa_gpn"}.isdisjoint(offered(OWAH))
    assert {"none", "person", "program", "hp", "nopa"} <= set(offered(OWAH))


UNFIT = {"wah": {"asking", "nopa_gpn", "nopa_gpn_s", "hp_gpn", "hp_gpn_s", "af_gpn"}, "owah": {"asking"}}
"""Helpers that would end every game of a challenge: they talk, or ask a network of other goals."""


@pytest.mark.parametrize("name", UNFIT)
def test_a_helper_that_could_not_go_on_is_neither_offered_nor_begun(name):
    known = [each for each in helpers() if each != "none"]
    task = published(name, "test-1" if name == "wah" else "test", 3)
    assert UNFIT[name].isdisjoint(offered(challenge(name)))
    for helper in sorted(UNFIT[name]):
        with pytest.raises(HearthError, match=f"the helper `{helper}` can't help in `{name}`") as found:
            trial(task, default(), helper)
        assert found.value.diagnostics[0].suggestion
    for helper in offered(challenge(name)).keys() & known:
        game = Game(trial(task, default(), helper), default())
        for _ in range(5):
            game.advance(("Turnleft", game.helper_decides())[: len(game.start.agents)])
        assert game.tick == 5, helper


def test_who_asks_may_help_where_agents_may_talk():
    talking = challenge("owah_messages")
    assert {"asking", "nopa"} <= set(offered(talking))
    assert Lineup(helper="nopa_gpn").fits(talking).helper == "nopa_gpn"


def test_without_libraries_for_pictures_there_are_buttons_alone(monkeypatch, person):
    """A wheel that is installed with the extra `web` alone serves all that draws nothing."""
    assert 'value="visual"' in person.get("/play/").text
    monkeypatch.setattr("hearth.web.play.play_trials.lacking", lambda extra: ["numba"])
    assert 'value="visual"' not in person.get("/play/").text
    assert trial(TASK, default()).interface == "symbolic"
    for interface in ("visual", "stream"):
        with pytest.raises(HearthError, match="draws, and numba is not installed"):
            trial(TASK, default(), interface=interface)


def test_the_server_imports_nothing_that_draws():
    command = "import sys, hearth.web.application; print(*{'numba', 'cv2', 'trimesh', 'matplotlib'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", command], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""


def test_a_random_goal_is_another_one():
    assert trial(TASK, default(), "hp_random").helper_goal not in (None, TASK.goal)


def test_a_person_and_an_agent_do_the_same_task(server, person, tmp_path):
    game = begun(server, person, TASK)
    with Player(person, game) as player:
        assert player.state["goal"][0]["text"] == "Put plate on dining table"
        for act, text in alone(TASK):
            assert player.act(text)["type"] == "tick", act
    assert player.state["over"] and player.state["success"]
    assert all(each["count"] == each["wanted"] for each in player.state["goal"])
    file = tmp_path / "episode.jsonl"
    file.write_bytes(person.get(f"/play/game/{game}/episode.jsonl").content)
    found = read(file)
    assert next(iter(found.records)).metrics["success"] == 1
    assert verify(found, "episode.jsonl", default) == []


def test_another_record_does_not_verify(server, person, tmp_path):
    """The check is one that can fail: the same file with a turn more is another episode."""
    game = begun(server, person, TASK)
    with Player(person, game) as player:
        player.act(TURN)
        player.ask({"type": "finish"})
    file = tmp_path / "episode.jsonl"
    file.write_bytes(person.get(f"/play/game/{game}/episode.jsonl").content.replace(b"Turnleft", b"Turnright"))
    with pytest.raises(HearthError, match="DAMAGED_FILE"):
        read(file)


def test_what_is_refused_changes_nothing_and_says_why(server, person, game):
    with Player(person, game) as player:
        refusals = [
            player.act("[Grab] <plate> (1.999999)"),
            player.act("[Fly]"),
            player.act(7),
            player.act("x" * 600),
            player.act(TURN, tick=5),
            player.ask({"type": "dance"}),
            player.ask({"type": "act"}),
        ]
        codes = [each["error"]["code"] for each in refusals]
        expected = ["NOT_SEEN", "UNKNOWN_ACTION", "BAD_ARGUMENT", "BAD_ARGUMENT", "OUT_OF_ORDER", "BAD_ARGUMENT"]
        assert codes == [*expected, "BAD_ARGUMENT"]
        assert player.act(TURN)["tick"] == 1


def test_ten_thousand_malformed_messages_change_nothing(server, person, game):
    """Each gets an answer that says why; the next that is in order is taken."""
    wrong = ["", "{", "[]", "7", '{"type": 1, "n": 2}', '{"type": "act"}', '{"type": "act", "n": 2, "tick": -1}',
             '{"type": "act", "n": 2, "tick": 0, "act": {}}', '{"type": "act", "n": 2, "tick": 0, "act": "[Grab] <x>"}',
             '{"type": "act", "n": 2, "tick": true, "act": null}', "\u0000" * 50]  # fmt: skip
    with Player(person, game) as player:
        for number in range(10_000):
            player.socket.send_text(wrong[number % len(wrong)])
            assert player.receive()["type"] == "error"
        while player.receive_after_pause()["type"] == "error":
            pass
        assert player.state["tick"] == 1
    assert games(server.store, default()).open(game).game.texts == [("Turnleft",)]


def test_only_the_last_tab_acts(server, person, game):
    with Player(person, game, "old") as old, Player(person, game, "new") as new:
        assert old.act(TURN)["error"]["code"] == "LOCKED"
        assert new.act(TURN)["tick"] == 1
        assert old.act(TURN)["error"]["code"] == "OUT_OF_ORDER"
        assert old.ask({"type": "hello", "tab": "old"})["tick"] == 1
        assert old.act(TURN)["tick"] == 2


def test_who_did_not_say_hello_does_not_finish_a_game(server, person, game):
    with Player(person, game, "a") as player, connected(person, game) as silent:
        silent.send_text('{"n": 1, "type": "finish"}')
        assert json.loads(silent.receive_text())["error"]["code"] == "LOCKED"
        assert player.act(TURN)["over"] is False
        assert player.ask({"type": "finish"})["over"] is True


def test_two_decisions_of_one_tick_are_one(server, person, game):
    """Two servers get a decision of the same tick at the same moment: one is accepted."""
    session = session_of(server, person)
    with Player(person, game, "t"):
        servers = [LiveGame(server.store, games(server.store, default()).open(game).stored, default()) for _ in "ab"]
        done = []

        def decide(live):
            try:
                live.decide(session, "t", 0, 0, TURN)
                done.append("accepted")
            except Exception as error:
                done.append(str(error)[:12])

        threads = [threading.Thread(target=decide, args=(each,)) for each in servers]
        for each in threads:
            each.start()
        for each in threads:
            each.join()
        assert sorted(done) == ["OUT_OF_ORDER", "accepted"]
        for live in servers:
            live.sync()
            assert live.game.tick == 1


needs_models = pytest.mark.skipif(bool(lacking("models")), reason="the extra `models` is not installed")


@pytest.mark.parametrize("helper", ["hp_true", "random", pytest.param("hybrid", marks=needs_models)])
def test_another_process_goes_on_with_the_same_helper(server, person, helper):
    """Done again from the store, the helper decides as the one that was there all the time."""
    game = begun(server, person, TASK, helper)
    with Player(person, game) as player:
        for _ in range(6):
            player.act(TURN)
        kept = games(server.store, default()).open(game)
        anew = LiveGame(server.store, kept.stored, default())
        with kept.lock:
            assert anew.sync().texts == kept.game.texts
            assert len(kept.game.texts) == 6
            assert any(texts[1] for texts in kept.game.texts)
            assert anew.game.helper_decides() == kept.game.helper_decides()
        assert player.act(TURN)["tick"] == 7


def test_nobody_gets_anothers_game(server, person, game):
    other = server.person()
    assert other.get(f"/play/game/{game}").status_code == 404
    assert other.get(f"/play/game/{game}/episode.jsonl").status_code == 404
    assert other.get(f"/play/game/{game}/models/x.glb").status_code == 404
    assert game not in other.get("/play/").text
    with connected(other, game) as socket:
        assert "UNKNOWN_ID" in socket.receive_text()
    nobody = server.client()
    assert nobody.get(f"/play/game/{game}").status_code == 401
    assert person.get(f"/play/game/{game}").status_code == 200


def test_a_page_that_comes_back_goes_on(server, person, game):
    with Player(person, game) as player:
        player.act(TURN)
        before = player.state
    with Player(person, game) as again:
        assert again.state["tick"] == 1
        assert again.state["legal"] == before["legal"]
        assert [len(way) for way in again.state["trails"].values()] == [2]


def test_a_study_gets_the_record_once_it_is_over(server, person, game):
    assert recorded_episode(server.store, default(), game) is None
    with Player(person, game) as player:
        player.act(TURN)
        assert player.ask({"type": "finish"})["over"]
        assert player.act(TURN)["error"]["code"] == "NOT_ALLOWED"
    record = recorded_episode(server.store, default(), game)
    assert record.actions == (("Turnleft",),)
    assert record.end["code"] == "FINISHED"


@pytest.mark.parametrize("number", range(5))
def test_what_is_offered_is_about_what_is_shown_and_makes_sense(number):
    """A thing in the hand goes on surfaces and into containers alone, of which a menu does not list a hundred."""
    task, most = published("wah", "test-1", number), 0
    game = Game(trial(task, default(), partial=False), default())
    telling, home, shown = Telling(game, 0), game.start.home, set()
    has = {name: {home.ids[i] for i in indices(mask)} for name, mask in home.properties.items()}
    for act, _ in alone(task):
        shown |= telling.tick()["things"].keys()
        offered = legal_json(game.legal(0), game.view(0).me.node)
        assert {str(node) for places in offered.values() for ids in places for node in ids} <= shown
        assert set(offered.get("PutBack", [[], []])[1]) <= has["SURFACES"]
        assert set(offered.get("PutIn", [[], []])[1]) <= has["CONTAINERS"] | has["CAN_OPEN"]
        most = max(most, sum(len(offered[name][1]) for name in ("PutBack", "PutIn") if name in offered))
        game.advance((act,))
    assert 0 < most < 40, "something was held, and could be put somewhere"


def test_nothing_is_accepted_once_the_time_is_over(server, person):
    """The page shows how long it has, and that it is over, though nobody does anything."""
    chosen = replace(trial(TASK, default()), seconds=2.0)
    game = server.store.write(lambda connection: start_trial(connection, session_of(server, person), chosen))
    with Player(person, game) as player:
        assert 0 < player.state["left"] <= 2
        assert player.act(TURN)["tick"] == 1
        time.sleep(2.1)
        late = player.ask({"type": "act", "tick": 1, "act": TURN})
        assert late.get("over") or late["error"]["code"] == "NOT_ALLOWED"
        while not player.state["over"]:
            player.receive()
        assert (player.state["end"], player.state["ended_by"], player.state["tick"]) == ("TIMED_OUT", 0, 1)
    found = server.store.read(lambda connection: game_store.stored(connection, game))
    assert found.result["at"] - found.created == pytest.approx(2.0), "the time ends it, not who looks at it afterwards"


def test_a_game_without_a_limit_has_no_clock(server, person, game):
    with Player(person, game) as player:
        assert player.state["left"] is None


def test_results_of_many_games_verify(server, person, tmp_path):
    found = []
    for helper in ("none", "hp_true", "hp_true"):
        made = Game(trial(TASK, default(), helper), default())
        for _ in range(3):
            made.advance(("Turnleft", made.helper_decides())[: len(made.start.agents)])
        found.append(made)
    files = results(found)
    assert {kind[2]: len(each.records) for kind, each in files.items()} == {"none": 1, "hp_true": 2}
    assert [each.seed for each in files["wah", "test-1", "hp_true", "true"].records] == [0, 1]
    for each in files.values():
        assert verify(each, "file", default) == []


def test_researchers_get_everybodys_results(server, person, game):
    with Player(person, game) as player:
        player.ask({"type": "finish"})
    desk = server.researcher()
    assert "results.jsonl" in desk.get("/desk/play").text
    asked = "challenge=wah&split=test-1&helper=none&goal=none"
    assert desk.get(f"/desk/play/results.jsonl?{asked}").status_code == 200
    assert person.get(f"/desk/play/results.jsonl?{asked}").status_code in (401, 403)


def test_the_form_begins_a_game(person):
    page = person.get("/play/").text
    assert all((f'value="{name}"' in page) is (name != "asking") for name in helpers())
    begun = person.post("/play/new", data={"challenge": "owah", "task": "1", "helper": "none", "sees": "partial"})
    assert begun.status_code == 303
    page = person.get(begun.headers["location"]).text
    assert published("owah", "test", 1).home not in page, "a page says what to do, not how a home is called"
    for name, task in (("x", "1"), ("wah", "1000"), ("wah", "-1")):
        assert person.post("/play/new", data={"challenge": name, "task": task}).status_code == 400


def test_a_game_that_was_deleted_is_refused_with_a_code(server):
    from hearth.web.play import game_store
    from hearth.web.web_errors import WebError

    with pytest.raises(WebError) as found:
        server.store.read(lambda connection: game_store.stored(connection, "G0"))
    assert found.value.code == Code.UNKNOWN_ID


def test_seeds_of_games_stay_within_what_a_file_can_have(monkeypatch):
    from dataclasses import dataclass
    from types import SimpleNamespace

    from hearth.web.play import game_results

    @dataclass
    class Made:
        task: str
        seed: int
        helped: bool = False

    monkeypatch.setattr(game_results, "MOST_SEEDS", 3)
    task = tasks("wah", "test-1", limit=1)[0]
    game = SimpleNamespace(trial=SimpleNamespace(task=task, helper="none", goal=""), record=lambda: Made(task.id, 2))
    found = game_results.results([game] * 5)
    (one,) = found.values()
    assert [each.seed for each in one.records] == [0, 1, 2] and one.header.seeds == 3
