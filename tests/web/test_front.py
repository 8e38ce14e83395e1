"""The start page, sessions, the desk's door; headers and faults of every answer."""

from __future__ import annotations

import pytest
import sqlalchemy as sql
from web.people import DESK, Server

from hearth.web import desk_access, sessions
from hearth.web.limits import Rate, usual_rates
from hearth.web.messages import Inbox, json_object
from hearth.web.security import HEADERS, own_address
from hearth.web.web_errors import WebError
from hearth.web.web_tables import SESSIONS

HTML = {"accept": "text/html"}


@pytest.mark.parametrize("method", ["GET", "HEAD", "POST", "PUT"])
@pytest.mark.parametrize("path", ["/", "/mine", "/desk", "/nowhere", "/static/style.css", "/static/../app.py", "/%00"])
def test_every_answer_has_the_policy(server, method, path):
    for accept in ("text/html", "application/json"):
        answer = server.client().request(method, path, headers={"accept": accept})
        assert {name: answer.headers[name] for name in HEADERS} == HEADERS
        assert "unsafe" not in HEADERS["Content-Security-Policy"]


def test_by_its_public_name_browsers_are_told_to_come_by_https(tmp_path, knowledge):
    server = Server(tmp_path / "served", knowledge, hosts=("homes.example",))
    name = "Strict-Transport-Security"
    assert "max-age" in server.client(headers={"host": "homes.example"}).get("/static/style.css").headers[name]
    assert name not in server.client().get("/static/style.css").headers
    server.store.close()


def test_a_fault_of_ours_has_the_policy_and_says_nothing_of_the_inside(server, monkeypatch):
    monkeypatch.setattr("hearth.web.start_pages.missing", lambda: 1 / 0)
    answer = server.client(raise_server_exceptions=False).get("/")
    assert answer.status_code == 500
    assert answer.json()["error"]["code"] == "INTERNAL_ERROR" and "division" not in answer.text
    assert answer.headers["Content-Security-Policy"] == HEADERS["Content-Security-Policy"]


def test_the_start_page_says_what_lacks(server, monkeypatch):
    monkeypatch.setattr("hearth.web.start_pages.missing", lambda: ["blockly"])
    page = server.client().get("/").text
    assert "blockly" in page and "make web" in page
    monkeypatch.setattr("hearth.web.start_pages.missing", list)
    assert "make web" not in server.client().get("/").text


def test_scripts_that_were_not_fetched_are_not_found(tmp_path, knowledge, monkeypatch):
    monkeypatch.setattr("hearth.web.application.FETCHED", tmp_path / "nowhere")
    server = Server(tmp_path / "served", knowledge)
    assert server.client().get("/fetched/three/build/three.module.js").status_code == 404
    server.store.close()


def test_nothing_of_a_person_is_reachable_without_a_token(server):
    for client in (server.client(), server.client(cookies={"hearth": "x" * 43}), server.client(cookies={"hearth": ""})):
        assert client.get("/mine").json()["error"]["code"] == "NO_SESSION"
        page = client.get("/mine", headers=HTML)
        lost = bool(client.cookies.get("hearth"))
        assert page.status_code == (401 if lost else 200), "a newcomer has done nothing wrong"
        assert "Begin a session" in page.text and "Your link" not in page.text
        assert ("not known here any more" in page.text) is lost
        assert client.post("/mine/delete", headers=HTML).status_code == 401


def test_a_session_begins_returns_by_its_link_and_is_deleted(server):
    person = server.client()
    begun = person.post("/begin", data={"to": "/mine"})
    assert begun.headers["location"] == "/mine"
    cookie = begun.headers["set-cookie"].lower()
    assert "httponly" in cookie and "samesite=lax" in cookie
    link = f"/come/{person.cookies['hearth']}"
    assert link in person.get("/mine").text
    other = server.client()
    assert other.get(link).headers["location"] == "/come" and other.get("/mine").status_code == 401
    assert other.post("/come").status_code == 303 and other.get("/mine").status_code == 200
    assert other.post("/mine/delete").status_code == 303
    assert person.get("/mine").status_code == 401 and server.client().get(link).status_code == 401


def test_a_link_that_is_not_known_says_so_and_begins_nothing(server, person):
    before = person.cookies["hearth"]
    for client, words in ((server.client(), "a new session, without"), (person, "another session")):
        answer = client.get("/come/not-a-link", headers=HTML)
        assert answer.status_code == 401 and "link is not known" in answer.text and words in answer.text
        assert 'action="/begin"' not in answer.text and "NO_SESSION" not in answer.text
    assert person.cookies["hearth"] == before


def test_the_store_has_no_token(server, person):
    token = person.cookies["hearth"]
    rows = server.store.read(lambda connection: connection.execute(sql.select(SESSIONS)).all())
    assert token not in str(rows) and sessions.digest(token) in str(rows)


@pytest.mark.parametrize(
    ("wanted", "goes"),
    [
        ("/mine", "/mine"),
        ("https://bad", "/"),
        ("//bad", "/"),
        ("/\\bad", "/"),
        ("", "/"),
        ("/a\r\nb", "/"),
        ("/é", "/"),
    ],
)
def test_one_is_sent_to_addresses_of_this_server_alone(wanted, goes):
    assert own_address(wanted) == goes


