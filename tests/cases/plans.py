"""The form of an input of our own beside a shared case, and its expected outcome."""

from __future__ import annotations

from typing import NamedTuple


class Plan(NamedTuple):
    """A file that `check` reads, of the kind of a shared case, with the outcome that is right."""

    case: str
    file: str
    text: str
    steps: tuple[str, ...] = ()
    """The steps of each program, as "Walk fridge; Open fridge"."""
    faults: str = ""
    """Line and code of each fault, as "2 NOT_UNDERSTOOD, 4 AMBIGUOUS"."""
    fuzzy: int = 0
    titles: tuple[str, ...] | None = None
    broken: str = ""
    """The reason why the outcome differs from the expected one today; "" where it does not."""


def lines(*every: str) -> str:
    return "\n".join(every) + "\n"
