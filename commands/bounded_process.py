"""The last bounds of a command that runs questions of strangers: memory and time of the whole process.

DuckDB's own limits end most questions. A few of its functions allocate past its limit, or are not interrupted.
"""

import os
import shutil
import signal
import socket
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from multiprocessing.util import get_temp_dir
from pathlib import Path
from types import FrameType

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.duckdb_connections import interrupt_all
from hearth.storage.query_time_limit import checked_seconds

GRACE = 3.0
"""Seconds that a command has to end by itself, after its time is up or a signal came."""

AGAIN = 0.5
"""Seconds between the interrupts of a command whose time is over: one that comes at an odd moment is lost."""

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


class _TimeOver(KeyboardInterrupt):
    """The time of a command is over: what it does is stopped as at the keyboard, its other processes too.

    The command line prints its fault: the signal may come just before or after the block that `in_time` bounds.
    """

    def __init__(self, seconds: float) -> None:
        message, remedy = f"the command took longer than {seconds:g} s", "give more time with --within (0: no limit)"
        self.fault = HearthError.of(Code.TIMED_OUT, message, suggestion=remedy)
        super().__init__(message)


@contextmanager
def in_time(seconds: float) -> Iterator[None]:
    """Stop a command that works longer on a dataset, which may be made to take years; 0 for no limit.

    Its connections to DuckDB, its own loops and its other processes are stopped alike. What heeds no interrupt is ended
    by `ended_within`.

    Raises:
        HearthError: TIMED_OUT; BAD_ARGUMENT: it is not a time limit.
    """
    checked_seconds(seconds)
    is_main = threading.current_thread() is threading.main_thread()
    if not seconds or not is_main or not hasattr(signal, "setitimer"):
        with ended_within(seconds):
            yield
        return
    over, heeded = False, False

    def stop(_number: int, _frame: FrameType | None) -> None:
        nonlocal over
        over = True
        if heeded:
            raise _TimeOver(seconds)

    done = threading.Event()
    threading.Thread(target=_interrupting, args=(done, seconds), daemon=True).start()
    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds, AGAIN)
    try:
        with ended_within(seconds):
            try:
                heeded = True
                yield
            finally:
                heeded = False  # an interrupt from here on would break the clearing up
        if over:  # an interrupt was lost at an odd moment, or came before it could be heeded
            raise _TimeOver(seconds)
    except BaseException as error:
        if not over:
            raise
        raise _TimeOver(seconds).fault from error
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        done.set()
        signal.signal(signal.SIGALRM, before)


def _interrupting(done: threading.Event, seconds: float) -> None:
    """Interrupt the connections once the time is over: their native code does not always see a signal."""
    if not done.wait(seconds):
        while not done.wait(AGAIN):
            interrupt_all()


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
    number, ends = None, None if seconds is None else time.monotonic() + seconds + GRACE
    try:
        while True:
            left = None if ends is None else max(0.001, ends - time.monotonic())
            signals.settimeout(left)  # a timer's signals come here, too, and are no reason to wait longer
            if not (came := signals.recv(1)):  # nothing comes any more once the work is done
                return
            if came[0] in (signal.SIGINT, signal.SIGTERM):
                number, ends = came[0], time.monotonic() + GRACE
            elif ends is not None and time.monotonic() > ends:
                raise TimeoutError
    except TimeoutError:
        _end(number)


def _end(number: int | None) -> None:
    """End the process at once, and leave no temporary files."""
    shutil.rmtree(get_temp_dir(), ignore_errors=True)
    said = "Stopped." if number else "error[TIMED_OUT]: it took too long and was ended\n    = ask for less"
    with suppress(OSError, ValueError):
        os.write(sys.stderr.fileno(), f"{said}\n".encode())
    os._exit(128 + number if number else 1)
