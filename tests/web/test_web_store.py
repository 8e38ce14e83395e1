"""The store: what it accepted survives a kill; SQLite and PostgreSQL; hostile messages."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import tempfile
import threading
import time
from pathlib import Path

import httpx2 as httpx
import orjson
import pytest
import sqlalchemy as sql
from web.people import Server
from web.test_annotate import STEPS, TEXT, accept, described, ids, reviewer, scene, submitted, waiting

from hearth.schemas.diagnostics import HearthError
from hearth.web.annotate import collected_files
from hearth.web.annotate.annotate_tables import TEXTS
from hearth.web.annotate.program_draft import Draft, read_blocks, stored
from hearth.web.limits import Rate
from hearth.web.messages import Inbox
from hearth.web.store import Store, default_url
from hearth.web.web_errors import WebError
from hearth.web.web_tables import SESSIONS


@pytest.mark.parametrize("url", ["mysql://x/y", "no address", "sqlite:////nowhere/at/all.sqlite"])
def test_a_store_that_cannot_be_opened_is_refused(url):
    with pytest.raises(HearthError):
        Store(url)


def test_writers_in_parallel_lose_nothing(tmp_path):
    in_parallel(default_url(tmp_path))


def in_parallel(url: str) -> None:
    """Ten threads at two stores of one database read a number and write one more."""
    stores = [Store(url), Store(url)]
    row = {"id": "one", "token": "t", "created": 0.0, "tab": "0"}
    stores[0].write(lambda connection: connection.execute(sql.insert(SESSIONS).values(row)))

    def count(store: Store) -> None:
        def one_more(connection: sql.Connection) -> None:
            now = int(connection.execute(sql.select(SESSIONS.c.tab)).scalar_one())
            connection.execute(sql.update(SESSIONS).values(tab=str(now + 1)))

        for _ in range(5):
            store.write(one_more)

    threads = [threading.Thread(target=count, args=(stores[number % 2],)) for number in range(10)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert stores[0].scalar(sql.select(SESSIONS.c.tab)) == "50"
    for store in stores:
        store.close()


VALUES = (None, True, 7, -1, 1e308, "x", "\x00", "[Walk] <x> (1)", [], {}, [[]], {"action": "Walk"}, ["sofa", 1],
          {"special": "a" * 500}, {"action": "Grab", "things": [["sofa", 1]]}, "<script>", {"things": {}})  # fmt: skip


def malformed(randomly) -> list:
    """Steps of which at least one is none, or none at all."""
    some = [randomly.choice(VALUES) for _ in range(randomly.randint(1, 4))]
    return randomly.choice([randomly.choice(VALUES[:8]), [*some, None]])


def test_ten_thousand_malformed_programs_are_refused_with_a_code(knowledge):
    randomly, draft = random.Random(0), Draft({"living_room": 1}, {"sofa": 1})
    for _ in range(10_000):
        with pytest.raises(WebError) as refused:
            read_blocks(malformed(randomly), draft, knowledge)
        assert refused.value.as_json()["error"]["code"] and refused.value.status == 400


def test_ten_thousand_malformed_messages_are_refused_with_a_code():
    randomly, inbox = random.Random(0), Inbox(Rate(10**6, 10**6))
    for _ in range(10_000):
        message = {name: randomly.choice(VALUES) for name in ("type", "n", "action") if randomly.random() < 0.9}
        raw = randomly.choice([orjson.dumps(message), randomly.randbytes(randomly.randint(0, 60))])
        if message.get("n") is not True and message.get("n") != 1:
            with pytest.raises(WebError):
                inbox.take(raw)
    assert inbox.last == 0


def test_malformed_requests_change_nothing(server, person):
    text = described(person)
    scene(person, text)
    before, randomly = person.get(f"/annotate/task/{text}/work").json(), random.Random(0)
    for number in range(90):
        body = {"version": randomly.choice(VALUES), "steps": malformed(randomly), "home": randomly.choice(VALUES)}
        path = ("save", "submit", "run")[number % 3]
        answer = person.post(f"/annotate/task/{text}/{path}", json=body)
        assert 400 <= answer.status_code < 500 and answer.json()["error"]["code"]
        answer = person.post(f"/annotate/task/{text}/{path}", content=randomly.randbytes(randomly.randint(0, 60)))
        assert answer.json()["error"]["code"] == "BAD_JSON"
    assert person.get(f"/annotate/task/{text}/work").json() == before


@pytest.mark.tools
def test_a_kill_at_twenty_random_moments_loses_nothing_that_was_accepted(serving, tmp_path):
    randomly, kept, out = random.Random(0), [], tmp_path / "served"
    token = None
    for _ in range(20):
        server = serving(out=out)
        client = httpx.Client(base_url=server.address, cookies={"hearth": token} if token else None)
        if token is None:
            client.post("/begin")
            token = client.cookies["hearth"]
        threading.Timer(randomly.uniform(0.02, 0.4), server.kill).start()
        try:
            for _ in range(1_000):
                title = f"Task {len(kept)} {randomly.randint(0, 10**9)}"
                answer = client.post("/annotate/describe", data={**TEXT, "title": title})
                if answer.status_code == 303:
                    kept.append(title)
        except httpx.HTTPError:
            pass
    store = Store(default_url(out))
    found = set(store.read(lambda connection: connection.execute(sql.select(TEXTS.c.title)).scalars().all()))
    assert len(kept) > 20 and set(kept) <= found


@pytest.fixture(scope="module")
def postgres():
    """The address of a PostgreSQL of its own, run as a user that is not root."""
    program = shutil.which("postgres")
    if program is None or shutil.which("initdb") is None:
        pytest.skip("no PostgreSQL here")
    folder = Path(tempfile.mkdtemp(prefix="pg"))
    as_user = ["setpriv", "--reuid", "65534", "--regid", "65534", "--clear-groups"] if os.getuid() == 0 else []
    if as_user:
        os.chown(folder, 65534, 65534)
    environment = {**os.environ, "HOME": str(folder)}
    data, options = folder / "data", {"cwd": folder, "env": environment}
    subprocess.run([*as_user, "initdb", "-D", data, "-U", "hearth", "-A", "trust", "--no-sync"],
                   check=True, capture_output=True, **options)  # fmt: skip
    command = [*as_user, program, "-D", data, "-k", folder, "-c", "listen_addresses="]
    running = subprocess.Popen([*map(str, command)], stderr=subprocess.DEVNULL, **options)
    url = f"postgresql://hearth@/postgres?host={folder}"
    for _ in range(300):
        try:
            Store(url).close()
            break
        except HearthError:
            time.sleep(0.1)
    yield url
    running.send_signal(signal.SIGINT)  # it does not wait for connections
    running.wait()
    shutil.rmtree(folder, ignore_errors=True)


@pytest.mark.tools
def test_writers_in_parallel_lose_nothing_in_postgres(postgres):
    in_parallel(postgres)


@pytest.mark.tools
def test_two_servers_share_a_postgres(postgres, tmp_path, knowledge):
    first = Server(tmp_path / "first", knowledge, postgres)
    second = Server(tmp_path / "second", knowledge, postgres)
    person = first.person()
    text = described(person)
    other = second.client(cookies=dict(person.cookies))
    assert text in ids(other)
    submitted(other, text, STEPS)
    judge = reviewer(second)
    assert len(waiting(judge)) == 1
    accept(judge)
    assert "[Watch] <television> (1)" in (second.out / "programs.csv").read_text()
    third = Server(tmp_path / "third", knowledge, postgres)
    assert (third.out / "programs.csv").read_bytes() == (second.out / "programs.csv").read_bytes()
    who = person.get("/mine").text.split("<strong>")[1].split("<")[0]
    unused = described(person)
    assert person.post("/mine/delete").status_code == 303
    kept = second.store.rows(sql.select(TEXTS))
    assert unused != text and [row["id"] for row in kept] == [text] and kept[0]["session"] != who


@pytest.mark.parametrize(
    "text",
    [
        "", "[]", "null", '{"rooms": [], "props": {}, "steps": []}', '{"rooms": {"x": 1e9}, "props": {}, "steps": []}',
        '{"rooms": {}, "props": {}, "steps": [{}]}',
        '{"rooms": {}, "props": {}, "steps": [{"action": "Lie", "things": [["bed"]]}]}',
    ],
)  # fmt: skip
def test_a_program_that_somebody_changed_in_the_store_is_refused(text):
    with pytest.raises(HearthError, match="a program of the store is not one"):
        stored(text)
    draft = Draft({"bedroom": 1}, {"bed": 1})
    assert stored(draft.dumped()) == draft


@pytest.mark.parametrize(("kind", "value"), [("film", "[]"), ("sketch", "x"), ("completeness", "{}")])
def test_a_mark_that_somebody_changed_in_the_store_is_refused(kind, value):
    with pytest.raises(HearthError, match="has another value than those of"):
        collected_files._marked({"id": "m", "kind": kind, "value": value})
