"""One process at a time that writes in a folder."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


@contextmanager
def locked(folder: Path, doing: str = "building") -> Iterator[None]:
    """Hold a folder for this process; may be entered again by the process that holds it.

    Args:
        folder: made if it is not there.
        doing: the work of such processes there, for the message.

    Raises:
        HearthError: LOCKED, naming the process that holds it now; UNWRITABLE, when the folder cannot be made.
    """
    path = folder.resolve() / ".lock"
    # The system holds the lock, and frees it as soon as its process has ended.
    lock = FileLock(path, blocking=False, thread_local=False, is_singleton=True, fallback_to_soft=False)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        lock.acquire()
    except Timeout:
        holder = path.read_text().strip() or "?"
        suggestion = "wait until it has ended, or choose another folder with --out"
        message = f"process {holder} is {doing} here"
        raise HearthError.of(Code.LOCKED, message, file=str(folder), suggestion=suggestion) from None
    except OSError as error:
        message = f"nothing can be written here: {(error.strerror or str(error)).lower()}"
        suggestion = "choose another folder with --out, or make this one writable"
        raise HearthError.of(Code.UNWRITABLE, message, file=str(folder), suggestion=suggestion) from None
    try:
        path.write_text(f"{os.getpid()}\n")
        yield
    finally:
        lock.release()
