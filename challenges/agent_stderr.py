"""The standard error of an agent's program, for a terminal: nothing in it moves the cursor, and it ends somewhere."""

from __future__ import annotations

import codecs
import subprocess
import sys
import threading
from contextlib import suppress
from typing import IO

from hearth.schemas.terminal import shown

MOST_SAID = 200_000
"""Characters of one program that are passed on; the rest is read and left out."""


def relay(process: subprocess.Popen[bytes]) -> threading.Thread:
    """Pass a program's standard error on to ours, in a thread that ends with the program."""
    assert process.stderr is not None
    thread = threading.Thread(target=_relay, args=(process.stderr,), daemon=True)
    thread.start()
    return thread


def _relay(given: IO[bytes]) -> None:
    left, decoder = MOST_SAID, codecs.getincrementaldecoder("utf-8")("replace")
    with given, suppress(OSError, ValueError):
        while data := given.read(65_536):
            text = shown(decoder.decode(data))
            if left > 0:
                more = "" if len(text) < left else "\n... the agent says more, which is left out\n"
                sys.stderr.write(text[:left] + more)
                sys.stderr.flush()
            left -= len(text)
