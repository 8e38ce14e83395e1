"""The derived predicates that the actions of a set ask for."""

from hearth.kb.formula import Formula, Term, predicates
from hearth.kb.knowledge import Knowledge
from hearth.schemas.literals import Literal


def derived_used(knowledge: Knowledge) -> dict[str, tuple[Literal[Term], Formula]]:
    """Return the definitions that checks and effects of executed actions ask for, in the order of the file.

    Those of set 3 alone are left out of the documents and the domains of set 2.
    """
    actions = [action for action in knowledge.actions.values() if action.executed]
    waiting = [check.formula for action in actions for check in action.preconditions]
    waiting += [effect.condition for action in actions for effect in action.effects]
    used: set[str] = set()
    while waiting:
        new = predicates(waiting.pop()) & knowledge.derived.keys() - used
        used |= new
        waiting += [knowledge.derived[name][1] for name in new]
    return {name: found for name, found in knowledge.derived.items() if name in used}
