"""Classes of others whose threads, programs and finalizers go on for ever: their worker is ended with the run."""

from __future__ import annotations

import os
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


LEAVES = {
    "a program": "__import__('subprocess').Popen(['sleep', '987.25'])",
    "a program in a session of its own": "__import__('subprocess').Popen(['sleep', '987.25'], start_new_session=True)",
    "a program of a process that ended": "os.fork() or (os.setsid(), os.fork() and os._exit(0), "
    "os.execvp('sleep', ['sleep', '987.25']))",
    "one of a worker that ended": "(__import__('subprocess').Popen(['sleep', '987.25'], start_new_session=True), "
    "os._exit(0))",
    "copies of its process": "[os.fork() for _ in range(3)]",
}


def _left(folder):
    """The command lines of processes that an agent of this folder has left."""
    found = []
    for place in Path("/proc").glob("[0-9]*"):
        try:
            words = (place / "cmdline").read_bytes().split(b"\0")
            inside = (place / "cwd").readlink() == folder
        except OSError:
            continue
        if inside and int(place.name) != os.getpid() and words[0]:
            found.append(b" ".join(words))
    return found


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not give orphans to a process")
@pytest.mark.parametrize("does", LEAVES.values(), ids=LEAVES)
def test_no_process_is_left_behind(tmp_path, does):
    done = subprocess.run(
        command(tmp_path, does), capture_output=True, text=True, timeout=90, check=False, cwd=tmp_path
    )
    assert done.returncode in (0, 1) and (tmp_path / "r.jsonl").exists(), done.stderr
    until = time.monotonic() + 5
    while _left(tmp_path) and time.monotonic() < until:
        time.sleep(0.1)
    assert _left(tmp_path) == []
    records = (tmp_path / "r.jsonl").read_text().splitlines()[1:]
    assert len(records) == 1 and "Traceback" not in done.stderr


def test_a_signal_to_its_group_ends_the_episode_and_not_the_run(tmp_path):
    does = "os.killpg(os.getpgrp(), signal.SIGINT)"
    done = subprocess.run(command(tmp_path, does), capture_output=True, text=True, timeout=90, check=False)
    assert done.returncode == 1 and "AGENT_FAILED" in (tmp_path / "r.jsonl").read_text(), done.stderr


def test_an_endless_recursion_is_ended_soon_after_its_time(tmp_path):
    does = "sys.setrecursionlimit(10**8); (deeper := lambda: deeper())()"
    began = time.monotonic()
    done = subprocess.run(command(tmp_path, does), capture_output=True, text=True, timeout=90, check=False)
    assert done.returncode == 1 and time.monotonic() - began < 60, done.stderr
    assert '"end":' in (tmp_path / "r.jsonl").read_text() and "Traceback" not in done.stderr


@pytest.mark.parametrize("name", ["len", "isinstance", "zip", "__import__", "BaseException", "__build_class__"])
def test_a_changed_builtin_is_a_failure_in_words_and_is_given_back(tmp_path, name):
    does = f"__import__('builtins').{name} = None"
    done = subprocess.run(command(tmp_path, does), capture_output=True, text=True, timeout=90, check=False)
    assert done.returncode == 1 and "Traceback" not in done.stderr, done.stderr
    assert f"it changed `{name}` of builtins" in (tmp_path / "r.jsonl").read_text()


def test_what_breaks_our_part_of_the_process_is_the_failure_of_the_agent(tmp_path):
    does = "import hearth.challenges.episodes as ours; ours.analysed = None"
    done = subprocess.run(command(tmp_path, does), capture_output=True, text=True, timeout=90, check=False)
    assert done.returncode == 1 and "Traceback" not in done.stderr, done.stderr
    assert "failed by TypeError" in (tmp_path / "r.jsonl").read_text()


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
