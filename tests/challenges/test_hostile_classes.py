"""Classes of others that end, interrupt or silence their process: each is a failure of the agent."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import orjson
import pytest

from hearth.challenges.agent_guard import AgentError, Guarded, refusing
from hearth.challenges.agent_standard_streams import StandardDescriptors, check_descriptors
from hearth.challenges.agent_stderr import MOST_SAID
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="descriptors are those of POSIX")

FEW = suite("wah", "test-1", limit=1)

AGENT = """
import os, signal, subprocess, sys, threading, time

class Agent:
    def reset(self, *_):
        self.ticks = 0

    def act(self, observation, legal):
        self.ticks += 1
        if self.ticks == 3:
            self.does()
        return None

    def does(self):
        {does}
"""

FAILURES = {
    "raises an interrupt": "raise KeyboardInterrupt",
    "raises a group with one": "raise BaseExceptionGroup('x', [KeyboardInterrupt()])",
    "closes its output": "os.close(1)",
    "closes its errors": "os.close(2)",
    "closes both and raises": "os.close(1); os.close(2); raise ValueError",
    "closes its input": "os.close(0)",
    "puts a file in the place of its output": "os.dup2(os.open('/dev/null', os.O_RDWR), 1)",
    "takes the streams away": "sys.stdout = sys.stderr = None",
    "closes a stream": "sys.stdout.close()",
    "writes megabytes": "print('x' * 3_000_000)",
    "writes megabytes by number": "os.write(1, b'x' * 3_000_000)",
    "lets a program write megabytes": "subprocess.run([sys.executable, '-c', 'print(\\'x\\' * 3_000_000)'])",
}  # fmt: skip

ENDS = {
    "ends the process": "os._exit(0)",
    "ends it in a thread": "threading.Thread(target=os._exit, args=(0,)).start(); time.sleep(5)",
    "closes all descriptors": "os.closerange(0, 4096)",
    "kills it": "os.kill(os.getpid(), signal.SIGKILL)",
    "interrupts it": "os.kill(os.getpid(), signal.SIGINT); time.sleep(5)",
}


def ran(tmp_path, does, workers=1):
    file = tmp_path / "mine.py"
    file.write_text(AGENT.format(does=does))
    return run(FEW, Lineup(f"{file}:Agent"), 2, tmp_path / "r.jsonl", default, workers)


PLAYED = """
import json, sys
from pathlib import Path
from hearth.challenges.agent_guard import AgentError, Guarded
from hearth.challenges.agent_standard_streams import StandardDescriptors
from hearth.challenges.episode_agents import load

def played(file):
    agent = Guarded(load(file + ":Agent")(), 0, frozenset())
    agent.reset(None, None, 1)
    for _ in range(5):
        try:
            yield agent.act(None, ())
        except AgentError as error:
            yield str(error.fault.code)

for file in sorted(Path(sys.argv[1]).iterdir()):
    with StandardDescriptors():
        said = [*played(str(file))]
    print(json.dumps(said))
    print("errors go on", file=sys.stderr)
"""


def test_what_an_agent_does_to_its_process_is_its_failure_and_undone(tmp_path):
    for number, does in enumerate(FAILURES.values()):
        (tmp_path / f"{number:02}.py").write_text(AGENT.format(does=does))
    words = [sys.executable, "-c", PLAYED, str(tmp_path)]
    done = subprocess.run(words, check=False, capture_output=True, text=True, timeout=100)
    found = dict(zip(FAILURES, map(orjson.loads, done.stdout.splitlines()), strict=True))
    assert found == {name: [None, None, "AGENT_FAILED", None, None] for name in FAILURES}, done.stderr[-1000:]
    assert done.stderr.count("errors go on\n") == len(FAILURES)
    assert len(done.stderr) < 4 * MOST_SAID and "Traceback" not in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("does", [*FAILURES.values(), *ENDS.values()])
def test_an_episode_of_such_an_agent_is_one_failure_and_the_run_goes_on(tmp_path, does):
    found = ran(tmp_path, does)
    assert [(each.end["agent"], each.end["code"]) for each in found.records] == [(0, "AGENT_FAILED")] * 2


def test_an_agent_that_ends_its_process_does_not_end_the_run(tmp_path):
    """One process is lost for each episode; others' results are there."""
    file = tmp_path / "mine.py"
    file.write_text(AGENT.format(does="os._exit(0) if self.seed else None").replace(
        "def reset(self, *_):", "def reset(self, view, goal, seed):\n        self.seed = seed // 4 % 2"))  # fmt: skip
    found = run(FEW, Lineup(f"{file}:Agent"), 2, tmp_path / "r.jsonl", default, 1)
    ended = [None if each.end is None else each.end["message"] for each in found.records]
    assert {*ended} == {None, "its process ended"} and len(ended) == 2


@pytest.mark.parametrize("code", ["import os; os._exit(0)", "raise KeyboardInterrupt", "import sys; sys.exit()"])
def test_a_file_that_ends_its_process_is_refused_before_the_run(tmp_path, code):
    file = tmp_path / "mine.py"
    file.write_text(f"{code}\nclass Agent: pass\n")
    with pytest.raises(HearthError) as found:
        Lineup(f"{file}:Agent").checked()
    assert found.value.diagnostics[0].code == Code.BAD_ARGUMENT


class Agent:
    def __init__(self, does):
        self.does = does

    def act(self, *_):
        self.does()


def swallowed():
    try:
        signal.raise_signal(signal.SIGINT)
    except BaseException as error:
        raise ValueError from error


def ignored():
    try:
        signal.raise_signal(signal.SIGINT)
    except BaseException:
        return


@pytest.mark.parametrize("does", [swallowed, ignored, lambda: signal.raise_signal(signal.SIGINT)])
def test_an_interrupt_at_the_keyboard_ends_the_run_whatever_the_agent_makes_of_it(does):
    with pytest.raises(KeyboardInterrupt):
        Guarded(Agent(does), 0, frozenset()).act(None, ())
    with pytest.raises(KeyboardInterrupt), refusing("x"):
        does()


class Interrupting(Exception):
    def __str__(self):
        raise KeyboardInterrupt


def raised(error):
    raise error


@pytest.mark.parametrize("error", [KeyboardInterrupt(), Interrupting()])
def test_an_interrupt_that_an_agent_raises_is_its_failure(error):
    with pytest.raises(AgentError) as found:
        Guarded(Agent(lambda: raised(error)), 0, frozenset()).act(None, ())
    assert found.value.fault.code == Code.AGENT_FAILED


def test_what_an_agent_says_is_passed_on_without_control_characters(capfd):
    with StandardDescriptors():
        os.write(1, b"\x1b[2Jhello \xe2\x80\xae\n")
        os.write(2, b"two\n")
        check_descriptors()
    os.write(1, b"three\n")
    assert capfd.readouterr() == ("three\n", "\\x1b[2Jhello \\u202e\ntwo\n")


def test_a_result_in_json_has_nothing_of_what_the_agent_says(tmp_path):
    from typer.testing import CliRunner

    from hearth import cli
    from hearth.challenges import task_files

    task_files.write(tmp_path / "t.json", FEW)
    (tmp_path / "mine.py").write_text(AGENT.format(does="print('hello')"))
    words = ["challenge", "run", f"{tmp_path}/t.json", "--main", f"{tmp_path}/mine.py:Agent", "--json"]
    result = CliRunner().invoke(cli.app, [*words, "--out", f"{tmp_path}/r.jsonl"])
    assert result.exit_code == 0 and orjson.loads(result.stdout)
