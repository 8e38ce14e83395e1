"""Not facing what is to be seen."""

from __future__ import annotations

from hearth.repair.handlers.common import Edit, Trouble, before


def not_facing(trouble: Trouble) -> Edit | None:
    """Turn to it first."""
    return before(trouble, "not_facing", trouble.does("TurnTo", trouble.object()))
