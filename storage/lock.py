"""One process at a time that writes in a folder, or into a file."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from filelock import FileLock, Timeout

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

_FOLDER = ".lock"
"""Name of the lock of a folder, within it."""


@contextmanager
def locked(folder: Path, doing: str = "building") -> Iterator[None]:
    """Hold a folder for this process; may be entered again by the process that holds it.

    Args:
        folder: made if it is not there.
        doing: the work of such processes there, for the message.

    Raises:
        HearthError: LOCKED, naming the process that holds it now; UNWRITABLE, when the folder cannot be made.
    """
    path = folder.resolve() / _FOLDER
    # The system holds the lock, and frees it as soon as its process has ended.
    lock = FileLock(path, blocking=False, thread_local=False, is_singleton=True, fallback_to_soft=False)
    with _held(lock, path, folder, doing):
        yield


@contextmanager
def locked_file(file: Path, doing: str) -> Iterator[None]:
    """Hold a file that a process writes for a while; nobody else may, not even this process. Errors as of `locked`."""
    path = file.with_name(f".{file.name}.lock")
    with _held(FileLock(path, blocking=False, thread_local=False, fallback_to_soft=False), path, file, doing):
        try:
            yield
        finally:
            with suppress(OSError):  # systems that do not remove open files keep it
                path.unlink()


@contextmanager
def _held(lock: Any, path: Path, what: Path, doing: str) -> Iterator[None]:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        lock.acquire()
    except Timeout:
        holder = path.read_text().strip() or "?"
        suggestion = f"wait until it has ended, or choose {_other(path)} with --out"
        message = f"process {holder} is {doing} here"
        raise HearthError.of(Code.LOCKED, message, file=str(what), suggestion=suggestion) from None
    except OSError as error:
        message = f"nothing can be written here: {(error.strerror or str(error)).lower()}"
        suggestion = f"choose {_other(path)} with --out, or make this one writable"
        raise HearthError.of(Code.UNWRITABLE, message, file=str(what), suggestion=suggestion) from None
    try:
        path.write_text(f"{os.getpid()}\n")
        yield
    finally:
        lock.release()


def _other(path: Path) -> str:
    return "another folder" if path.name == _FOLDER else "another file"
