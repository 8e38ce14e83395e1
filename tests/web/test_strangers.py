"""Limits of a stranger with free sessions: no places of others, no judging of own text, no undoing of others' work."""

from __future__ import annotations

import json
import socket
import sqlite3
import time

import pytest
import sqlalchemy as sql
from web.people import Server
from web.playing import Player, begun, session_of
from web.test_annotate import RIGHT, STEPS, TEXT, accept, described, ids, reviewer, submitted, waiting
from web.test_study_room import JUDGE

from hearth.kb.loading.load import default
from hearth.web import sessions
from hearth.web.annotate.annotate_tables import PROGRAMS, REVIEWS, TEXTS
from hearth.web.annotate.collected_files import collected
from hearth.web.play import agent_program_port
from hearth.web.play.game_tables import GAMES, SEATS
from hearth.web.play.live_games import games
from hearth.web.play.play_trials import published
from hearth.web.store import embedded
from hearth.web.web_tables import SESSIONS

HTML = {"accept": "text/html"}


def test_a_link_asks_before_it_replaces_a_session(server, person):
    mine, link = person.cookies["hearth"], f"/come/{server.person().cookies['hearth']}"
    led = person.get(link)
    assert led.status_code == 303 and led.headers["location"] == "/come", "the token leaves the address bar"
    assert person.cookies["hearth"] == mine, "nothing is replaced by an address alone"
    page = person.get("/come", headers=HTML)
    assert (
        'method="post" action="/come"' in page.text and "replace" in page.text and link.split("/")[2] not in page.text
    )
    assert person.cookies["hearth"] == mine
    assert person.post("/come", headers={"origin": "http://evil.example"}).status_code == 403
    assert person.cookies["hearth"] == mine
    assert person.post("/come").status_code == 303 and person.cookies["hearth"] == link.split("/")[2]
    assert person.post("/come").status_code != 303, "a link is asked about once"


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_a_post_that_another_site_caused_changes_nothing(server, site):
    anyone = server.client()
    assert anyone.post("/begin", headers={"sec-fetch-site": site}).status_code == 403
    assert anyone.post("/begin", headers={"sec-fetch-site": "same-origin"}).status_code == 303


def test_the_link_comes_without_a_session_too_but_asks(server, person):
    other = server.client()
    assert other.get(f"/come/{person.cookies['hearth']}").headers["location"] == "/come"
    assert other.get("/mine").status_code == 401, "a page of another site puts nobody into its own session"
    assert other.post("/come").status_code == 303 and other.get("/mine").status_code == 200


def test_come_without_a_link_leads_to_the_start(server, person):
    assert person.get("/come").headers["location"] == "/"


def test_a_wrong_token_of_the_desk_leaves_the_address_bar(server):
    answer = server.client().get("/desk/enter/not-the-token-but-nearly-it")
    assert answer.status_code == 303 and "not-the-token" not in answer.headers["location"]
    assert "not the desk" in server.client().get(answer.headers["location"]).text


def test_a_second_session_does_not_accept_a_persons_own_text(server, person):
    text = described(person)
    submitted(person, text)
    second = server.person()
    second.post("/annotate/test", data=RIGHT)
    assert waiting(second) == [], "who passed the test still needs an invitation of the desk"
    program = server.store.scalar(sql.select(PROGRAMS.c.id))
    for path, data in ((f"/annotate/review/{program}", {"verdict": "accept"}),):
        assert second.post(path, data=data).json()["error"]["code"] == "NOT_ALLOWED"
    assert second.get(f"/annotate/review/{program}/work").json()["error"]["code"] == "NOT_ALLOWED"
    assert collected(server.store)["programs.csv"] == b""


def test_an_invitation_is_for_one_session_and_is_not_stored(server):
    desk = server.researcher()
    link = desk.post("/desk/annotate/invite").text.split('value="')[1].split('"')[0]
    address = link.partition("127.0.0.1")[2]
    first, second = server.person(), server.person()
    assert first.get(address).status_code == 200 and first.post(address).status_code == 303
    assert second.post(address).json()["error"]["code"] == "UNKNOWN_ID"
    assert first.post("/annotate/reviewer/x").json()["error"]["code"] == "UNKNOWN_ID"
    assert first.post("/desk/annotate/invite").status_code == 403
    assert (
        address.rpartition("/")[2]
        not in server.store.engine.raw_connection()
        .execute("SELECT group_concat(id) FROM annotate_reviewers")
        .fetchone()[0]
    )


