"""The last bounds of a command that runs questions of strangers: memory and time of the whole process.

DuckDB's own limits end most questions. A few of its functions allocate past its limit, or are not interrupted.
"""

import os
import shutil
import signal
import socket
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from multiprocessing.util import get_temp_dir
from pathlib import Path

GRACE = 3.0
"""Seconds that a command has to end by itself, after its time is up or a signal came."""

SPARE = 2**30
"""Bytes that a command may take besides those of its database."""


@contextmanager
def bounded_memory(most: int) -> Iterator[None]:
    """Bound the bytes that this process may take beyond what it has, where the system can hold it to that.

    The former bound holds again afterwards: a command may be a part of a longer process.
    """
    try:
        import resource

        with Path("/proc/self/status").open(encoding="ascii") as lines:
            taken = next(int(line.split()[1]) * 1024 for line in lines if line.startswith("VmData:"))
    except (ImportError, OSError, StopIteration):  # no Linux
        yield
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    wanted = taken + most + SPARE
    if hard == resource.RLIM_INFINITY or wanted < hard:
        with suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_DATA, (wanted, hard))
    try:
        yield
    finally:
        with suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_DATA, (soft, hard))


@contextmanager
def ended_within(seconds: float | None) -> Iterator[None]:
    """End the process when the time or a signal is not heeded: native code may keep Python from noticing either."""
    mine, theirs = socket.socketpair()
    theirs.setblocking(False)
    before = signal.set_wakeup_fd(theirs.fileno(), warn_on_full_buffer=False)
    watch = threading.Thread(target=_watch, args=(mine, seconds or None), daemon=True)
    watch.start()
    try:
        yield
    finally:
        signal.set_wakeup_fd(before)
        theirs.close()
        watch.join()
        mine.close()


def _watch(signals: socket.socket, seconds: float | None) -> None:
    """Wait for the end of the work, a signal, or the end of the time."""
    number = None
    signals.settimeout(None if seconds is None else seconds + GRACE)
    try:
        while came := signals.recv(1):  # nothing comes any more once the work is done
            if came[0] in (signal.SIGINT, signal.SIGTERM):
                number = came[0]
                signals.settimeout(GRACE)
    except TimeoutError:
        _end(number)


def _end(number: int | None) -> None:
    """End the process at once, and leave no temporary files."""
    shutil.rmtree(get_temp_dir(), ignore_errors=True)
    said = "Stopped." if number else "error[TIMED_OUT]: the question took too long and was ended\n    = ask for less"
    with suppress(OSError, ValueError):
        os.write(sys.stderr.fileno(), f"{said}\n".encode())
    os._exit(128 + number if number else 1)
