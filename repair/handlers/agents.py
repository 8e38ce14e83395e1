"""Several characters in each other's way."""

from dataclasses import replace

from hearth.repair.handlers.common import Edit, RepairContext, Splice, before
from hearth.schemas.program import Step


def held_by_other(context: RepairContext) -> Edit | None:
    """Let who holds it put it down first."""
    holder = next((n for n, agent in enumerate(context.world.agents) if agent.index == context.index(1)), None)
    if holder is None:
        return None
    return before(context, "held_by_other", Step("Release", (context.object(),), holder))


def conflict(context: RepairContext) -> Edit | None:
    """Do one after the other what can't be done in one tick."""
    if not context.step.joins:
        following = context.at + 1
        if following >= len(context.program.steps) or not context.program.steps[following].joins:
            return None
        return Edit("conflict", (Splice(following, 1, (replace(context.program.steps[following], joins=False),)),))
    return Edit("conflict", (Splice(context.at, 1, (replace(context.step, joins=False),)),))
