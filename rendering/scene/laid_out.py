"""Homes as pictures need them: with geometry, which is made for a graph that has none."""

from __future__ import annotations

from typing import NamedTuple

from hearth.homes.from_graph.graph_layout import lay_out
from hearth.homes.from_graph.measured import has_geometry
from hearth.kb.knowledge import Knowledge
from hearth.schemas.graph import EnvironmentGraph


class Laid(NamedTuple):
    """A home that can be pictured.

    Attributes:
        graph: with boxes; its nodes have the ids they had.
        made: whether it had no geometry, and was given some.
        unmet: how many of its relations the geometry that was made does not show.
    """

    graph: EnvironmentGraph
    made: bool = False
    unmet: int = 0

    def note(self, home: str) -> str:
        """What to tell whoever looks at the pictures; nothing where the geometry is the home's own."""
        if not self.made:
            return ""
        few = f"{self.unmet} of its {len(self.graph.edges)} relations do not show"
        return f"{home} has no geometry: rooms and furniture were laid out by its relations; {few}."


def laid(graph: EnvironmentGraph, name: str, knowledge: Knowledge) -> Laid:
    """A home's graph as it is if it has geometry, else laid out: the same graph always in the same way.

    Raises:
        HearthError: NO_ROOM: it has no room.
    """
    if has_geometry(graph):
        return Laid(graph)
    found = lay_out(graph, name, knowledge)
    return Laid(found.graph, True, len(found.unmet))
