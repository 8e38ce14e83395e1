"""Several characters in each other's way."""

from __future__ import annotations

from dataclasses import replace

from hearth.repair.handlers.common import Edit, Splice, Trouble, before
from hearth.schemas.program import Step


def held_by_other(trouble: Trouble) -> Edit | None:
    """Let who holds it put it down first."""
    holder = next((n for n, agent in enumerate(trouble.world.agents) if agent.index == trouble.index(1)), None)
    if holder is None:
        return None
    return before(trouble, "held_by_other", Step("Release", (trouble.object(),), holder))


def conflict(trouble: Trouble) -> Edit | None:
    """Do one after the other what can't be done in one tick."""
    if not trouble.step.joins:
        following = trouble.at + 1
        if following >= len(trouble.program.steps) or not trouble.program.steps[following].joins:
            return None
        return Edit("conflict", (Splice(following, 1, (replace(trouble.program.steps[following], joins=False),)),))
    return Edit("conflict", (Splice(trouble.at, 1, (replace(trouble.step, joins=False),)),))
