"""What is shown while a command takes its time: how far it is, how fast, and how long it will take."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TypeVar

from hearth.storage.parallel import Seen, unseen

T = TypeVar("T")


def watched(items: Iterable[T], seen: Seen, total: int | None = None) -> Iterator[T]:
    """The same items; `seen` is told of each."""
    for number, item in enumerate(items, 1):
        seen(number, total)
        yield item


@contextmanager
def bar(what: str) -> Iterator[Seen]:
    """A bar on the terminal's error stream, gone when it is over; nothing where that is no terminal.

    Args:
        what: is done, in a word or two.

    Yields:
        what is to be told how many of how many are done.
    """
    if not sys.stderr.isatty():
        yield unseen
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, SpinnerColumn, TextColumn, TimeRemainingColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    rate = TextColumn("{task.fields[rate]:.1f}/s")
    with Progress(*columns, rate, TimeRemainingColumn(), console=Console(stderr=True), transient=True) as shown:
        task, began = shown.add_task(what, total=None, rate=0.0), time.monotonic()

        def seen(done: int, total: int | None) -> None:
            rate = done / max(time.monotonic() - began, 1e-3)
            shown.update(task, completed=done, total=total, rate=rate)

        yield seen
