"""Homes with geometry for drawing; a layout is made for a graph that has none."""

from typing import NamedTuple

from hearth.homes.from_graph.graph_layout import lay_out
from hearth.homes.from_graph.layout_from_boxes import has_geometry
from hearth.kb.knowledge import Knowledge
from hearth.schemas.graph import EnvironmentGraph


class DrawableHome(NamedTuple):
    """A home that can be drawn.

    Attributes:
        graph: with boxes; ids of nodes are unchanged.
        made: whether a layout was made, because the home had no geometry.
        unmet: number of relations that the layout violates.
    """

    graph: EnvironmentGraph
    made: bool = False
    unmet: int = 0

    def note(self, home: str) -> str:
        """Return a note for the user about a layout that was made; empty for a home with geometry."""
        if not self.made:
            return ""
        few = f"{self.unmet} of its {len(self.graph.edges)} relations do not show"
        return f"{home} has no geometry: rooms and furniture were laid out by its relations; {few}."


def with_geometry(graph: EnvironmentGraph, name: str, knowledge: Knowledge) -> DrawableHome:
    """Return a home's graph, with a deterministic layout if it has no geometry.

    Raises:
        HearthError: NO_ROOM: it has no room.
    """
    if has_geometry(graph):
        return DrawableHome(graph)
    found = lay_out(graph, name, knowledge)
    return DrawableHome(found.graph, True, len(found.unmet))
