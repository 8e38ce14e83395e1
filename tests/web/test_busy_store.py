"""A store that is locked, full or of another version: said soon and in words, while everything else goes on."""

from __future__ import annotations

import json
import sqlite3
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from http.client import HTTPConnection
from urllib.parse import urlencode, urlsplit

import httpx2 as httpx
import pytest
import sqlalchemy as sql
from web.people import Server
from web.playing import Player, begun
from web.test_annotate import TEXT
from web.test_web_store import postgres  # noqa: F401

from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.web.play.play_trials import published
from hearth.web.store import Store, default_url, embedded

SOON = 3.0
"""Seconds within which a busy server says so: two, and one for a busy machine."""

LOCKS = {
    "a writer": ("BEGIN IMMEDIATE",),
    "a writer that has written": ("BEGIN IMMEDIATE", "INSERT INTO sessions VALUES ('a', 'b', 0, '')"),
    "alone": ("PRAGMA locking_mode = EXCLUSIVE", "BEGIN EXCLUSIVE", "DELETE FROM sessions WHERE id = 'nobody'"),
}
"""Ways to hold a lock on the file."""


def held(path, statements):
    """A connection that holds a lock on the store."""
    made = sqlite3.connect(path, isolation_level=None, timeout=5)
    for each in statements:
        made.execute(each)
    return made


def timed(ask, *given, **options):
    since = time.monotonic()
    answer = ask(*given, **options)
    return time.monotonic() - since, answer


BODY = urlencode(TEXT).encode()


def ask(address, method, path, headers, body):
    """The status of an answer, when to come again, and the code of a fault; a connection of its own, without TLS."""
    connection = HTTPConnection(urlsplit(address).netloc, timeout=30)
    connection.request(method, path, body, headers)
    answer = connection.getresponse()
    data = answer.read()
    connection.close()
    code = json.loads(data)["error"]["code"] if answer.status == 503 else None
    return answer.status, answer.headers["Retry-After"], code


@pytest.mark.parametrize("lock", ["a writer", "a writer that has written"])
def test_a_lock_on_the_store_does_not_freeze_the_server(served, lock):
    person = httpx.Client(base_url=served.address)
    if person.post("/begin").status_code != 303:
        pytest.fail("no session")
    cookie, holder = {"Cookie": f"hearth={person.cookies['hearth']}"}, held(embedded(served.out), LOCKS[lock])
    form = {**cookie, "Content-Type": "application/x-www-form-urlencoded"}
    try:
        with ThreadPoolExecutor(60) as many:
            since = time.monotonic()
            asked = [many.submit(ask, served.address, "POST", "/annotate/describe", form, BODY) for _ in range(60)]
            while not all(each.done() for each in asked):
                assert ask(served.address, "GET", "/static/style.css", {}, b"")[:2] == (200, None)
                time.sleep(0.1)
            all_within = time.monotonic() - since
    finally:
        holder.close()
    assert {each.result() for each in asked} == {(503, "2", "TIMED_OUT")}
    assert all_within < SOON, "sixty at once"
    assert ask(served.address, "POST", "/annotate/describe", form, BODY)[0] == 303, "it goes on once the lock is gone"


def test_a_lock_that_lets_nobody_read_is_said_too(server, person):
    server.store.engine.dispose()
    holder = held(embedded(server.out), LOCKS["alone"])
    seconds, answer = timed(person.get, "/mine")
    holder.close()
    assert answer.status_code == 503 and seconds < SOON and "busy" in answer.text
    assert person.get("/mine").status_code == 200


def test_a_thread_that_holds_the_turn_does_not_hold_others_up(server, person):
    with ThreadPoolExecutor(1) as other:
        free = threading.Event()
        other.submit(server.store.write, lambda connection: free.wait(20))
        time.sleep(0.3)
        seconds, answer = timed(person.post, "/annotate/describe", data=TEXT)
        free.set()
    assert answer.status_code == 503 and seconds < SOON


def test_a_person_is_told_in_words_that_the_server_is_busy(server, person):
    holder = held(embedded(server.out), LOCKS["a writer"])
    page = person.post("/annotate/describe", data=TEXT, headers={"accept": "text/html"})
    holder.close()
    assert page.status_code == 503 and "busy" in page.text and "moment" in page.text and "TIMED_OUT" not in page.text


def test_a_game_says_that_the_store_is_busy_and_goes_on(server, person):
    game = begun(server, person, published("wah", "test-1", 0))
    with Player(person, game) as player:
        holder = held(embedded(server.out), LOCKS["a writer"])
        since = time.monotonic()
        refused = player.act("[Turnleft]")
        assert refused["error"]["code"] == "TIMED_OUT" and time.monotonic() - since < 2 * SOON
        holder.close()
        assert player.act("[Turnleft]")["type"] == "tick"


