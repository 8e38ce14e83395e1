"""The processes that classes of others start in workers of a run: they end with it, wherever they went."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from hearth.challenges.agent_supervisor import adopts_orphans, descendants
from hearth.storage.parallel import context

LONGEST = 3.0
"""Seconds in which processes that were killed are waited for."""


@contextmanager
def none_left() -> Iterator[None]:
    """End the processes that workers of this process have left behind, once the workers are gone.

    On Linux this process becomes their parent where theirs has ended. Processes that it had before stay; elsewhere
    nothing is done.
    """
    if sys.platform != "linux":
        yield
        return
    context()  # starts the processes that stay from run to run
    before = {*descendants()}
    adopts_orphans()
    try:
        yield
    finally:
        _end_others(before)
        adopts_orphans(False)


def _end_others(before: set[int]) -> None:
    until = time.monotonic() + LONGEST
    while (left := [each for each in descendants() if each not in before]) and time.monotonic() < until:
        for each in left:
            with suppress(OSError):
                os.kill(each, signal.SIGKILL)
            with suppress(OSError):
                os.waitpid(each, os.WNOHANG)
        time.sleep(0.01)
