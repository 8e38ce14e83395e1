"""The number and length of a dataset's programs, and the size of the graphs in which they run (table 5.1)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from hearth.datasets.dataset import Dataset

KINDS = {
    "executable": "e.executable AND p.parent_id IS NULL",
    "augmented": "e.executable AND p.parent_id IS NOT NULL",
    "all": "e.executable",
}
"""Kinds of executions, and how SQL says them of an execution `e` of a program `p`."""


class GraphSizes(NamedTuple):
    """Programs of one kind, and means over all their executions; None without any.

    Attributes:
        programs: that have an execution of the kind.
        length: steps of a program.
        nodes, edges: of the graph at the start, with all relations that the home's graph has.
    """

    programs: int
    length: float | None
    nodes: float | None
    edges: float | None


def graph_sizes(dataset: Dataset, kind: str) -> GraphSizes:
    """Return the numbers of one of `KINDS`; a graph is a home's, with the changes of its environment."""
    query = f"""
        SELECT count(DISTINCT p.program_id), avg(len(p.steps)),
               avg(h.nodes + len(v.added_nodes) - len(v.removed_nodes)),
               avg(h.edges + len(v.added) - len(v.removed))
        FROM programs p JOIN executions e USING (program_id) JOIN environments v USING (environment_id)
             JOIN homes h ON h.home = e.home
        WHERE {KINDS[kind]}"""
    ((programs, *means),) = dataset.rows(query)[1]
    return GraphSizes(programs, *(None if value is None else round(float(value), 2) for value in means))
