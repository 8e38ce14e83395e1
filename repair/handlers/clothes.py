"""Taking off what is not worn."""

from __future__ import annotations

from hearth.repair.handlers.common import Edit, Trouble, removed


def not_worn(trouble: Trouble) -> Edit | None:
    """Leave the PutOff out."""
    return removed(trouble, "not_worn")
