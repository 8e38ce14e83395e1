"""The graphs of an execution, one per tick, at a cost proportional to the changes."""

from collections.abc import Iterator

from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.schemas.graph_change import WorkingGraph
from hearth.simulation.engine import Execution

SHOWN = frozenset({"ON", "INSIDE", "HOLDS_RH", "HOLDS_LH"})
"""Relations that decide positions of things."""


def graphs(execution: Execution) -> Iterator[EnvironmentGraph]:
    """Yield the graph at the start and after each tick, with the relations of `SHOWN`."""
    start = execution.worlds[0].graph()
    graph = WorkingGraph(start.nodes, filter(_shown, start.edges))
    yield graph.graph()
    for change in execution.changes():
        yield graph.apply(change.where(_shown)).graph()


def _shown(edge: Edge) -> bool:
    return edge.relation in SHOWN
