"""Actions that a goal forbids, as in `not [Open](fridge)` and `never [Open](fridge)`; an obedient agent omits them."""

from __future__ import annotations

from dataclasses import replace

from hearth.schemas.goals import Goal
from hearth.simulation.actions.legal import Legal
from hearth.simulation.literal_truth import nodes
from hearth.simulation.world.home import Home


def forbidden(goal: Goal, home: Home) -> dict[str, int]:
    """Return the actions that a goal forbids: action -> the nodes that must not be its first object.

    Only parts of the form `not [Action](thing)` and `never [Action](thing)` are read.
    """
    found: dict[str, int] = {}
    for part in goal.parts:
        if part.join not in ("not", "never") or part.goals[0].parts:
            continue
        match part.goals[0].counts:
            case ((literal, 1),) if literal.name in home.knowledge.actions and len(literal.terms) == 1:
                found[literal.name] = found.get(literal.name, 0) | nodes(literal.terms[0], home)
    return found


def allowed(legal: Legal, never: dict[str, int]) -> Legal:
    """Return the legal instructions without the forbidden ones."""
    masks = dict(legal.masks)
    for name, things in never.items():
        if masks.get(name):
            first, *rest = masks.pop(name)
            if first & ~things:
                masks[name] = (first & ~things, *rest)
    return replace(legal, masks=masks)
