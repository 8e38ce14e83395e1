"""Progress of a build: records done, rate, time left and rejects on a terminal; elsewhere one line a stage."""

import json
import sys
import time
from collections.abc import Callable
from typing import TextIO

from hearth.schemas.terminal import shown, shown_json
from hearth.storage.partitions import Counts


class Progress:
    """Receives the progress of a build; this one reports nothing."""

    def note(self, text: str) -> None:
        """Information about the build as a whole."""

    def start(self, stage: str, total: int | None) -> None:
        """Show that a stage begins; `total` is the number of its records, if known."""

    def seen(self, records: int, rejects: int) -> None:
        """Further records were processed, `rejects` of them rejected."""

    def end(self, stage: str, counts: Counts, seconds: float, fresh: bool) -> None:
        """Show that a stage is complete; `fresh` is False if it was up to date."""


class Lines(Progress):
    """A line a stage."""

    def __init__(self, stream: TextIO | None = None) -> None:
        self._stream = stream or sys.stderr

    def note(self, text: str) -> None:
        """Print it."""
        self._stream.write(f"{text}\n")
        self._stream.flush()

    def end(self, stage: str, counts: Counts, seconds: float, fresh: bool) -> None:
        """Print the outcomes of the stage's records."""
        self._stream.write(line(stage, counts, seconds, fresh) + "\n")
        self._stream.flush()


class JsonLines(Progress):
    """A line of JSON for each event, at most one a second while a stage runs: for logs of long builds.

    Each has `time` (seconds since 1970), `event` (start, progress, end, note) and `stage`.
    """

    def __init__(self, stream: TextIO | None = None, clock: Callable[[], float] = time.time) -> None:
        self._stream = stream or sys.stderr
        self._clock = clock
        self._stage = ""
        self._total: int | None = None
        self._done = self._rejects = 0
        self._began = self._printed = 0.0

    def note(self, text: str) -> None:
        """Print it."""
        self._print("note", text=text)

    def start(self, stage: str, total: int | None) -> None:
        """Print that a stage begins."""
        self._stage, self._total, self._done, self._rejects = stage, total, 0, 0
        self._began = self._printed = self._clock()
        self._print("start", total=total)

    def seen(self, records: int, rejects: int) -> None:
        """Print the progress of the stage, at most once a second."""
        self._done += records
        self._rejects += rejects
        now = self._clock()
        if now - self._printed >= 1.0:
            self._printed = now
            rate = self._done / max(now - self._began, 1e-3)
            left = None if self._total is None else round(max(0, self._total - self._done) / max(rate, 1e-9), 1)
            self._print("progress", done=self._done, rejects=self._rejects, rate=round(rate, 1), seconds_left=left)

    def end(self, stage: str, counts: Counts, seconds: float, fresh: bool) -> None:
        """Print the outcomes of the stage's records."""
        self._stage = stage
        self._print("end", fresh=fresh, seconds=round(seconds, 3), **counts.to_json())

    def _print(self, event: str, **facts: object) -> None:
        line = {"time": round(self._clock(), 3), "event": event, "stage": self._stage, **facts}
        self._stream.write(shown_json(json.dumps(line)) + "\n")
        self._stream.flush()


class Bars(Progress):
    """A bar for the running stage on a terminal, and its line when it is complete."""

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

    def note(self, text: str) -> None:
        """Print it."""
        self._console.print(shown(text), highlight=False, markup=False)

    def start(self, stage: str, total: int | None) -> None:
        """Show a bar."""
        self._done = self._rejects = 0
        self._began = time.monotonic()
        self._task = self._rich.add_task(stage, total=total, rate="0", rejects=0)
        self._rich.start()

    def seen(self, records: int, rejects: int) -> None:
        """Update the bar."""
        self._done += records
        self._rejects += rejects
        rate = self._done / max(time.monotonic() - self._began, 1e-3)
        self._rich.update(self._task, completed=self._done, rate=_shown(rate), rejects=self._rejects)

    def end(self, stage: str, counts: Counts, seconds: float, fresh: bool) -> None:
        """Replace the bar by a line."""
        if self._rich.tasks:
            self._rich.remove_task(self._task)
        self._rich.stop()
        self._console.print(shown(line(stage, counts, seconds, fresh)), highlight=False, markup=False)


def line(stage: str, counts: Counts, seconds: float, fresh: bool) -> str:
    """Return the outcomes of a stage's records, in one line."""
    if not fresh:
        return f"{stage:>8}  up to date"
    rate = counts.records_in / max(seconds, 1e-3)
    return (
        f"{stage:>8}  {counts.records_in:,} in, {counts.through:,} through, {counts.rejected:,} rejected, "
        f"{counts.rows.total():,} rows in {seconds:.1f} s ({_shown(rate)}/s)"
    )


def for_terminal(stream: TextIO | None = None) -> Progress:
    """Bars on a terminal, lines elsewhere."""
    stream = stream or sys.stderr
    return Bars() if stream.isatty() else Lines(stream)


def _shown(rate: float) -> str:
    """Return a rate as people read it: films take minutes each."""
    return f"{rate:,.0f}" if rate >= 10 else f"{rate:.2g}"
