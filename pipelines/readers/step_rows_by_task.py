"""Rows of a file by their tasks: the rows of one program, their order, and the warnings about both."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from hearth.pipelines.readers.reader_warnings import IN_ORDER, ORDERED, warned
from hearth.schemas.failures import Code
from hearth.storage.rejects import Reject

MOST_ROWS = 1_000
"""Rows of one program, at most; a further row begins another."""

MOST_WAITING = 100_000
"""Rows that wait for further rows of their tasks; behind them a task begins again."""


class StepRow(NamedTuple):
    """A row that is a step.

    Attributes:
        key: of its task; "" where the row says nothing of it.
        number: of the step; None where rows are not numbered.
        is_sure: whether it is a step also where no row next to it has its task.
        value: the record so far, with `steps`.
    """

    key: str
    number: int | None
    is_sure: bool
    value: dict[str, Any]


class Entry(NamedTuple):
    """A value with its first line and its name in ids."""

    value: Any
    line: int
    name: str


@dataclass(slots=True)
class _Task:
    """The rows of one program so far, in the order of the file.

    Attributes:
        rows: the rows.
        again: lines on which the task begins again, after rows of other tasks.
        is_rest: whether earlier rows of the task are in another program, as too many rows stood between.
        numbers: those of its steps, of which these are the lowest and the highest.
    """

    rows: list[tuple[Entry, StepRow]]
    again: list[int] = field(default_factory=list)
    is_rest: bool = False
    numbers: set[int | None] = field(default_factory=set)
    lowest: int = 0
    highest: int = 0

    def add(self, entry: Entry, row: StepRow) -> None:
        self.rows.append((entry, row))
        self._count(row)

    def _count(self, row: StepRow) -> None:
        number = row.number or 0
        self.lowest = min(self.lowest, number) if self.numbers else number
        self.highest = max(self.highest, number)
        self.numbers.add(row.number)

    @classmethod
    def begin(cls, entry: Entry, row: StepRow, **more: Any) -> "_Task":
        """Return a task of one row."""
        found = cls([(entry, row)], **more)
        found._count(row)
        return found

    def takes(self, row: StepRow, is_next: bool) -> bool:
        """Return whether a row is a step of this program.

        Args:
            row: with the key of this task, or without a key.
            is_next: whether it stands right below the last row of the task.
        """
        if len(self.rows) >= MOST_ROWS:
            return False
        if row.number is None or None in self.numbers:
            return self.numbers == {None} and row.number is None and row.is_sure and (is_next or bool(row.key))
        if row.number in self.numbers:
            return False
        if row.is_sure:
            return is_next or bool(row.key)
        return self.lowest in (0, 1) and (is_next or (bool(row.key) and row.number == self.highest + 1))

    def repeats(self, row: StepRow) -> bool:
        """Return whether the number of a row is there already, and does not begin another program of the task."""
        return row.is_sure and row.number is not None and row.number in self.numbers and row.number != self.lowest


class Tasks:
    """The programs of a file's rows, in the order of their first rows; other entries keep their places."""

    def __init__(self) -> None:
        self._waiting: list[Entry | _Task] = []
        self._by_key: dict[str, _Task] = {}
        self._seen: set[str] = set()
        self._last: _Task | None = None
        self._count = 0
        self._are_steps = False

    def take(self, entry: Entry, row: StepRow | None) -> Iterator[Entry]:
        """Take an entry, and yield those that wait for nothing."""
        refused = isinstance(entry.value, Reject)
        if refused or row is None:
            self._last = self._last if refused else None
            if self._waiting:
                self._waiting.append(entry)
            else:
                yield entry
            return
        if self._count >= MOST_WAITING:
            yield from self.end()
        self._take_step(entry, row)

    def _take_step(self, entry: Entry, row: StepRow) -> None:
        self._count += 1
        last = self._last
        is_next = last is not None and row.key in ("", last.rows[0][1].key)
        task = last if is_next else self._by_key.get(row.key) if row.key else None
        if task and task.takes(row, is_next):
            task.again += [] if is_next else [entry.line]
            task.add(entry, row)
        elif task and task.repeats(row):
            self._waiting.append(entry._replace(value=_twice(entry, row)))
        else:
            task = _Task.begin(entry, row, is_rest=bool(row.key) and row.key in self._seen and task is None)
            self._waiting.append(task)
            self._seen.add(row.key)
            self._by_key[row.key] = task
        self._last = task

    def end(self) -> Iterator[Entry]:
        """Yield the entries that wait."""
        for each in self._waiting:
            yield self._program(each) if isinstance(each, _Task) else each
        self._waiting, self._by_key, self._last, self._count = [], {}, None, 0

    def _program(self, task: _Task) -> Entry:
        (entry, first), rows = task.rows[0], task.rows
        if len(rows) == 1 and not (first.is_sure or self._are_steps):
            return entry
        self._are_steps = self._are_steps or len(rows) > 1
        ordered = sorted(rows, key=lambda each: each[1].number or 0)
        found = {**first.value, "steps": [step for _, each in ordered for step in each.value["steps"]]}
        notes = [*_again(task), *_out_of_order(rows)]
        return entry._replace(value=warned(found, notes))


def _again(task: _Task) -> Iterator[tuple[int, str, str]]:
    (entry, row), *_ = task.rows
    named = f"`{row.key[:60]}`"
    if row.number is None and task.again:
        message = f"{named} begins again, after rows of other tasks: all its rows are one program"
        yield task.again[0], message, "give each program a title of its own, or number the steps in a column `step`"
    if task.is_rest:
        message = f"{named} begins again, more than {MOST_WAITING:,} rows below its first: a program of its own"
        yield entry.line, message, "sort the rows by their tasks"


def _out_of_order(rows: Iterable[tuple[Entry, StepRow]]) -> Iterator[tuple[int, str, str]]:
    """Yield a warning for the first row whose number is lower than one above."""
    highest = 0
    for entry, row in rows:
        if row.number is not None and row.number < highest:
            message = f"step {row.number} stands below step {highest}: {ORDERED}"
            yield entry.line, message, IN_ORDER
            return
        highest = max(highest, row.number or 0)


def _twice(entry: Entry, row: StepRow) -> Reject:
    named = f" of `{row.key[:60]}`" if row.key else ""
    message = f"step {row.number}{named} is there twice, so that the rows may belong to several programs"
    remedy = "give each program a title of its own"
    return Reject.of(Code.AMBIGUOUS, message, line=entry.line, found=str(row.number), suggestion=remedy)
