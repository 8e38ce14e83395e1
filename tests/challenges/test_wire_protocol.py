"""Agents over JSON lines: whatever they send, or do not send, the episode goes on and says what was wrong."""

from __future__ import annotations

import json
import shutil
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from hearth.challenges.agent_channels import LONGEST_LINE, Channel, Listener, ProcessChannel
from hearth.challenges.episode_loop import Player, play
from hearth.challenges.wire_protocol import PROTOCOL, WireAgent
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.simulation.env import Env
from hearth.simulation.episode import Episode
from hearth.simulation.episode_files import read, write
from hearth.simulation.goal_text import read_goal

ROOT = Path(__file__).resolve().parents[2]

CLIENT = """
import json, sys, time
for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "observe":
        tick = message["tick"]
        {answer}
        sys.stdout.flush()
"""


@pytest.fixture(scope="module")
def start(maple):
    env = Env(knowledge=default())
    env.reset(maple, 2, seed=1)
    return env.world


def player(code: str, within: float = 20.0, rows: list | None = None) -> WireAgent:
    """A child process of Python whose answer to a tick is printed by this code."""
    argv = [sys.executable, "-c", CLIENT.format(answer=code)]
    return WireAgent(ProcessChannel(argv), within, keep=(rows if rows is not None else []).append)


def episode(start, agent, limit=4, goal="HOLDS(agent, milk)"):
    found = read_goal(goal, start.home)
    try:
        return play(start, found, [Player(agent, found)], 7, actions=["Walk", "Open", "Grab"], limit=limit)
    finally:
        agent.channel.close(0.5)


GOOD = 'print(json.dumps({"tick": tick, "act": 0}))'

BAD = {
    "not JSON": ('print("walk to the kitchen")', "BAD_JSON"),
    "an array": ("print([tick, 0])", "BAD_JSON"),
    "not a number": ('print(\'{"tick": %d, "act": NaN}\' % tick)', "BAD_JSON"),
    "infinity": ('print(\'{"tick": 1e999, "act": 0}\')', "BAD_JSON"),
    "deep": ('print("[" * 5000)', "BAD_JSON"),
    "not UTF-8": ("sys.stdout.buffer.write(b'{\"tick\": \\xff}\\n')", "BAD_JSON"),
    "an empty line": ("print()", "BAD_JSON"),
    "no act": ('print(json.dumps({"tick": tick}))', "BAD_ARGUMENT"),
    "no tick": ('print(json.dumps({"act": 0}))', "BAD_ARGUMENT"),
    "true": ('print(json.dumps({"tick": tick, "act": True}))', "BAD_ARGUMENT"),
    "a fraction": ('print(json.dumps({"tick": tick, "act": 1.5}))', "BAD_ARGUMENT"),
    "a list": ('print(json.dumps({"tick": tick, "act": [0]}))', "BAD_ARGUMENT"),
    "a later tick": ('print(json.dumps({"tick": tick + 1, "act": 0}))', "BAD_ARGUMENT"),
    "too high a number": ('print(json.dumps({"tick": tick, "act": 10**6}))', "BAD_ARGUMENT"),
    "a number below 0": ('print(json.dumps({"tick": tick, "act": -1}))', "BAD_ARGUMENT"),
    "another agent": ('print(json.dumps({"tick": tick, "act": 0, "agent": 1}))', "UNKNOWN_AGENT"),
    "another's instruction": (
        'print(json.dumps({"tick": tick, "act": "<char1> [Walk] <couch> (1)"}))',
        "UNKNOWN_AGENT",
    ),
    "too long a line": ('print("x" * 200_000)', "LINE_TOO_LONG"),
    "too long a text": ('print(json.dumps({"tick": tick, "act": "walk " * 900}))', "LINE_TOO_LONG"),
    "not an action": ('print(json.dumps({"tick": tick, "act": "[Fly] <couch> (1)"}))', "UNKNOWN_ACTION"),
    "two at once": ('print(json.dumps({"tick": tick, "act": "[StandUp] | <char1> [StandUp]"}))', "SYNTAX"),
    "not a thing": ('print(json.dumps({"tick": tick, "act": "[Walk] <couhc> (1)"}))', "UNKNOWN_OBJECT"),
    "what is unseen": ('print(json.dumps({"tick": tick, "act": "[Walk] <fridge> (1)"}))', "NOT_SEEN"),
    "what can't be": ('print(json.dumps({"tick": tick, "act": "[Grab] <couch> (1)"}))', "NOT_AFFORDED"),
    "what is not allowed": ('print(json.dumps({"tick": tick, "act": "[TurnTo] <couch> (1)"}))', "NOT_ALLOWED"),
    "a wrong modifier": ('print(json.dumps({"tick": tick, "act": "[Walk] <couch> (1) {hand=left}"}))', "SYNTAX"),
}