def test_a_handler_that_does_not_end_is_left_alone(server, monkeypatch):
    free = threading.Event()
    monkeypatch.setattr("hearth.web.application.WITHIN", 0.5)
    monkeypatch.setattr("hearth.web.start_pages.missing", lambda: free.wait(20) and [])
    made = Server(server.out, default())
    seconds, answer = timed(made.client().get, "/")
    free.set()
    made.store.close()
    assert answer.status_code == 503 and seconds < 4


def test_more_requests_than_can_wait_are_refused_at_once():
    import asyncio

    from hearth.web.handler_threads import Threads

    async def ask():
        threads, free = Threads(2, 3), threading.Event()
        asked = [asyncio.create_task(threads.run(free.wait, 20)) for _ in range(5)]
        await asyncio.sleep(0.1)
        since = time.monotonic()
        with pytest.raises(HearthError, match="busy"):
            await threads.run(int)
        assert time.monotonic() - since < 0.2
        free.set()
        assert await asyncio.gather(*asked) == [True] * 5

    asyncio.run(ask())


def test_a_full_disk_is_said_in_words(serving):
    server = serving(limits="ulimit -f 600")
    person = httpx.Client(base_url=server.address)
    person.post("/begin")
    for number in range(400):
        text = {**TEXT, "description": TEXT["description"] + " And again." * 150, "title": f"Make tea {number}"}
        answer = person.post("/annotate/describe", data=text)
        if answer.status_code != 303:
            break
    assert answer.status_code == 503 and answer.json()["error"]["code"] == "UNWRITABLE", answer.text
    assert "disk" in answer.text and "Traceback" not in server.log.read_text()
    assert person.get("/static/style.css").status_code == 200


def test_a_store_that_lacks_a_column_is_not_served(tmp_path, knowledge):
    url = default_url(tmp_path)
    Store(url).close()
    with sqlite3.connect(embedded(tmp_path)) as file:
        file.execute("ALTER TABLE sessions DROP COLUMN tab")
    with pytest.raises(HearthError, match="`sessions` lacks `tab`"):
        Store(url)


@pytest.mark.parametrize("change", ["DROP TABLE annotate_texts", "ALTER TABLE annotate_texts DROP COLUMN title"])
def test_a_table_or_column_that_goes_while_it_serves_is_said_in_words(server, person, change):
    with sqlite3.connect(embedded(server.out)) as file:
        file.execute("PRAGMA foreign_keys = OFF")
        file.execute(change)
    answer = person.get("/annotate/tasks")
    assert answer.status_code == 500 and answer.json()["error"]["code"] == "DAMAGED_FILE"
    assert "lacks" in answer.text


def test_a_fault_of_the_database_names_no_value(server, person, caplog):
    secret = "my-own-words-of-nobody-else"
    query = sql.text("INSERT INTO sessions (id, token, created) VALUES (:a, NULL, 0)")
    with pytest.raises(sql.exc.IntegrityError) as refused:
        server.store.write(lambda connection: connection.execute(query, {"a": secret}))
    assert secret not in str(refused.value)
    with sqlite3.connect(embedded(server.out)) as file:
        file.execute("ALTER TABLE annotate_texts ADD COLUMN more TEXT CHECK (more IS NOT NULL)")
        file.execute("CREATE UNIQUE INDEX one ON annotate_texts (scene, session)")
    for number in range(20):
        text = {**TEXT, "title": f"{secret} {number}"}
        answer = person.post("/annotate/describe", data=text)
        if answer.status_code != 303:
            break
    assert answer.status_code == 500 and secret not in answer.text and secret not in caplog.text


@pytest.mark.tools
def test_a_lock_in_postgres_does_not_freeze_the_server(postgres, tmp_path, knowledge):  # noqa: F811
    server = Server(tmp_path / "served", knowledge, postgres)
    person = server.person()
    with server.store.engine.connect() as holder, holder.begin():
        holder.exec_driver_sql("LOCK TABLE annotate_texts IN ACCESS EXCLUSIVE MODE")
        seconds, answer = timed(person.post, "/annotate/describe", data=TEXT)
        assert answer.status_code == 503 and seconds < SOON and "busy" in answer.text
    assert person.post("/annotate/describe", data=TEXT).status_code == 303
    server.store.close()


@pytest.mark.tools
def test_postgres_without_a_free_connection_is_said(postgres, tmp_path, knowledge):  # noqa: F811
    server = Server(tmp_path / "served", knowledge, postgres)
    person = server.person()
    taken = [server.store.engine.connect() for _ in range(20)]
    seconds, answer = timed(person.get, "/mine")
    for each in taken:
        each.close()
    assert answer.status_code == 503 and seconds < SOON
    assert person.get("/mine").status_code == 200
    shown = server.store.scalar(sql.text("SELECT current_setting('statement_timeout')"))
    assert shown == "30s"
    server.store.close()
