"""A time limit for each record: a record that hangs is interrupted, and only it is lost.

A watching thread measures the time of the current record and raises `OverTime` in the thread that processes it. Unlike
an alarm signal this works in any thread, on any system; like one, it waits for library code to return to Python.
"""

import ctypes
import threading
import time
from collections.abc import Callable

_raise_in = ctypes.pythonapi.PyThreadState_SetAsyncExc
_raise_in.argtypes = (ctypes.c_ulong, ctypes.py_object)

_LOOKS = 8
"""Number of times that the clock is read within a limit."""


class OverTime(BaseException):
    """A record took too long. Not an `Exception`, so that `except Exception` in a stage does not catch it."""


class Deadline:
    """A context around one record after another, all in one thread.

    Args:
        seconds: the limit of a record; 0 for none. It may be set anew for the next record.
        clock: the time that is limited, in seconds.
    """

    def __init__(self, seconds: float, clock: Callable[[], float] = time.monotonic) -> None:
        self.seconds = seconds
        self._clock = clock
        self._began: float | None = None
        self._fired = False
        self._lock = threading.Lock()
        self._worker = threading.get_ident()
        self._over = threading.Event()
        if seconds > 0:
            threading.Thread(target=self._watch, args=(seconds,), daemon=True, name="hearth-deadline").start()

    def close(self) -> None:
        """Stop watching."""
        self._over.set()

    def __enter__(self) -> None:
        self._began = self._clock()

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        self._began = None
        if self._fired:
            with self._lock:
                if kind is not OverTime:
                    _raise_in(self._worker, ctypes.py_object())  # raised, but not yet delivered: the record is complete
                self._fired = False

    def _watch(self, seconds: float) -> None:
        while not self._over.wait(seconds / _LOOKS):
            with self._lock:
                began = self._began
                if began is not None and not self._fired and self._clock() - began > self.seconds:
                    self._fired = True
                    _raise_in(self._worker, ctypes.py_object(OverTime))