@pytest.mark.parametrize("kind", BAD)
def test_a_bad_answer_is_a_fault_and_the_tick_waits(start, kind):
    """Every tick but the second has a bad answer; that one counts, and all ticks are played."""
    code, expected = BAD[kind]
    rows: list = []
    agent = player(f"if tick == 1:\n            {GOOD}\n        else:\n            {code}", rows=rows)
    played = episode(start, agent, limit=3)
    assert [(fault.tick, str(fault.fault.code)) for fault in agent.faults] == [(0, expected), (2, expected)]
    assert [bool(tick.instructions.get(0)) for tick in played.env.ticks] == [False, True, False]
    assert played.env.ticks[0].before == played.env.ticks[0].world == start
    assert [(row["tick"], row["fault"] and row["fault"]["code"]) for row in rows] == [
        (0, expected), (1, None), (2, expected),
    ]  # fmt: skip
    assert all(fault.fault.message and str(fault.as_json()["code"]) == expected for fault in agent.faults)


def test_a_fault_is_reported_to_the_agent(start, tmp_path):
    log = tmp_path / "seen.jsonl"
    code = f"import sys\nfor line in sys.stdin: open({str(log)!r}, 'a').write(line); print('no', flush=True)"
    agent = WireAgent(ProcessChannel([sys.executable, "-c", code]), 20.0)
    episode(start, agent, limit=2)
    agent.channel.process.wait(5)
    kinds = [json.loads(line) for line in log.read_text().splitlines()]
    assert [each["type"] for each in kinds][:4] == ["begin", "observe", "fault", "observe"]
    begin, observe, fault = kinds[:3]
    assert (begin["protocol"], begin["agent"], begin["goal"]) == (PROTOCOL, 0, "HOLDS(agent, milk)")
    assert sorted(observe) == ["agent", "legal", "observation", "tick", "type"]
    assert (fault["code"], fault["tick"]) == ("BAD_JSON", 0) and fault["remedy"]


def test_an_answer_that_comes_late_is_not_taken_for_the_next_tick(start):
    code = "time.sleep(0.8 if tick == 0 else 0)\n        " + GOOD
    agent = player(code, within=0.5)
    played = episode(start, agent, limit=4)
    codes = [(fault.tick, str(fault.fault.code)) for fault in agent.faults]
    assert codes[0] == (0, "TIMED_OUT") and len(codes) <= 2
    assert played.ticks == 4 and played.env.ticks[-1].instructions


def test_an_agent_that_does_not_read_is_not_waited_for(start):
    agent = WireAgent(ProcessChannel([sys.executable, "-c", "import time; time.sleep(60)"]), 0.2)
    begun = time.monotonic()
    played = episode(start, agent, limit=3)
    assert played.ticks == 3 and {str(fault.fault.code) for fault in agent.faults} == {"TIMED_OUT"}
    assert time.monotonic() - begun < 15


