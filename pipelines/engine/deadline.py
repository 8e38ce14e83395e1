"""A time limit for each record: what hangs is interrupted and costs only its own record.

A thread looks now and then how long the present record has been worked at, and raises `OverTime` in the thread that
works at it. Unlike an alarm signal this works in any thread, on any system; like one, it waits for library code that
does not come back to Python.
"""

from __future__ import annotations

import ctypes
import threading
import time

_raise_in = ctypes.pythonapi.PyThreadState_SetAsyncExc
_raise_in.argtypes = (ctypes.c_ulong, ctypes.py_object)

_LOOKS = 8
"""Times that the clock is looked at within a limit."""


class OverTime(BaseException):
    """A record took too long. No `Exception`: who guards against all that records do wrong must not keep it."""


class Deadline:
    """A context around one record after another, all in one thread.

    Args:
        seconds: what a record may take; 0 for any time.
    """

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self._began: float | None = None
        self._fired = False
        self._lock = threading.Lock()
        self._worker = threading.get_ident()
        self._over = threading.Event()
        if seconds > 0:
            threading.Thread(target=self._watch, daemon=True, name="hearth-deadline").start()

    def close(self) -> None:
        """Stop watching."""
        self._over.set()

    def __enter__(self) -> None:
        self._began = time.monotonic()

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        self._began = None
        if self._fired:
            with self._lock:
                if kind is not OverTime:
                    _raise_in(self._worker, ctypes.py_object())  # on its way, but the record was just done
                self._fired = False

    def _watch(self) -> None:
        while not self._over.wait(self.seconds / _LOOKS):
            with self._lock:
                began = self._began
                if began is not None and not self._fired and time.monotonic() - began > self.seconds:
                    self._fired = True
                    _raise_in(self._worker, ctypes.py_object(OverTime))
