"""One build at a time in a folder."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

from hearth.schemas.errors import HearthError
from hearth.schemas.failures import Code

_HELD: set[Path] = set()


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold a folder for this process; may be entered again by the process that holds it.

    Raises:
        HearthError: LOCKED, naming the process that builds there now; UNWRITABLE, when the folder cannot be made.
    """
    key = folder.resolve()
    if key in _HELD:
        yield
        return
    with _opened(folder) as file:
        _take(file.fileno(), folder)
        file.truncate(0)
        file.write(f"{os.getpid()}\n")
        file.flush()
        _HELD.add(key)
        try:
            yield
        finally:
            _HELD.discard(key)


def _opened(folder: Path) -> TextIO:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        return (folder / ".lock").open("a+")
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        message = f"nothing can be written here: {reason}"
        suggestion = "choose another folder with --out, or make this one writable"
        raise HearthError.of(Code.UNWRITABLE, message, file=str(folder), suggestion=suggestion) from None


def _take(descriptor: int, folder: Path) -> None:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        holder = (folder / ".lock").read_text().strip() or "?"
        raise HearthError.of(
            Code.LOCKED,
            f"process {holder} is building here",
            file=str(folder),
            suggestion="wait until it has ended, or choose another folder with --out",
        ) from None
