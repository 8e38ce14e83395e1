"""Games of two people: nobody acts alone, and nobody waits for a person that has left."""

from __future__ import annotations

import time

import pytest
from web.playing import Player, begun
from web.test_play import TASK, TURN

from hearth.kb.loading.load import default
from hearth.web.play.live_games import games


def test_two_people_in_one_home(server, person):
    game = begun(server, person, TASK, "person")
    code = games(server.store, default()).open(game).stored.code
    other, third = server.person(), server.person()
    assert other.post("/play/join/nothing").status_code == 404
    assert other.post(f"/play/join/{code}").headers["location"] == f"/play/game/{game}"
    assert third.post(f"/play/join/{code}").status_code == 409
    with Player(person, game, "a") as main, Player(other, game, "b") as helper:
        assert (main.state["me"], helper.state["me"], helper.state["code"]) == (0, 1, "")
        assert main.act(TURN)["decided"] == [0]
        assert main.act(TURN)["error"]["code"] == "OUT_OF_ORDER"
        helper.act("[Turnright]")
        while helper.state["tick"] < 1:
            helper.receive()
        while main.state["tick"] < 1:
            main.receive()
    assert games(server.store, default()).open(game).game.texts == [("Turnleft", "Turnright")]


@pytest.fixture
def for_two(server, person):
    """A game for two people that both may play; and the second."""
    game, other = begun(server, person, TASK, "person"), server.person()
    other.post(f"/play/join/{games(server.store, default()).open(game).stored.code}")
    return game, other


def test_nobody_acts_before_the_other_is_there(server, person, for_two):
    """The page says so, and nothing is kept; once the other has come, it says that, and acts."""
    game, other = for_two
    with Player(person, game) as player:
        assert player.state["other"] == "awaited"
        assert player.act(TURN)["error"]["code"] == "NOT_ALLOWED"
        assert games(server.store, default()).open(game).decided == ()
        with Player(other, game) as second:
            assert second.state["other"] == "here"
            while player.state["other"] == "awaited":
                player.receive()
            assert player.act(TURN)["decided"] == [0]


def test_who_keeps_the_other_waiting_waits(server, person, for_two, monkeypatch):
    monkeypatch.setattr("hearth.web.play.live_games.PATIENCE", 0.0)
    game, other = for_two
    with Player(other, game), Player(person, game) as player:
        player.act(TURN)
        while player.state["tick"] < 1:
            player.receive()
    assert games(server.store, default()).open(game).game.texts == [("Turnleft", None)]


def test_who_has_left_keeps_nobody_waiting(server, person, for_two, monkeypatch):
    monkeypatch.setattr("hearth.web.play.player_presence.GONE_AFTER", 1.5)
    game, other = for_two
    with Player(person, game) as player:
        with Player(other, game):
            pass
        while player.state["other"] != "gone":
            player.receive()
        since = time.monotonic()
        for tick in range(5):
            player.act(TURN)
            assert player.state["tick"] == tick + 1
        assert time.monotonic() - since < 5
        with Player(other, game) as again:
            assert again.state["tick"] == 5
            while player.state["other"] != "here":
                player.receive()
    assert games(server.store, default()).open(game).game.texts == [("Turnleft", None)] * 5