def built_on(server):
    """A description of a first person, a program of a second, accepted by a third."""
    first, second, third = server.person(), server.person(), reviewer(server)
    text = described(first)
    submitted(second, text, STEPS)
    accept(third)
    return first, second, third, text


def rows(server, table):
    return server.store.rows(sql.select(table))


def test_withdrawal_keeps_what_others_built_without_the_person(server):
    first, second, _, text = built_on(server)
    who = session_of(server, first)
    files = collected(server.store)
    other_text = described(first)
    assert first.post("/mine/delete").status_code == 303
    assert first.get("/mine").status_code == 401
    assert rows(server, TEXTS)[0]["id"] == text and len(rows(server, TEXTS)) == 1, "what nobody used is gone"
    assert other_text not in ids(second)
    assert [row["state"] for row in rows(server, PROGRAMS)] == ["accepted"]
    assert collected(server.store)["programs.csv"] == files["programs.csv"]
    assert who not in collected(server.store)["descriptions.csv"].decode()
    assert who not in str([server.store.rows(sql.select(each)) for each in (SESSIONS, TEXTS, PROGRAMS, REVIEWS)])


def test_an_author_does_not_take_back_what_was_accepted_and_a_reviewer_leaves_no_words(server):
    _, second, third, _ = built_on(server)
    server.store.write(lambda connection: connection.execute(sql.update(PROGRAMS).values(note="words of mine")))
    who = session_of(server, second)
    second.post("/mine/delete")
    assert [row["state"] for row in rows(server, PROGRAMS)] == ["accepted"]
    assert who not in (server.out / "programs.csv").read_text()
    third.post("/mine/delete")
    assert rows(server, REVIEWS) == [] and "words of mine" not in str(rows(server, PROGRAMS))
    assert len(rows(server, PROGRAMS)) == 1


def test_who_kept_rows_are_nobodys_has_no_token(server):
    first, *_ = built_on(server)
    token = first.cookies["hearth"]
    first.post("/mine/delete")
    assert server.client(cookies={"hearth": token}).get("/mine").status_code == 401
    (kept,) = [row for row in rows(server, SESSIONS) if row["created"] == 0]
    for guess in (kept["id"], kept["token"], ""):
        assert server.client(cookies={"hearth": guess}).get("/mine").status_code == 401


def test_a_draft_of_another_person_is_not_deleted_with_its_description(server, person):
    text = described(person)
    second = server.person()
    second.post(f"/annotate/task/{text}/scene", data={"version": "1", "room living_room": "1"})
    person.post("/mine/delete")
    assert second.get(f"/annotate/task/{text}").status_code == 200
    assert [row["session"] for row in rows(server, PROGRAMS)] == [session_of(server, second)]


def test_the_desk_erases_what_was_kept(server):
    first, _, _, text = built_on(server)
    first.post("/mine/delete")
    assert first.post("/desk/annotate/erase", data={"id": text}).status_code == 403
    assert server.researcher().post("/desk/annotate/erase", data={"id": text}).status_code == 303
    assert rows(server, TEXTS) == rows(server, PROGRAMS) == [] and not (server.out / "programs.csv").exists()


def test_a_game_of_two_stays_for_the_other(server, person):
    second = server.person()
    game = begun(server, person, published("wah", "test-1", 0), "person")
    code = rows(server, GAMES)[0]["code"]
    assert second.post(f"/play/join/{code}").status_code == 303
    person.post("/mine/delete")
    assert second.get(f"/play/game/{game}").status_code == 200
    assert session_of(server, second) in str(rows(server, SEATS)) and len(rows(server, SEATS)) == 2
    second.post("/mine/delete")
    assert rows(server, GAMES) == [], "once nobody is left, it goes"


@pytest.fixture
def study(tmp_path, knowledge):
    path = tmp_path / "judging.yaml"
    path.write_text(JUDGE.replace("people: 2", "people: 4"))
    server = Server(tmp_path / "served", knowledge, study=path, hosts=("homes.example",))
    yield server
    server.store.close()


