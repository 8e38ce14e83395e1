"""Classes of others whose threads, programs and finalizers go on for ever: their worker is ended with the run."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from hearth.challenges.task_files import suite, write

ROOT = Path(__file__).resolve().parents[2]

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals are those of POSIX")

AGENT = """
import multiprocessing, multiprocessing.util, os, signal, sys, threading, time

def sleep(*_):
    while True:
        time.sleep(1)

class Agent:
    ticks = 0

    def reset(self, *_):
        pass

    def act(self, observation, legal):
        self.ticks += 1
        if self.ticks == 1:
            {does}
        return None
"""

STAYS = {
    "a thread": "threading.Thread(target=sleep).start()",
    "many threads": "[threading.Thread(target=sleep).start() for _ in range(20)]",
    "a finalizer": "multiprocessing.util.Finalize(None, sleep, exitpriority=100)",
    "a signal that is ignored": "signal.signal(signal.SIGTERM, signal.SIG_IGN); threading.Thread(target=sleep).start()",
    "a lock of the pool": "threading._shutdown = sleep",
}


def command(tmp_path, does):
    """The words of a run of an agent, as a program of its own."""
    (tmp_path / "mine.py").write_text(AGENT.format(does=does))
    tasks = tmp_path / "tasks.json"
    write(tasks, suite("wah", "test-1", limit=1))
    words = ["challenge", "run", tasks, "--main", f"{tmp_path / 'mine.py'}:Agent", "-j", "1"]
    return [sys.executable, ROOT / "cli.py", *words, "--seconds", "3", "--out", tmp_path / "r.jsonl"]


@pytest.mark.parametrize("does", STAYS.values(), ids=STAYS)
def test_a_run_ends_though_its_agent_leaves_something_behind(tmp_path, does):
    done = subprocess.run(command(tmp_path, does), capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode in (0, 1) and (tmp_path / "r.jsonl").exists(), done.stderr
    assert "Traceback" not in done.stderr and "Exception ignored" not in done.stderr


def test_a_run_that_is_asked_to_end_says_so_by_its_status(tmp_path):
    loops = "(tmp := __import__('pathlib').Path(__file__).with_name('begun')).touch(); sleep()"
    running = subprocess.Popen(command(tmp_path, loops), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    until = time.monotonic() + 60
    while not (tmp_path / "begun").exists() and time.monotonic() < until:
        time.sleep(0.1)
    running.send_signal(signal.SIGTERM)
    _, errors = running.communicate(timeout=30)
    assert running.returncode in (128 + signal.SIGTERM, -signal.SIGTERM), errors
    assert "Traceback" not in errors and "Exception ignored" not in errors


def test_a_signal_to_end_after_the_work_is_done_has_its_status(tmp_path):
    """Python waits for threads after the command: a signal there ends the process, too."""
    code = (
        "import sys, threading, time; sys.argv = ['hearth', '--version']\n"
        "from hearth import cli\n"
        "threading.Thread(target=time.sleep, args=(60,)).start()\n"
        "cli.main()\n"
    )
    running = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert running.stdout.readline()
    time.sleep(1)
    running.send_signal(signal.SIGTERM)
    _, errors = running.communicate(timeout=30)
    assert running.returncode == -signal.SIGTERM and not errors
