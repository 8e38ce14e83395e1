"""Progress that tells the truth: records done, rate, time left and rejects; a line a stage where nobody watches."""

from __future__ import annotations

import sys
import time
from typing import Protocol, TextIO

from hearth.pipelines.parts import Counts


class Progress(Protocol):
    """Is told how a build goes."""

    def start(self, stage: str, total: int | None) -> None:
        """A stage begins; `total` records, if that is known."""

    def seen(self, records: int, rejects: int) -> None:
        """So many more records were processed, and so many of them rejected."""

    def end(self, stage: str, counts: Counts, seconds: float, fresh: bool) -> None:
        """A stage is complete; `fresh` is False when nothing had to be done."""


class Quiet:
    """Says nothing."""

    def start(self, stage: str, total: int | None) -> None:
        """Nothing."""

    def seen(self, records: int, rejects: int) -> None:
        """Nothing."""

    def end(self, stage: str, counts: Counts, seconds: float, fresh: bool) -> None:
        """Nothing."""


class Lines(Quiet):
    """A line a stage."""

    def __init__(self, stream: TextIO | None = None) -> None:
        self._stream = stream or sys.stderr

    def end(self, stage: str, counts: Counts, seconds: float, fresh: bool) -> None:
        """Say what became of the stage's records."""
        self._stream.write(line(stage, counts, seconds, fresh) + "\n")
        self._stream.flush()


class Bars:
    """A bar for the running stage on a terminal, its line when it is done."""

    def __init__(self) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, SpinnerColumn, TextColumn, TimeRemainingColumn
        from rich.progress import Progress as Rich

        self._console = Console(stderr=True)
        self._rich = Rich(
            SpinnerColumn(),
            TextColumn("{task.description:>8}"),
            BarColumn(),
            MofNCompleteColumn(),
            TextColumn("{task.fields[rate]}/s"),
            TimeRemainingColumn(),
            TextColumn("{task.fields[rejects]} rejects"),
            console=self._console,
            transient=True,
        )
        self._done = self._rejects = 0
        self._began = 0.0

    def start(self, stage: str, total: int | None) -> None:
        """Show a bar."""
        self._done = self._rejects = 0
        self._began = time.monotonic()
        self._task = self._rich.add_task(stage, total=total, rate="0", rejects=0)
        self._rich.start()

    def seen(self, records: int, rejects: int) -> None:
        """Move it."""
        self._done += records
        self._rejects += rejects
        rate = self._done / max(time.monotonic() - self._began, 1e-3)
        self._rich.update(self._task, completed=self._done, rate=f"{rate:,.0f}", rejects=self._rejects)

    def end(self, stage: str, counts: Counts, seconds: float, fresh: bool) -> None:
        """Put a line in its place."""
        if self._rich.tasks:
            self._rich.remove_task(self._task)
        self._rich.stop()
        self._console.print(line(stage, counts, seconds, fresh), highlight=False, markup=False)


def line(stage: str, counts: Counts, seconds: float, fresh: bool) -> str:
    """What became of a stage's records, in one line."""
    if not fresh:
        return f"{stage:>8}  up to date"
    rate = counts.records_in / max(seconds, 1e-3)
    return (
        f"{stage:>8}  {counts.records_in:,} in, {counts.through:,} through, {counts.rejected:,} rejected, "
        f"{counts.rows.total():,} rows in {seconds:.1f} s ({rate:,.0f}/s)"
    )


def for_terminal(stream: TextIO | None = None) -> Progress:
    """Bars on a terminal, lines elsewhere."""
    stream = stream or sys.stderr
    return Bars() if stream.isatty() else Lines(stream)
