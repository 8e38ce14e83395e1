"""Numbers that others wrote: ids, instances and quantities, as far as tables and people's input hold them."""

from typing import Any

LARGEST = 2**31 - 1
"""The tables' integers have 32 bits."""

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
