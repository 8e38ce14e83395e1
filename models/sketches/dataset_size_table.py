"""Table 5.1: numbers and lengths of programs, nodes and edges of graphs; the thesis's figures and a dataset's."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from hearth.datasets.graph_sizes import graph_sizes

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

_KINDS = {"Executable": "executable", "Augmented": "augmented", "All executable": "all"}


def dataset_table(dataset: Dataset) -> list[DatasetRow]:
    """Return the rows of table 5.1; `hearth augmented` prints the same numbers."""
    query = "SELECT count(*), round(avg(len(steps)), 2) FROM programs WHERE parent_id IS NULL"
    ((count, length),) = dataset.rows(query)[1]
    original = DatasetRow("Original", "ours", count, length, None, None)
    return [
        *THESIS,
        original,
        *(DatasetRow(name, "ours", *graph_sizes(dataset, kind)) for name, kind in _KINDS.items()),
    ]
