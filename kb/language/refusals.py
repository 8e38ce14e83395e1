"""Refusals: why a line can be no step, where words alone do not say it."""

from typing import NamedTuple


class Refusal(NamedTuple):
    """The reason for which a line, and with it its plan, is refused, and the remedy.

    Attributes:
        message: the reason.
        remedy: how to write it.
        is_warning: whether the line is read all the same.
    """

    message: str
    remedy: str
    is_warning: bool = False
