"""The nodes of a home that an action's argument may be, as a bit set."""

from collections.abc import Mapping
from functools import reduce
from operator import and_, or_

from hearth.kb.records import Requirement


def allowed(
    needs: Requirement, properties: Mapping[str, int], classes: Mapping[str, int], rooms: int, every: int
) -> int:
    """The nodes that meet a requirement.

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
