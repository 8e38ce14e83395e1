"""Not facing what is to be seen."""

from hearth.repair.handlers.common import Edit, RepairContext, before


def not_facing(context: RepairContext) -> Edit | None:
    """Turn to it first."""
    return before(context, "not_facing", context.does("TurnTo", context.object()))
