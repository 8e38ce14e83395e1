"""The nodes of a home that an action's argument may be, as a bit set."""

from collections.abc import Mapping
from functools import reduce
from operator import and_, or_

from hearth.kb.formula import And, Formula, Not, Or
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Requirement
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.literals import Literal


def allowed(
    needs: Requirement, properties: Mapping[str, int], classes: Mapping[str, int], rooms: int, every: int
) -> int:
    """Return the nodes that meet a requirement.

    Args:
        needs: what is asked of the argument.
        properties: nodes by property.
        classes: nodes by class name.
        rooms: the rooms.
        every: all nodes.
    """
    if needs.anything:
        found = every
    else:
        found = reduce(or_, (properties.get(name, 0) for name in needs.any_of), 0)
        if needs.all_of:
            found |= reduce(and_, (properties.get(name, 0) for name in needs.all_of))
        found |= reduce(or_, (classes.get(name, 0) for name in needs.classes), 0)
        for part in needs.contains:
            found |= reduce(or_, (mask for name, mask in classes.items() if part in name), 0)
    found &= ~reduce(or_, (classes.get(name, 0) for name in needs.never), 0)
    if needs.no_rooms:
        found &= ~rooms
    return found | reduce(or_, (classes.get(name, 0) for name in needs.also), 0)


def of_kind(formula: Formula, properties: Mapping[str, int], classes: Mapping[str, int], every: int) -> int:
    """Return the nodes for which a formula of one variable holds that is about classes and properties alone.

    Args:
        formula: such as the definition of `bedding(x)`.
        properties, classes, every: as in `allowed`.

    Raises:
        HearthError: BAD_TABLE, when it is about something else.
    """
    if isinstance(formula, And | Or):
        parts = (of_kind(part, properties, classes, every) for part in formula.parts)
        return reduce(and_, parts, every) if isinstance(formula, And) else reduce(or_, parts, 0)
    if isinstance(formula, Not):
        return every & ~of_kind(formula.part, properties, classes, every)
    if not isinstance(formula, Literal) or formula.name not in ("class", "class_contains", "property"):
        suggestion = "write class(x, name), class_contains(x, part) or property(x, NAME)"
        raise HearthError.of(Code.BAD_TABLE, f"`{formula}` is not about a class or property", suggestion=suggestion)
    word = formula.terms[1].name
    if formula.name == "class_contains":
        found = reduce(or_, (mask for name, mask in classes.items() if word in name), 0)
    else:
        found = (classes if formula.name == "class" else properties).get(word, 0)
    return every & ~found if formula.negated else every & found


def is_of_kind(name: str, kind: str, knowledge: Knowledge) -> bool:
    """Return whether things of a class are of a kind of derived.yaml, such as `bedding` (see `of_kind`)."""
    thing = knowledge.object_class(name)
    properties = dict.fromkeys(thing.properties if thing else (), 1)
    return bool(of_kind(knowledge.derived[kind][1], properties, {name: 1}, 1))
