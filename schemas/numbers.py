"""Numbers that others wrote: ids, instances and quantities, as far as tables and people's input hold them."""

from typing import Any

LARGEST = 2**31 - 1
"""The tables' integers have 32 bits."""

LONGEST_HOME = 500.0
"""Metres that a home measures at most, and each thing in it: its floor is a grid of cells of 10 cm."""

FARTHEST = 10_000.0
"""Metres from the origin at which something may be: graphs of a simulator's scenes lie apart from one another."""

_DIGITS = len(str(LARGEST))


def number_of(text: str) -> int | None:
    """Return the number that a text of ASCII digits says; None for any other text, and for one that no table holds."""
    if not (text.isascii() and text.isdecimal() and len(text) <= _DIGITS):
        return None
    number = int(text)
    return number if number <= LARGEST else None


def stored(value: Any) -> int:
    """Return a value as an integer of the tables.

    Raises:
        TypeError: it is not a number.
        ValueError: it has more than 32 bits.
    """
    number = int(value) if not isinstance(value, float) or abs(value) <= LARGEST else LARGEST + 1
    if not -LARGEST <= number <= LARGEST:
        raise ValueError("a number of more than 32 bits")
    return number