def test_the_answer_of_an_agent_that_is_gone_before_its_question_counts_as_sent_is_read():
    asked, gone = threading.Event(), threading.Event()
    answers = [b"answer\n"]

    def read(_):
        asked.wait(10)
        if answers:
            return answers.pop()
        gone.set()
        return b""

    def write(data):
        asked.set()
        gone.wait(10)
        time.sleep(0.2)  # the end is known first
        return len(data)

    channel = Channel(read, write)
    channel.send(b"question", time.monotonic() + 10)
    assert channel.receive(time.monotonic() + 10) == b"answer"
    with pytest.raises(HearthError, match="DISCONNECTED"):
        channel.receive(time.monotonic() + 10)


def test_an_agent_that_ends_is_missed_once_and_the_others_play_on(start):
    dead, alive = player(f"{GOOD}\n        if tick == 1: sys.exit(3)"), player(GOOD)
    found = read_goal("HOLDS(agent, milk)", start.home)
    try:
        played = play(start, found, [Player(dead, found), Player(alive, found)], 7, actions=["Walk"], limit=5)
    finally:
        dead.channel.close(0.5)
        alive.channel.close(0.5)
    assert [str(fault.fault.code) for fault in dead.faults] == ["DISCONNECTED"]
    assert not alive.faults and played.ticks == 5
    assert [sorted(tick.instructions) for tick in played.env.ticks] == [[0, 1], [0, 1], [1], [1], [1]]
    assert dead.channel.process.poll() == 3


def test_what_an_agent_started_ends_with_it():
    code = "import subprocess, sys, time; p = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(99)']);"
    channel = ProcessChannel([sys.executable, "-c", f"{code} print(p.pid, flush=True); time.sleep(99)"])
    pid = int(channel.receive(time.monotonic() + 20))
    channel.close(0.3)
    assert channel.process.poll() is not None
    time.sleep(0.2)
    state = Path(f"/proc/{pid}/stat")
    assert not state.exists() or state.read_text().split()[2] == "Z"


def test_a_flood_is_read_line_by_line():
    """Ten million bytes without an end, then an answer: no more than a piece is kept."""
    code = f"import sys; sys.stdout.write('x' * 10_000_000 + '\\n' + 'y' * {LONGEST_LINE} + '\\nend\\n')"
    channel = ProcessChannel([sys.executable, "-c", code])
    with pytest.raises(HearthError, match="LINE_TOO_LONG"):
        channel.receive(time.monotonic() + 20)
    assert channel.receive(time.monotonic() + 20) == b"y" * LONGEST_LINE
    assert channel.receive(time.monotonic() + 20) == b"end"
    assert len(channel._received) < 3 * LONGEST_LINE
    with pytest.raises(HearthError, match="DISCONNECTED"):
        channel.receive(time.monotonic() + 20)
    channel.close()


def test_a_command_is_never_read_by_a_shell(tmp_path):
    for argv in (["no such program; touch x"], [], ["echo\0"]):
        with pytest.raises(HearthError, match=r"MISSING_FILE|EMPTY"):
            ProcessChannel(argv)
    channel = ProcessChannel([sys.executable, "-c", "import sys; print(sys.argv[1])", f"$(touch {tmp_path / 'made'})"])
    assert channel.receive(time.monotonic() + 20).startswith(b"$(touch")
    channel.close()
    assert not (tmp_path / "made").exists()


def test_an_agent_connects_to_a_port(start):
    listener = Listener()

    def client():
        with socket.create_connection(("127.0.0.1", listener.port)) as link, link.makefile("rw") as file:
            for line in file:
                message = json.loads(line)
                if message["type"] == "observe":
                    file.write(json.dumps({"tick": message["tick"], "act": message["legal"][-1]}) + "\n")
                    file.flush()

    thread = threading.Thread(target=client, daemon=True)
    thread.start()
    agent = WireAgent(listener.accept(10))
    found = read_goal("HOLDS(agent, milk)", start.home)
    played = play(start, found, [Player(agent, found)], 7, actions=["Walk"], limit=5)
    agent.channel.close()
    thread.join(10)
    assert not agent.faults and all(tick.instructions and not tick.failures for tick in played.env.ticks)
    with pytest.raises(HearthError, match="TIMED_OUT"):
        listener.accept(0.05)
    with pytest.raises(HearthError, match="BAD_ARGUMENT"):
        Listener(listener.port)
    listener.close()


