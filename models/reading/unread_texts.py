"""Refusals: why a text has no program, with the part of it that was understood."""

from __future__ import annotations

from hearth.models.reading.instruction_reading import Reading
from hearth.schemas.failures import Code, Failure

_SHOWN = 60


def refusal(reading: Reading, *, is_long: bool) -> Failure | None:
    """Return why a reading gives no program; None where it does.

    Args:
        reading: of a text.
        is_long: whether the text is a description, of which a part may be left out.
    """
    if not reading.acts:
        if reading.missing:
            return Failure(Code.UNBOUND, names=reading.missing[:1], expected=f"{reading.missing[0]} in the home",
                           actual="none")  # fmt: skip
        part = reading.unread[0] if reading.unread else ""
        actual = f"`{part[:_SHOWN]}`" if part else "none"
        return Failure(Code.NOT_UNDERSTOOD, expected="something to do in a home", actual=actual)
    if reading.unread and not is_long:
        part = reading.unread[0]
        if reading.missing:
            return Failure(Code.UNBOUND, names=reading.missing[:1], expected=f"{reading.missing[0]} in the home",
                           actual=f"none, for `{part[:_SHOWN]}`")  # fmt: skip
        return Failure(Code.NOT_UNDERSTOOD, expected="something to do in a home", actual=f"`{part[:_SHOWN]}`")
    return None