def joins(server, address, many):
    """Return the number of an address's new sessions that get a place."""
    found = 0
    for _ in range(many):
        client = server.client(client=(address, 5))
        client.base_url = "https://homes.example"
        client.post("/begin")
        found += client.post("/study/agree", data={"agree": "yes"}).status_code == 303
    return found


def test_one_address_does_not_take_all_places_of_a_study(study):
    assert joins(study, "10.0.0.7", 6) == 2
    assert joins(study, "10.0.0.8", 1) == 1, "there is a place for another"


def test_an_address_counts_once_however_it_is_written(study):
    assert joins(study, "203.0.113.5", 2) == 2
    for spelling in ("::ffff:203.0.113.5", "::FFFF:cb00:7105", "0:0:0:0:0:ffff:203.0.113.5"):
        assert joins(study, spelling, 1) == 0, spelling


def test_a_network_of_ipv6_is_one_address(study):
    assert sum(joins(study, f"2001:db8::{n}", 1) for n in range(1, 6)) == 2
    assert joins(study, "2001:db8:0:1::1", 1) == 1


@pytest.mark.parametrize("none", ["203.0.113.005", '"203.0.113.5"', "203.0.113.5:8080", "me"])
def test_what_is_no_address_is_refused(server, none):
    answer = server.client(client=(none, 5)).post("/begin")
    assert answer.status_code == 400 and answer.json()["error"]["code"] == "BAD_ARGUMENT"


def test_a_post_of_a_session_that_was_deleted_meanwhile_is_refused_with_a_code(server, person, monkeypatch):
    found = sessions.find

    def raced(store, token):
        session = found(store, token)
        if session is not None:
            sessions.forget(store, session.id)
        return session

    monkeypatch.setattr(sessions, "find", raced)
    answer = person.post("/annotate/describe", data=TEXT)
    assert (answer.status_code, answer.json()["error"]["code"]) == (401, "NO_SESSION"), answer.text


def test_a_page_has_no_control_characters_of_a_text(server, person):
    text = described(person, title="Mi\x1b[31mlk \u202eevil\u0085")
    page = person.get(f"/annotate/task/{text}", headers=HTML).text
    assert "lk evil" in page and not set(page) & set("\x1b\u202e\u0085")


def program_of(server, person):
    game = begun(server, person, published("wah", "test-1", 0), "program")
    player = Player(person, game)
    return game, player


def answer_on(connection, line: bytes, wait: float = 4.0) -> bytes:
    """Return the answer on a port of a game."""
    connection.settimeout(wait)
    try:
        connection.sendall(line)
        return connection.recv(65_536)
    except OSError:
        return b""


def test_a_program_needs_the_token_of_its_game(server, person):
    _, player = program_of(server, person)
    with player:
        port, token = player.state["port"], player.state["token"]
        for line in (b"", b"\n", b'{"token": "x"}\n', b'{"token": 1}\n', b"[]\n", b"x" * 70_000 + b"\n"):
            with socket.create_connection(("127.0.0.1", port)) as stranger:
                stranger.sendall(line)
                time.sleep(0.1)
                state = player.act("[Turnleft]")
                assert state["type"] == "tick"
                assert b"observe" not in answer_on(stranger, b"", 0.5)
        with socket.create_connection(("127.0.0.1", port)) as mine:
            mine.sendall(json.dumps({"token": token}).encode() + b"\n")
            time.sleep(0.5)
            act = {"type": "act", "tick": player.state["tick"], "act": None, "n": player.n + 1}
            player.socket.send_text(json.dumps(act))
            mine.settimeout(10)
            assert b"begin" in mine.recv(100)


def test_silent_connections_do_not_keep_a_program_out(server, person):
    _, player = program_of(server, person)
    with player:
        silent = [socket.create_connection(("127.0.0.1", player.state["port"])) for _ in range(6)]
        with socket.create_connection(("127.0.0.1", player.state["port"])) as mine:
            mine.sendall(json.dumps({"token": player.state["token"]}).encode() + b"\n")
            until = time.monotonic() + 4
            live = games(server.store, default()).open(player.game)
            while live._program is None and time.monotonic() < until:
                time.sleep(0.05)
            assert live._program is not None
        for each in silent:
            each.close()


def closed(port: int, within: float) -> bool:
    until = time.monotonic() + within
    while time.monotonic() < until:
        try:
            socket.create_connection(("127.0.0.1", port), timeout=1).close()
        except OSError:
            return True
        time.sleep(0.3)
    return False