def test_the_desk_needs_its_token(server, person):
    assert person.get("/desk").json()["error"]["code"] == "NOT_ALLOWED"
    assert person.post("/desk/enter", data={"token": "wrong"}).status_code == 403
    entered = person.post("/desk/enter", data={"token": DESK})
    assert "samesite=strict" in entered.headers["set-cookie"].lower()
    assert person.get("/desk").status_code == 200
    assert server.client().get(f"/desk/enter/{DESK}").headers["location"] == "/desk"


@pytest.mark.parametrize(
    ("headers", "allowed"),
    [({}, True), ({"origin": "http://127.0.0.1"}, True), ({"origin": "http://evil.example"}, False),
     ({"origin": "https://127.0.0.1"}, False), ({"origin": "http://127.0.0.1:81"}, False), ({"origin": ""}, False),
     ({"origin": "null"}, False), ({"host": "evil.example"}, False), ({"host": "127.0.0.1.evil.example"}, False)],
)  # fmt: skip
def test_pages_of_other_servers_change_nothing(server, headers, allowed):
    answer = server.client().post("/begin", headers=headers)
    assert (answer.status_code == 303) is allowed
    assert allowed or answer.json()["error"]["code"] == "NOT_ALLOWED"


def test_bodies_and_rates_have_limits(server, tmp_path, knowledge):
    answer = server.client().post("/begin", content=b"x" * 300_000)
    assert answer.status_code == 413 and answer.json()["error"]["code"] == "FILE_TOO_LARGE"
    for form in ({f"f{n}": "1" for n in range(3_000)}, {"to": "/", **{f"f{n}": "" for n in range(2_500)}}):
        answer = server.client().post("/begin", data=form)
        assert answer.status_code == 400 and answer.json()["error"]["place"] == "form"
    clock = [0.0]
    rate = Rate(each_second=2, burst=3, now=lambda: clock[0])
    assert [rate.allows("a") for _ in range(5)] == [True, True, True, False, False]
    assert rate.allows("b")
    clock[0] = 1.0
    assert [rate.allows("a") for _ in range(3)] == [True, True, False]


def test_messages_are_numbered_and_a_refused_one_does_not_count():
    inbox = Inbox()
    for raw, code in (
        (b'{"type": "act", "n": 2}', "OUT_OF_ORDER"), (b'{"type": "act", "n": true}', "OUT_OF_ORDER"),
        (b'{"type": "act", "n": 1.0}', "OUT_OF_ORDER"),
        (b"[]", "BAD_JSON"), (b"\xff", "BAD_JSON"), (b"{}", "BAD_ARGUMENT"), (b" " * 70_000, "FILE_TOO_LARGE"),
    ):  # fmt: skip
        with pytest.raises(WebError) as refused:
            inbox.take(raw)
        assert refused.value.code == code
    assert inbox.take('{"type": "act", "n": 1}')["type"] == "act"
    assert inbox.take('{"type": "act", "n": 2}')["n"] == 2


def test_two_tabs_of_a_session_cannot_both_act(server, person):
    session = sessions.find(server.store, person.cookies["hearth"])
    sessions.take_tab(server.store, session.id, "first")
    sessions.take_tab(server.store, session.id, "second")
    server.store.write(lambda connection: sessions.check_tab(connection, session.id, "second"))
    with pytest.raises(WebError, match="LOCKED"):
        server.store.write(lambda connection: sessions.check_tab(connection, session.id, "first"))


@pytest.mark.parametrize("host", ["[::1", "a]", "[x]:80", "\x00", "@"])
def test_a_host_that_is_none_is_refused(server, host):
    answer = server.client(raise_server_exceptions=False).get("/", headers={"host": host})
    assert answer.status_code in (400, 403) and answer.headers["Content-Security-Policy"]


def test_tokens_that_are_made_up_share_one_limit(tmp_path, knowledge):
    server = Server(tmp_path, knowledge, rates={**usual_rates(), "request": Rate(0.01, 5)})
    codes = [server.client(cookies={"hearth": f"fake-{n}"}).get("/").status_code for n in range(8)]
    assert codes.count(429) == 3
    server.store.close()


def test_a_text_with_nul_is_refused(server):
    person = server.person()
    given = {"title": "Make tea\0", "description": "x " * 30, "scene": "kitchen"}
    answer = person.post("/annotate/describe", data=given)
    assert answer.json()["error"]["code"] == "BAD_ARGUMENT"


@pytest.mark.parametrize(
    ("raw", "refused"), [(b'{"a": "x\\u0000"}', True), (b'{"a": "x\\\\u0000"}', False), (b'{"a": "x"}', False)]
)
def test_nul_in_json_is_refused_and_its_spelling_is_not(raw, refused):
    if refused:
        with pytest.raises(WebError):
            json_object(raw, "body")
    else:
        assert json_object(raw, "body")["a"].startswith("x")


def test_the_desk_has_a_token_whatever_the_file_had(tmp_path, monkeypatch):
    monkeypatch.delenv(desk_access.VARIABLE, raising=False)
    token = desk_access.desk_token(tmp_path)
    assert len(token) > desk_access.SHORTEST and desk_access.desk_token(tmp_path) == token
    file = next(tmp_path.rglob("desk-token"))
    assert file.stat().st_mode & 0o777 == 0o600 and [*file.parent.glob("*desk-token*")] == [file]
    file.write_text("")  # killed while it was written, by an earlier version
    assert len(desk_access.desk_token(tmp_path)) > desk_access.SHORTEST
