"""The environment in OpenEnv itself: its validator, its client, rewards of the engine, many at once, bad input."""

import asyncio
import subprocess
import sys
import time
from pathlib import Path

import pytest
import requests
from hearth_openenv import HearthAction, HearthEnv

import hearth

HERE = Path(__file__).resolve().parents[1]
HOLD = {"home": "maple", "goal": "HOLDS(agent, milk)"}
MILK = ("Walk kitchen", "Walk fridge", "Open fridge", "Grab milk 142")
OPENENV = str(Path(sys.executable).with_name("openenv"))


@pytest.fixture(scope="module")
def address():
    import socket

    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = subprocess.Popen([str(Path(sys.executable).with_name("server")), "--port", str(port)])
    found = f"http://127.0.0.1:{port}"
    until = time.monotonic() + 120
    while time.monotonic() < until:
        try:
            requests.get(f"{found}/health", timeout=2)
            break
        except requests.RequestException:
            time.sleep(0.3)
    yield found
    server.terminate()
    server.wait(20)


def test_the_validator_passes_on_the_files():
    done = subprocess.run([OPENENV, "validate", str(HERE)], check=False, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_validator_passes_on_the_server(address):
    done = subprocess.run(
        [OPENENV, "validate", "--url", address, "--timeout", "60"], check=False, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_an_episode_is_the_engine_s(address):
    episode = hearth.TextEpisode(**HOLD)
    turn = episode.reset(4)
    with HearthEnv(base_url=address).sync() as client:
        found = client.reset(seed=4, **HOLD)
        assert found.observation.text == turn.observation and found.observation.instructions == episode.instructions
        for command in MILK:
            found, turn = client.step(HearthAction(command=command)), episode.step(command)
            assert (found.observation.text, found.observation.total) == (turn.observation, turn.total)
            assert (found.reward, found.done) == (float(turn.won), turn.done)
            assert found.observation.legal == episode.admissible
        state = client.state()
        assert (state.task, state.won, state.ticks, state.step_count) == (turn.task, True, turn.ticks, 4)
        with pytest.raises(Exception, match="OUT_OF_ORDER"):
            client.step(HearthAction(command="wait"))
        assert client.reset(seed=4, **HOLD).observation.text == episode.reset(4).observation


def test_seeds_repeat_and_sixty_four_play_at_once(address):
    async def play(seed):
        async with HearthEnv(base_url=address, message_timeout_s=300, connect_timeout_s=120) as client:
            first = await client.reset(seed=seed, **HOLD)
            second = await client.step(HearthAction(command="Walk kitchen"))
            return first.observation.text, second.observation.text

    async def run():
        return await asyncio.gather(*[play(number % 32) for number in range(64)])

    found = asyncio.run(run())
    assert found[:32] == found[32:] and len(set(found)) > 3


@pytest.mark.parametrize(
    ("given", "word"),
    [
        ({"home": "castle", "goal": "x"}, "UNKNOWN_HOME"),
        ({"home": "maple"}, "BAD_ARGUMENT"),
        ({"seed": "many"}, "seed"),
        ({"seed": -1}, "seed"),
        ({"seed": 2**63}, "BAD_ARGUMENT"),
        ({"color": "red"}, "BAD_ARGUMENT"),
    ],
)
def test_a_wrong_reset_is_an_error_of_the_hub(address, given, word):
    answer = requests.post(f"{address}/reset", json=given, timeout=60)
    assert answer.status_code == 422 and word in answer.text
    with HearthEnv(base_url=address).sync() as client, pytest.raises(Exception, match=word):
        client.reset(**given)


def test_a_wrong_step_is_an_error_of_the_hub(address):
    for given in ({}, {"action": {}}, {"action": {"command": 7}}, {"action": {"command": "wait", "speed": 2}}):
        assert requests.post(f"{address}/step", json=given, timeout=60).status_code == 422
    early = requests.post(f"{address}/step", json={"action": {"command": "wait"}}, timeout=60)
    assert early.status_code == 422 and "OUT_OF_ORDER" in early.text
    with HearthEnv(base_url=address).sync() as client:
        client.reset(seed=1, **HOLD)
        assert client.step(HearthAction(command="fly")).observation.fault["code"] == "UNKNOWN_ACTION"


def test_two_clients_have_two_episodes(address):
    with HearthEnv(base_url=address).sync() as one, HearthEnv(base_url=address).sync() as two:
        one.reset(seed=1, **HOLD)
        two.reset(seed=1, **HOLD)
        one.step(HearthAction(command="wait"))
        assert (one.state().step_count, two.state().step_count) == (1, 0)