@pytest.mark.parametrize("language", ["js", "py"])
def test_a_client_of_thirty_lines_plays_to_its_goal(language, start, tmp_path):
    program = shutil.which("node") if language == "js" else sys.executable
    if program is None:
        pytest.skip("node is not installed")
    client = ROOT / f"docs/examples/agent.{language}"
    assert len(client.read_text().splitlines()) <= 30 and "hearth." not in client.read_text()
    agent = WireAgent(ProcessChannel([program, str(client)]))
    found = read_goal("HOLDS(agent, milk)", start.home)
    played = play(start, found, [Player(agent, found)], 7)
    agent.channel.close()
    assert played.success and not agent.faults
    write(tmp_path / "episode.jsonl", [Episode.of(played.env)])
    (again,) = read(tmp_path / "episode.jsonl", default())
    assert again == Episode.of(played.env) and again.verify() is None


def hearth(*words, **more):
    return subprocess.run(
        [sys.executable, str(ROOT / "cli.py"), *words], capture_output=True, text=True, timeout=120, check=False, **more
    )


def test_the_program_that_runs_the_command_may_be_the_agent(tmp_path):
    """Over its own standard input and output, with nothing else printed there."""
    words = ["play", "maple", "--goal", "SITTING(agent)", "--agent", "0=stdio", "--out", str(tmp_path / "e.jsonl")]
    with subprocess.Popen(
        [sys.executable, str(ROOT / "cli.py"), *words], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as game:
        kinds = []
        for line in game.stdout:
            message = json.loads(line)
            kinds.append(message["type"])
            if message["type"] == "observe":
                sit = next((text for text in message["legal"] if text.startswith("[Sit]")), "[Walk] <couch> (1)")
                game.stdin.write(json.dumps({"tick": message["tick"], "act": sit}) + "\n")
                game.stdin.flush()
        game.stdin.close()
        assert game.wait(20) == 0
    assert kinds == ["begin", *["observe"] * (len(kinds) - 2), "end"] and message["success"]


def test_play_says_what_was_wrong_and_replay_does_it_again(tmp_path):
    file, kept = tmp_path / "e.jsonl.gz", tmp_path / "t.jsonl"
    client = f'{sys.executable} "{ROOT / "docs/examples/agent.py"}"'
    words = ["play", "maple", "--goal", "HOLDS(agent, milk)", "--agent", f"1={client}", "--out", str(file)]
    done = hearth(*words, "--json", "--transcript", str(kept))
    result = json.loads(done.stdout)
    assert done.returncode == 0 and result["reached"] and [each["faults"] for each in result["agents"]] == [[], []]
    assert len(kept.read_text().splitlines()) == result["ticks"]
    replayed = hearth("replay", str(file), "--json")
    assert replayed.returncode == 0 and json.loads(replayed.stdout)["ticks"] == result["ticks"]
    bad = hearth(*words[:4], "--agent", f"0={sys.executable} -c print(1)", "--ticks", "3", "--json")
    result = json.loads(bad.stdout)
    assert bad.returncode == 1 and not result["reached"]
    assert {fault["code"] for fault in result["agents"][0]["faults"]} <= {"BAD_JSON", "DISCONNECTED"}


@pytest.mark.parametrize(
    "words",
    [
        ["--agent", "milk"], ["--agent", "99=text"], ["--agent", "0="], ["--agent", "0=a", "--agent", "0=b"],
        ["--agent", "0=stdio", "--json"], ["--agent", "0='"], ["--actions", "Fly"], ["--form", "smell"],
    ],
)  # fmt: skip
def test_a_wrong_option_is_wrong_usage(words):
    done = hearth("play", "maple", "--goal", "SITTING(agent)", *words)
    assert done.returncode == 2 and "Error" in done.stderr and "Traceback" not in done.stderr
