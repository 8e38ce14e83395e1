"""Refusals: why a line can be no step, where words alone do not say it."""

from typing import NamedTuple


class Refusal(NamedTuple):
    """The reason for which a line, and with it its plan, is refused, and the remedy."""

    message: str
    remedy: str
