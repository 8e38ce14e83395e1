"""A process between Hearth and an agent of others: what the agent starts ends with it, wherever it went.

It is run as a script: `python -I -S agent_supervisor.py DESCRIPTOR COMMAND...`. Linux gives it every process of the
agent whose parent has ended (`PR_SET_CHILD_SUBREAPER`), those with a session of their own too. DESCRIPTOR is a pipe
that gets the number of the error where the command cannot be started. Its exit status is that of the agent.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import time
from contextlib import suppress

_SUBREAPER, _PARENT_DEATH = 36, 1
"""Options of Linux's `prctl`."""

PATIENCE = 1.0
"""Seconds between the request to end and the end."""


class _Asked(BaseException):
    """Hearth asks for the end, or is gone."""


def adopts_orphans(wanted: bool = True) -> bool:
    """Return whether this system gives orphans of descendants to this process from now on, or no longer."""
    try:
        return bool(ctypes.CDLL(None, use_errno=True).prctl(_SUBREAPER, int(wanted), 0, 0, 0) == 0)
    except (OSError, AttributeError, TypeError):
        return False


def descendants() -> list[int]:
    """Return the processes below this one that have not ended, nearest first."""
    children: dict[int, list[int]] = {}
    for name in filter(str.isdigit, os.listdir("/proc")):  # noqa: PTH208 - `pathlib` takes as long as all the rest
        with suppress(OSError, ValueError, IndexError), open(f"/proc/{name}/stat", "rb") as file:  # noqa: PTH123
            state, parent = file.read().rpartition(b")")[2].split()[:2]
            if state not in b"ZX":
                children.setdefault(int(parent), []).append(int(name))
    found = children.get(os.getpid(), [])[:]
    for each in found:
        found.extend(children.get(each, ()))
    return found


def end_all(patience: float = PATIENCE) -> None:
    """Ask every descendant to end, then end it; return when none is left."""
    for each in descendants():
        with suppress(OSError):
            os.kill(each, signal.SIGTERM)
    until = time.monotonic() + patience
    while left := descendants():
        if time.monotonic() > until:
            for each in left:
                with suppress(OSError):
                    os.kill(each, signal.SIGKILL)
        time.sleep(0.01)


def _started(words: list[str], faults: int) -> int:
    """Start the agent, and leave its pipes to it alone; return its process."""
    try:
        process = os.posix_spawnp(
            words[0], words, os.environ, setsigdef=[signal.SIGTERM, signal.SIGINT, signal.SIGPIPE]
        )
    except (OSError, ValueError) as error:
        os.write(faults, str(getattr(error, "errno", None) or 22).encode())
        os._exit(127)
    for each in (faults, 0, 1):
        os.close(each)
    return process


def _asked(_number: int, _frame: object) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    raise _Asked


def main() -> None:
    """Run the command of the arguments, and end all that it started."""
    faults, words = int(sys.argv[1]), sys.argv[2:]
    adopts_orphans()
    status = 128 + signal.SIGTERM
    try:
        signal.signal(signal.SIGTERM, _asked)
        ctypes.CDLL(None).prctl(_PARENT_DEATH, signal.SIGTERM, 0, 0, 0)
        os.set_inheritable(faults, False)
        process = _started(words, faults)
        while True:
            ended, code = os.waitpid(-1, 0)  # orphans are waited for, too
            if ended == process:
                status = os.waitstatus_to_exitcode(code)
                break
    except (_Asked, ChildProcessError):
        pass
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    end_all()
    os._exit(status if status >= 0 else 128 - status)


if __name__ == "__main__":
    main()
