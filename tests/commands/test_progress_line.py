"""Long commands show a bar on a terminal, and nothing elsewhere."""

from __future__ import annotations

import os
import pty
import subprocess
import sys

from hearth.commands.progress_line import bar, watched
from hearth.storage.parallel import spread

SCRIPT = """
import time
from hearth.commands.progress_line import bar
with bar("cups washed") as seen:
    for done in range(1, 4):
        seen(done, 3)
        time.sleep(0.2)
print("clean")
"""


def shown(script):
    """Return the text that a script writes on a terminal's error stream, and the text on its output."""
    ours, theirs = pty.openpty()
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": "100"}
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, check=True, stderr=theirs, stdout=subprocess.PIPE, env=environment)
    os.close(theirs)
    seen = b""
    try:
        while part := os.read(ours, 4096):
            seen += part
    except OSError:  # the end of a terminal
        pass
    os.close(ours)
    return seen.decode(), done.stdout.decode()


def test_a_terminal_sees_how_far_it_is():
    bars, output = shown(SCRIPT)
    assert "cups washed" in bars and "3/3" in bars and "/s" in bars
    assert output == "clean\n"


def test_nothing_is_shown_without_a_terminal(capsys):
    with bar("cups washed") as seen:
        seen(1, 3)
    assert capsys.readouterr() == ("", "")


def test_jobs_are_counted_as_they_are_done():
    seen = []
    assert list(spread(abs, [-1, 2, -3], 1, lambda done, total: seen.append((done, total)))) == [1, 2, 3]
    assert seen == [(1, 3), (2, 3), (3, 3)]


def test_items_are_counted_as_they_come_by():
    seen = []
    assert list(watched("ab", lambda done, total: seen.append((done, total)))) == ["a", "b"]
    assert seen == [(1, None), (2, None)]
