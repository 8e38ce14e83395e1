"""Reading a dataset that a build may replace at any moment: every answer is from one version of it."""

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from hearth.schemas.diagnostics import HearthError
from hearth.storage.manifest import NAME

Answer = TypeVar("Answer")

TRIES = 10
"""Times that a question is asked, if a build replaces the dataset each time."""


def version(folder: Path) -> tuple[int, int] | None:
    """Return a value that differs once a build has replaced a dataset; None while its manifest cannot be seen."""
    try:
        found = (folder / NAME).stat()
    except OSError:
        return None
    return found.st_ino, found.st_mtime_ns


def steady(folder: Path, ask: Callable[[], Answer]) -> Answer:
    """Return the answer to a question, asked again if a build has replaced the dataset meanwhile.

    Raises:
        HearthError: as `ask` raises it for a dataset that stayed as it was.
    """
    for _ in range(TRIES):
        before = version(folder)
        try:
            answer = ask()
        except HearthError:
            if version(folder) in (None, before):
                raise
            continue
        if version(folder) in (None, before):
            return answer
    return ask()
