"""`serve --text`: worlds over HTTP, in order and out of it; each wrong request has a typed fault and its status."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx2
import orjson
import pytest
from starlette.testclient import TestClient

import hearth
from hearth.web.limits import RATES, Rate
from hearth.web.text.open_worlds import Offered
from hearth.web.text.text_door import TextDoor, text_application

ROOT = Path(__file__).resolve().parents[2]
MILK = ("Walk kitchen", "Walk fridge", "Open fridge", "Grab milk 142")
HOLD = {"home": "maple", "goal": "HOLDS(agent, milk)"}
BASE = "http://127.0.0.1"
TOKEN = "a-token-of-these-tests"


@contextlib.contextmanager
def opened(most=200, token="", idle=900.0, rates=None, limit=60, hosts=()):
    door = TextDoor(Offered("wah:train:12", limit), 1, most, rates, idle)
    with TestClient(text_application(door, hosts, token), base_url=BASE, client=("127.0.0.1", 50_000)) as client:
        yield client, door


@pytest.fixture(scope="module")
def client():
    """One door for most tests: a process takes seconds to start."""
    with opened(rates=dict.fromkeys(RATES, Rate(10_000, 10_000))) as (client, _):
        yield client


def begun(client, seed=4, **home):
    world = client.post("/create", json=home or HOLD).json()["id"]
    return world, client.post("/reset", json={"id": world, "seed": seed}).json()


def fault(answer):
    return answer.status_code, answer.json()["error"]["code"]


def test_an_episode_over_http_is_the_engine_s(client):
    home = hearth.TextHome(HOLD["home"], HOLD["goal"], limit=60)
    world, turn = begun(client)
    assert turn["observation"] == home.reset(4)[0]
    for command in MILK:
        turn = client.post("/step", json={"id": world, "action": command}).json()
        text, reward, terminated, truncated, info = home.step(command)
        assert (turn["observation"], turn["reward"]) == (text, reward)
        assert (turn["won"], turn["truncated"]) == (terminated, truncated)
        assert turn["ticks"] == info["ticks"]
    assert turn["done"] and client.get("/admissible", params={"id": world}).json() == {"admissible": []}
    assert fault(client.post("/step", json={"id": world, "action": "wait"})) == (409, "OUT_OF_ORDER")
    assert client.post("/reset", json={"id": world, "seed": 4}).json()["turn"] == 0


def test_it_has_the_shape_of_agentgym(client):
    world = client.post("/create").json()["id"]
    turn = client.post("/reset", json={"id": world, "data_idx": 3}).json()
    assert client.get("/observation", params={"id": world}).json() == turn["observation"]
    assert client.get("/observe", params={"id": world}).json() == turn
    actions = client.get("/available_actions", params={"id": world}).json()
    assert "wait" in actions and actions == client.post("/admissible", json={"id": world}).json()["admissible"]
    step = client.post("/step", json={"id": world, "action": "wait"}).json()
    assert {"observation", "reward", "done"} <= step.keys()
    assert client.post("/close", json={"id": world}).json() == {"closed": True}
    assert fault(client.get("/observe", params={"id": world})) == (404, "UNKNOWN_ID")


def test_seeds_repeat(client):
    (one, first), (two, second), (_, other) = begun(client, 9), begun(client, 9), begun(client, 10)
    assert one != two and first == second != other


def test_sixty_four_worlds_at_once_do_not_touch_each_other(client):
    def play(seed):
        world, turn = begun(client, seed)
        texts = [turn["observation"]]
        for command in MILK:
            texts.append(client.post("/step", json={"id": world, "action": command}).json().get("observation"))
            if texts[-1] is None:
                break
        client.post("/close", json={"id": world})
        return texts

    with ThreadPoolExecutor(16) as pool:
        found = list(pool.map(play, [*range(32), *range(32)]))
    assert found[:32] == found[32:] and len({each[0] for each in found}) == 4


@pytest.mark.parametrize(
    ("method", "address", "given", "expected"),
    [
        ("POST", "/create", {"json": {"home": "castle", "goal": "HOLDS(agent, milk)"}}, (400, "UNKNOWN_HOME")),
        ("POST", "/create", {"json": {"home": "../../etc", "goal": "x"}}, (400, "UNKNOWN_HOME")),
        ("POST", "/create", {"json": {"home": "maple"}}, (400, "BAD_ARGUMENT")),
        ("POST", "/create", {"json": {"home": "maple", "goal": "HOLDS("}}, (400, None)),
        ("POST", "/create", {"json": {"home": "maple", "goal": "never OPEN(fridge)"}}, (400, "BAD_ARGUMENT")),
        ("POST", "/create", {"json": {"task": "wah"}}, (400, "BAD_ARGUMENT")),
        ("POST", "/create", {"content": b"[1]"}, (400, "BAD_JSON")),
        ("POST", "/create", {"content": b"{"}, (400, "BAD_JSON")),
        ("POST", "/create", {"content": b"\xff" * 70_000}, (413, "FILE_TOO_LARGE")),
        ("POST", "/reset", {"json": {}}, (400, "BAD_ARGUMENT")),
        ("POST", "/reset", {"json": {"id": 0}}, (400, "BAD_ARGUMENT")),
        ("POST", "/reset", {"json": {"id": "nobody's"}}, (404, "UNKNOWN_ID")),
        ("GET", "/observe", {}, (400, "BAD_ARGUMENT")),
        ("GET", "/step", {}, (405, "BAD_ARGUMENT")),
        ("POST", "/nowhere", {}, (404, "UNKNOWN_ID")),
        ("POST", "/create", {"headers": {"host": "evil.example"}}, (403, "NOT_ALLOWED")),
        ("POST", "/create", {"headers": {"origin": "https://evil.example"}}, (403, "NOT_ALLOWED")),
        ("POST", "/create", {"headers": {"sec-fetch-site": "cross-site"}}, (403, "NOT_ALLOWED")),
    ],
)
def test_a_wrong_request_is_a_typed_fault(client, method, address, given, expected):
    answer = client.request(method, address, **given)
    status, code = fault(answer)
    assert (status, code if expected[1] else None) == expected
    assert answer.json()["error"]["place"], "each fault names the field or the address"
    assert (
        answer.headers["x-content-type-options"] == "nosniff"
        and "default-src 'none'" in answer.headers["content-security-policy"]
    )


@pytest.mark.parametrize("seed", ["1", 1.5, True, -1, 2**63, [1], None])
def test_an_odd_seed_is_refused(client, seed):
    world = client.post("/create", json=HOLD).json()["id"]
    assert fault(client.post("/reset", json={"id": world, "seed": seed})) == (400, "BAD_ARGUMENT")


def test_what_comes_too_early_is_refused(client):
    world = client.post("/create", json=HOLD).json()["id"]
    assert fault(client.post("/step", json={"id": world, "action": "wait"})) == (409, "OUT_OF_ORDER")
    assert fault(client.get("/admissible", params={"id": world})) == (409, "OUT_OF_ORDER")
    assert fault(client.post("/step", json={"id": world})) == (400, "BAD_ARGUMENT")


def test_an_answer_that_is_no_command_is_a_fault_of_the_turn(client):
    world, _ = begun(client)
    codes = [client.post("/step", json={"id": world, "action": each}).json()["fault"]["code"] for each in (7, "fly")]
    assert codes == ["NOT_TEXT", "UNKNOWN_ACTION"]


def test_two_clients_in_one_episode_see_that_they_are_two(client):
    world, _ = begun(client)
    assert client.post("/step", json={"id": world, "action": "wait", "turn": 0}).json()["turn"] == 1
    assert fault(client.post("/step", json={"id": world, "action": "wait", "turn": 0})) == (409, "CONFLICT")
    assert client.post("/step", json={"id": world, "action": "wait", "turn": 1}).json()["turn"] == 2


def test_a_second_command_before_the_first_is_answered_is_refused(client, monkeypatch):
    with opened() as (mine, door):
        world, _ = begun(mine)
        door._worlds[world].acting = True
        assert fault(mine.post("/step", json={"id": world, "action": "wait"})) == (409, "LOCKED")
        assert fault(mine.post("/reset", json={"id": world})) == (409, "LOCKED")


def test_the_number_of_worlds_is_bounded_and_idle_ones_end():
    with opened(most=2, idle=0.4) as (client, door):
        first, _ = begun(client)
        begun(client)
        assert fault(client.post("/create", json=HOLD)) == (429, "TOO_FAST")
        until = time.monotonic() + 20
        while door._worlds and time.monotonic() < until:
            time.sleep(0.1)
            client.get("/")
        assert fault(client.get("/observe", params={"id": first})) == (404, "UNKNOWN_ID")
        assert client.get("/").json()["worlds"] == {"open": 0, "most": 2}
        assert client.post("/create", json=HOLD).status_code == 200


def test_a_process_that_ends_loses_its_worlds_and_nothing_else():
    with opened() as (client, door):
        world, _ = begun(client)
        os.kill(door._engines[0]._process.pid, signal.SIGKILL)
        until = time.monotonic() + 60
        while door._engines[0].starts < 2 and time.monotonic() < until:
            time.sleep(0.1)
            client.get("/")
        assert fault(client.post("/step", json={"id": world, "action": "wait"})) == (404, "UNKNOWN_ID")
        assert begun(client)[1]["turn"] == 0


def test_rates_are_limited():
    rates = {**dict.fromkeys(RATES, Rate(10_000, 10_000)), "create": Rate(0.01, 1), "world": Rate(0.01, 2)}
    with opened(rates=rates) as (client, _):
        world, _ = begun(client)
        assert fault(client.post("/create", json=HOLD)) == (429, "TOO_FAST")
        client.get("/observe", params={"id": world})
        assert fault(client.get("/observe", params={"id": world})) == (429, "TOO_FAST")


def test_with_a_public_name_every_request_shows_the_token():
    with opened(token=TOKEN, hosts=("homes.example.org",)) as (client, _):
        assert fault(client.post("/create", json=HOLD)) == (403, "NOT_ALLOWED")
        assert fault(client.get("/", headers={"authorization": "Bearer another"})) == (403, "NOT_ALLOWED")
        assert client.get("/", headers={"authorization": f"Bearer {TOKEN}"}).status_code == 200


def test_the_command_serves_and_ends(tmp_path):
    command = [sys.executable, str(ROOT / "cli.py"), "serve", "--text", "--port", "0", "--json", "--out", str(tmp_path),
               "--tasks", "wah:train:3", "--workers", "1"]  # fmt: skip
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT)
    try:
        said = orjson.loads("".join(iter(server.stdout.readline, "}\n")) + "}")
        with httpx2.Client(base_url=said["address"], timeout=60) as client:
            assert begun(client)[1]["observation"].startswith("Goal: hold milk")
            assert client.get("/").json()["tasks"] == "wah:train:3"
    finally:
        server.terminate()
        assert server.wait(20) is not None


@pytest.mark.parametrize("options", [("--tasks", "wah:nowhere"), ("--films", "x"), ("--tasks", "household:train")])
def test_the_command_refuses_what_it_cannot_serve(tmp_path, options):
    command = [sys.executable, str(ROOT / "cli.py"), "serve", "--text", "--port", "0", "--out", str(tmp_path), *options]
    done = subprocess.run(command, check=False, capture_output=True, text=True, cwd=ROOT, timeout=120)
    assert done.returncode in (1, 2) and "Traceback" not in done.stderr
