"""The waiting room of Play: a person who comes alone is paired with the next, or plays with a helper."""

from __future__ import annotations

import time

import pytest
from web.playing import Player

from hearth.kb.loading.load import default
from hearth.web.play.live_games import games


def look(client):
    return client.post("/play/pair/look").json()


def game_of(found):
    return found["go"].rpartition("/")[2]


def trial_of(server, game):
    return games(server.store, default()).open(game).stored.trial


def test_two_who_come_are_paired_in_one_game_and_play_it(server, person):
    other = server.person()
    assert look(person)["waited"] == 0
    paired = look(other)
    assert look(person) == paired
    with Player(person, game_of(paired)) as first, Player(other, game_of(paired)) as second:
        assert (first.state["me"], second.state["me"], first.state["code"]) == (0, 1, "")
        while first.state["other"] == "awaited":
            first.receive()
        assert first.act("[Turnleft]")["decided"] == [0]
        second.act("[Turnright]")
    assert look(person) == {"waited": 0, "patience": 60}  # who has gone to the game waits for another


def test_of_three_the_first_two_are_paired_and_each_pair_has_the_next_task(server):
    people = [server.person() for _ in range(4)]
    found = [look(each) for each in people]
    assert "go" in found[1] and "go" in found[3] and found[1] != found[3]
    assert found[2] == {"waited": 0, "patience": 60}
    tasks = {trial_of(server, game_of(found[number])).task.id for number in (1, 3)}
    assert len(tasks) == 2


def test_who_has_gone_is_paired_with_nobody_and_waits_anew(server, person, monkeypatch):
    monkeypatch.setattr("hearth.web.play.waiting_room.GONE_AFTER", 0.2)
    look(person)
    time.sleep(0.4)
    other = server.person()
    assert "go" not in look(other)
    assert "go" in look(person)


@pytest.mark.parametrize("paired", [False, True])
def test_the_stand_in_takes_the_place_of_a_person_unless_one_has_come(server, person, paired):
    look(person)
    found = look(server.person()) if paired else None
    where = person.post("/play/pair/stand-in").headers["location"]
    assert trial_of(server, where.rpartition("/")[2]).helper == ("person" if paired else "hp")
    if found:
        assert where == found["go"]
    assert "go" not in look(server.person())


def test_who_stops_waiting_is_paired_with_nobody(server, person):
    look(person)
    assert person.post("/play/pair/stop").headers["location"] == "/play/"
    assert "go" not in look(server.person())


def test_a_session_that_is_deleted_waits_no_longer(server, person):
    look(person)
    assert person.post("/mine/delete").status_code == 303
    assert "go" not in look(server.person())
