"""The ticks that the processes of action set 3 have counted in a world (see `simulation.processes`).

The count of each thing is kept bit by bit: a row of nodes has the lowest bit of the counts of all things, the next row
the second bit, and so on. While nothing changes, no row is touched: the number of such ticks is kept instead.
"""

from typing import Any, NamedTuple

SETTLED, STILL = 1, 2
"""Values of `World.settled`."""


class GoingOn(NamedTuple):
    """A process that goes on in a world: its rows of counts, and the things that take part."""

    first: int
    bits: int
    things: int


class Ticks(NamedTuple):
    """The counts of all processes.

    Attributes:
        rows: the bits of the counts as they were `age` ticks ago.
        going_on: the processes that have counted in every tick since.
        age: the number of ticks since.
        due: the age at which a process is done for some thing; 0 while no process goes on.
        watched: the keys of the rows of `Moved.extra` that say what is in, or on, the devices that are at work.
        beside: these devices, and the things in, or on, them in the home as it is given.
        asked: the answers of all processes when they were last asked (see `stale_processes.Asked`); None if never.
    """

    rows: tuple[int, ...]
    going_on: tuple[GoingOn, ...] = ()
    age: int = 0
    due: int = 0
    watched: tuple[int, ...] = ()
    beside: int = 0
    asked: Any = None

    def older(self) -> "Ticks":
        """Return the counts one tick later, where nothing has changed."""
        rows, going_on, age, due, watched, beside, asked = self
        return Ticks(rows, going_on, age + 1, due, watched, beside, asked)

    def counted(self) -> tuple[int, ...]:
        """Return the bits of the counts as they are now."""
        if not self.age:
            return self.rows
        rows = list(self.rows)
        for each in self.going_on:
            _add(rows, each, self.age)
        return tuple(rows)


def _add(rows: list[int], process: GoingOn, ticks: int) -> None:
    """Add a number of ticks to the counts of the things that take part in a process."""
    first, bits, things = process
    carry = 0
    for k in range(bits):
        row, added = rows[first + k], things if ticks >> k & 1 else 0
        rows[first + k] = row ^ added ^ carry
        carry = row & added | carry & (row ^ added)


def ticks_left(rows: list[int], process: GoingOn, after: int) -> int:
    """Return the number of ticks until a process is done for the first of the things that take part in it."""
    things, most = process.things, 0
    for k in reversed(range(process.bits)):
        higher = things & rows[process.first + k]
        if higher:
            things = higher
            most |= 1 << k
    return after - most
