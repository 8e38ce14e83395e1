"""Taking off what is not worn."""

from __future__ import annotations

from hearth.repair.handlers.common import Edit, RepairContext, removed


def not_worn(context: RepairContext) -> Edit | None:
    """Leave the PutOff out."""
    return removed(context, "not_worn")
