"""Processes that an agent starts end with it; an agent gets only the allowed variables of our environment."""

from __future__ import annotations

import gc
import subprocess
import sys
import time
from pathlib import Path

import pytest

from hearth.challenges import agent_process, agent_stderr
from hearth.challenges.agent_channels import ProcessChannel
from hearth.schemas.diagnostics import HearthError

linux = pytest.mark.skipif(sys.platform != "linux", reason="only Linux gives orphans to a process of ours")

SLEEP = "[sys.executable, '-c', 'import time; time.sleep(99)']"
STARTS = {
    "in its group": f"p = subprocess.Popen({SLEEP}); print(p.pid, flush=True)",
    "in a session": f"p = subprocess.Popen({SLEEP}, start_new_session=True); print(p.pid, flush=True)",
    "twice forked": """
if os.fork() == 0:
    os.setsid()
    if os.fork() == 0:
        print(os.getpid(), flush=True)
        time.sleep(99)
    os._exit(0)
os.wait()
time.sleep(1)  # the other one has said its number by then""",
    "deaf": """
p = subprocess.Popen([sys.executable, '-c', 'import signal, time; signal.signal(15, signal.SIG_IGN); time.sleep(99)'],
                     start_new_session=True, env={})
print(p.pid, flush=True)""",
    "stopped": f"p = subprocess.Popen({SLEEP}, start_new_session=True); p.send_signal(19); print(p.pid, flush=True)",
    "with no pipe": f"""
p = subprocess.Popen({SLEEP}, start_new_session=True, stdin=-3, stdout=-3, stderr=-3, env={{}})
print(p.pid, flush=True)""",
}


def gone(pid):
    state = Path(f"/proc/{pid}/stat")
    until = time.monotonic() + 5
    while time.monotonic() < until:
        try:
            if state.read_text().rpartition(")")[2].split()[0] == "Z":
                return True
        except OSError:
            return True
        time.sleep(0.05)
    return False


def started(how, then):
    channel = ProcessChannel([sys.executable, "-c", f"import os, subprocess, sys, time\n{STARTS[how]}\n{then}"])
    return channel, int(channel.receive(time.monotonic() + 20))


@linux
@pytest.mark.parametrize("then", ["time.sleep(99)", "sys.exit(3)", "os.kill(os.getpid(), 9)"])
@pytest.mark.parametrize("how", list(STARTS))
def test_all_that_an_agent_started_ends_with_it(how, then):
    channel, pid = started(how, then)
    channel.close(0.3)
    assert channel.process.poll() is not None
    assert gone(pid)


@linux
def test_what_is_left_of_an_agent_that_ended_ends_without_being_asked():
    channel, pid = started("in a session", "sys.exit(3)")
    assert gone(pid)
    assert channel.process.wait(10) == 3
    channel.close()


@linux
def test_agents_end_with_hearth():
    code = f"""
import time, sys
from hearth.challenges.agent_channels import ProcessChannel
c = ProcessChannel([sys.executable, '-c', '''import os, subprocess, sys, time
{STARTS["in a session"]}
time.sleep(99)'''])
print(c.receive(time.monotonic() + 20).decode(), flush=True)
time.sleep(99)
"""
    ours = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    pid = int(ours.stdout.readline())
    ours.kill()
    ours.wait()
    assert gone(pid)


def test_keys_tokens_and_salts_stay_here(monkeypatch):
    for name in ("HEARTH_SALT", "HF_TOKEN", "OPENAI_API_KEY", "AWS_SECRET_ACCESS_KEY", "PGPASSWORD", "LD_PRELOAD"):
        monkeypatch.setenv(name, "secret")
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    code = "import os; print(sorted(os.environ), flush=True); print('secret' in str(os.environ), flush=True)"
    channel = ProcessChannel([sys.executable, "-c", code])
    names = channel.receive(time.monotonic() + 20).decode()
    assert channel.receive(time.monotonic() + 20) == b"False", names
    assert "LC_ALL" in names
    channel.close()
    assert agent_process.environment({"PATH": "a", "Path": "b", "LC_TIME": "c", "KEY": "d"}).keys() == {
        "PATH", "Path", "LC_TIME"}  # fmt: skip


@pytest.mark.parametrize("argv", [["no-such-agent"], [""], ["/"], ["a\0b"], [str(Path(__file__))]])
def test_what_cannot_be_started_is_said(argv):
    gc.collect()  # descriptors of tests before this one may be closed meanwhile
    before = open_descriptors()
    with pytest.raises(HearthError, match="can't be started"):
        ProcessChannel(argv)
    assert open_descriptors() <= before


def open_descriptors() -> int:
    return len(list(Path("/proc/self/fd").iterdir())) if sys.platform == "linux" else 0


def test_what_an_agent_says_on_its_standard_error_moves_no_cursor_and_ends(capsys, monkeypatch):
    monkeypatch.setattr(agent_stderr, "MOST_SAID", 100)
    said = r"import os; os.write(2, b'\x1b[31mred\x07 \xff\xe2\x80\xae' + b'x' * 3_000_000)"
    ProcessChannel([sys.executable, "-c", said]).close(10)
    err = capsys.readouterr().err
    assert err.startswith(r"\x1b[31mred\x07 ") and "\\u202e" in err
    assert len(err) < 200 and err.endswith("left out\n")