def test_the_port_of_a_game_closes_when_it_was_finished(server, person):
    _, player = program_of(server, person)
    with player:
        port = player.state["port"]
        player.ask({"type": "finish"})
        assert closed(port, 5)


def test_the_port_of_a_game_closes_when_its_session_is_deleted(server, person):
    _, player = program_of(server, person)
    with player:
        port = player.state["port"]
        person.post("/mine/delete")
        assert closed(port, 6)


def test_the_port_of_a_game_closes_when_its_time_is_over(server, person, monkeypatch):
    game = begun(server, person, published("wah", "test-1", 0), "program")
    with Player(person, game) as player:
        port = player.state["port"]
    live = games(server.store, default()).open(game)
    monkeypatch.setattr(type(live.stored), "deadline", property(lambda self: time.time() - 1))
    assert closed(port, 6)


def test_the_port_of_a_game_closes_when_no_page_of_it_is_open(server, person, monkeypatch):
    monkeypatch.setattr(agent_program_port, "UNWATCHED", 1.0, raising=False)
    game = begun(server, person, published("wah", "test-1", 0), "program")
    with Player(person, game) as player:
        port = player.state["port"]
    assert closed(port, 8)


def test_a_server_opens_few_ports(server, person, monkeypatch):
    monkeypatch.setattr(agent_program_port, "MOST_PORTS", 2, raising=False)
    players = [Player(person, begun(server, person, published("wah", "test-1", n), "program")) for n in range(3)]
    ports = []
    for each in players:
        with each:
            ports.append(each.state["port"])
    assert ports[0] and ports[1] and ports[2] == 0


def in_files(out, words: str) -> list[str]:
    """The files of a server's folder that have some words."""
    return [path.name for path in out.rglob("*") if path.is_file() and words.encode() in path.read_bytes()]


def test_withdrawn_text_is_in_no_file_of_the_store_at_once(server, person):
    words = "quite unmistakable words of a person who leaves"
    for number in range(60):
        text = {**TEXT, "title": f"Tea {number}", "description": f"{TEXT['description']} {words} {number}. " * 5}
        assert person.post("/annotate/describe", data=text).status_code == 303
    assert in_files(server.out, words)
    person.post("/mine/delete")
    assert in_files(server.out, words) == []
    assert sqlite3.connect(embedded(server.out)).execute("PRAGMA integrity_check").fetchone() == ("ok",)


def test_an_older_version_of_a_draft_is_in_no_file_either(server, person):
    text = described(person)
    person.post(f"/annotate/task/{text}/scene", data={"room living_room": "1", "thing sofa": "1"})
    work = person.get(f"/annotate/task/{text}/work").json()
    for number, said in enumerate(("first secret words", "later words")):
        sent = {"version": work["version"] + number, "steps": [{"special": said}]}
        assert person.post(f"/annotate/task/{text}/save", json=sent).status_code == 200
    person.post("/mine/delete")
    assert in_files(server.out, "first secret words") == [] and in_files(server.out, "later words") == []


def test_a_reader_delays_the_erasure_and_does_not_stop_it(server, person):
    words = "words that a reader still sees"
    person.post("/annotate/describe", data={**TEXT, "description": f"{TEXT['description']} {words}."})
    reading = sqlite3.connect(embedded(server.out), isolation_level=None)
    reading.execute("BEGIN")
    reading.execute("SELECT count(*) FROM annotate_texts").fetchone()
    assert person.post("/mine/delete").status_code == 303
    reading.close()
    until = time.monotonic() + 8
    while in_files(server.out, words) and time.monotonic() < until:
        time.sleep(0.2)
    assert in_files(server.out, words) == []


def test_what_the_desk_deletes_is_erased_from_the_files(server):
    *_, text = built_on(server)
    words = server.store.scalar(sql.select(TEXTS.c.description))
    server.researcher().post("/desk/annotate/erase", data={"id": text})
    assert in_files(server.out, words) == []


def test_the_page_on_privacy_is_served_and_linked(server, person):
    page = server.client().get("/privacy")
    assert page.status_code == 200 and all(word in page.text for word in ("stored", "how long", "erase", "address"))
    for path in ("/", "/mine"):
        assert 'href="/privacy"' in person.get(path).text
