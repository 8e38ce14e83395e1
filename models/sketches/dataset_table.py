"""Table 5.1: how many programs, how long, in graphs of how many nodes and edges; the thesis's beside a dataset's."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from hearth.datasets.dataset import Dataset


class DatasetRow(NamedTuple):
    """Programs of one kind.

    Attributes:
        programs: of which.
        of: `thesis` or `ours`.
        number: of programs.
        length: mean number of steps.
        nodes, edges: of the graphs at their start; ours have all relations in the home's graph.
    """

    programs: str
    of: str
    number: int
    length: float | None
    nodes: float | None
    edges: float | None


THESIS = (
    DatasetRow("VirtualHome", "thesis", 2807, 13.26, None, None),
    DatasetRow("Executable", "thesis", 1387, 9.61, 289, 4393),
    DatasetRow("Augmented", "thesis", 27284, 18.58, 290, 4305),
    DatasetRow("VirtualHome-Env", "thesis", 32761, 18.79, 289, 4319),
)

_KINDS = {
    "Original": "p.parent_id IS NULL",
    "Executable": "p.parent_id IS NULL AND e.executable",
    "Augmented": "p.parent_id IS NOT NULL AND e.executable",
    "All executable": "e.executable",
}

SAMPLE = 50
"""Executions of each kind whose graphs are counted: those first in the order of hashes of their ids."""


def dataset_table(dataset: Dataset) -> list[DatasetRow]:
    """The rows of table 5.1."""
    return [*THESIS, *(_row(dataset, name, where) for name, where in _KINDS.items())]


def _row(dataset: Dataset, name: str, where: str) -> DatasetRow:
    joined = f"FROM programs p LEFT JOIN executions e USING (program_id) WHERE {where}"
    ((count, length),) = dataset.rows(
        f"SELECT count(*), avg(n) FROM (SELECT p.program_id, any_value(len(p.steps)) AS n {joined} GROUP BY 1)"
    )[1]
    query = f"SELECT e.execution_id {joined} AND e.execution_id IS NOT NULL ORDER BY md5(e.execution_id) LIMIT {SAMPLE}"
    sizes = _sizes(dataset, [found for (found,) in dataset.rows(query)[1]])
    nodes, edges = (sum(column) / len(sizes) for column in zip(*sizes, strict=True)) if sizes else (None, None)
    return DatasetRow(name, "ours", count, _rounded(length), _rounded(nodes), _rounded(edges))


def _rounded(value: Any) -> float | None:
    return None if value is None else round(float(value), 2)


def _sizes(dataset: Dataset, names: list[str]) -> list[tuple[int, int]]:
    """The numbers of nodes and edges of executions at their start."""
    from hearth.models.data import requests

    found = []
    for share in requests(dataset, names, worlds=True):
        for each in share:
            if each.world is not None:
                graph = each.world.graph()
                found.append((len(graph.nodes), len(graph.edges)))
    return found
