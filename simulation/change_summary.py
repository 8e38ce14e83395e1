"""A change of the world in words."""

from collections import Counter

from hearth.schemas.graph_change import Change
from hearth.simulation.world.world import World


def summary(change: Change, world: World) -> str:
    """Return the changes on one line: states, places, and the numbers of the rest; `world` is the earlier one."""

    def name(node: int) -> str:
        return f"{world.home.classes[world.home.index[node]]} ({node})"

    parts = [f"{name(node)} is {state}" for node, state in change.set_states]
    loud = [edge for edge in change.added if edge.relation not in ("CLOSE", "FACING")]
    parts += [f"{name(e.source)} {e.relation} {name(e.target)}" for e in loud]
    quiet = Counter(edge.relation for edge in change.added if edge not in loud)
    parts += [f"{count} more {relation}" for relation, count in quiet.items()]
    if change.removed:
        number = len(change.removed)
        parts.append(f"{number:,} edge{'s' * (number != 1)} removed")
    return "; ".join(parts) or "no change"
