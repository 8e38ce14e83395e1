"""Guards of the process that plays an agent's class: its time, its copies, and the names that all modules share."""

from __future__ import annotations

import builtins
import faulthandler
import multiprocessing
import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

GRACE = 5.0
"""Seconds from the interruption of an agent to the end of its process, which it may take to clean up."""

_NAMES = vars(builtins)
_BEFORE = dict(_NAMES)


@contextmanager
def ended_after(seconds: float) -> Iterator[None]:
    """End a worker in which an agent goes on after it was interrupted, such as in an endless recursion.

    The interpreter is not asked, because the agent may keep it busy.
    """
    if multiprocessing.parent_process() is None or threading.current_thread() is not threading.main_thread():
        yield
        return
    with open(os.devnull, "w") as nowhere:  # noqa: PTH123 - `pathlib` may be the agent's
        faulthandler.dump_traceback_later(seconds + GRACE, exit=True, file=nowhere)
        try:
            yield
        finally:
            faulthandler.cancel_dump_traceback_later()


@contextmanager
def unchanged() -> Iterator[None]:
    """Undo what an agent did to the process: copies of it end here, and Python's built-in names are those of before.

    Raises:
        HearthError: AGENT_FAILED: it changed a built-in name.
    """
    own, getpid, leave = os.getpid(), os.getpid, os._exit
    try:
        yield
    finally:
        if getpid() != own:
            leave(0)
        changed = _restored()
    if changed:
        message = f"it changed `{changed}` of builtins, which the whole process shares"
        raise HearthError.of(Code.AGENT_FAILED, message)


def _restored() -> str:
    """Give built-in names their values; return one that had another. No built-in name is used here."""
    changed = ""
    for name, value in _BEFORE.items():
        if name != "_" and _NAMES.get(name) is not value:
            _NAMES[name] = value
            changed = name
    return changed
