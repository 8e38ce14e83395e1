"""Progress of a long command on the terminal: items done, rate and time left."""

import sys
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TypeVar

from hearth.storage.parallel import Seen, unseen

T = TypeVar("T")


def watched(items: Iterable[T], seen: Seen, total: int | None = None) -> Iterator[T]:
    """Yield the same items; each is reported to `seen`."""
    for number, item in enumerate(items, 1):
        seen(number, total)
        yield item


@contextmanager
def bar(what: str, note: Callable[[], str] = str) -> Iterator[Seen]:
    """Yield a bar on the error stream, removed at the end; nothing if the stream is not a terminal.

    Args:
        what: the items, in a word or two.
        note: gives further words, each time that progress is reported.

    Yields:
        A function that reports progress: items done and, if known, the total.
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
            said = f"{what} ({more})" if (more := note()) else what
            shown.update(task, completed=done, total=total, rate=rate, description=said)

        yield seen
