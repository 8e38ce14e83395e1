"""Executions read from a dataset by id, with their programs and environments."""

from collections.abc import Iterator, Sequence
from typing import Any, TypedDict

from hearth.datasets.damage_faults import using
from hearth.datasets.dataset import Dataset
from hearth.schemas.row_types import BindingRow, DifferenceRow, StepRow


class StoredCaseRow(TypedDict):
    """The columns of an execution that running its program needs."""

    execution_id: str
    environment_id: str
    program_id: str
    home: str
    rules: str
    bindings: list[BindingRow]
    activity_id: str
    title: str
    description: str
    steps: list[StepRow]
    environment: DifferenceRow


_RUNS = """SELECT execution_id, environment_id, program_id, home, rules, bindings{more} FROM {{table}}
    SEMI JOIN (SELECT unnest($ids) AS execution_id) USING (execution_id) WHERE execution_id BETWEEN $low AND $high"""

_ENVIRONMENTS = """SELECT environment_id, added_nodes, removed_nodes, added, removed, set_states, cleared_states
    FROM {table} SEMI JOIN (SELECT unnest($ids) AS environment_id) USING (environment_id)
    WHERE environment_id BETWEEN $low AND $high"""

_PROGRAMS = """SELECT program_id, activity_id, title, description, steps FROM {table}
    SEMI JOIN (SELECT unnest($ids) AS program_id) USING (program_id) WHERE program_id BETWEEN $low AND $high"""


def stored_cases(dataset: Dataset, names: Sequence[str], more: Sequence[str] = ()) -> Iterator[Any]:
    """Yield executions with the columns that running their programs needs, in the order of their names.

    Three queries, each within its range of ids and over the files that have it: for a join, DuckDB would read whole
    tables, and of many files each query would open all. Its rows come in an order that another run may not have: models
    that learn from them would have other weights.

    Args:
        dataset: the dataset.
        names: ids of executions, each once; neighbours in the dataset are read fastest, unknown ones are left out.
        more: further columns of `executions`.

    Returns:
        Rows as `StoredCaseRow`, with the further columns.

    Raises:
        HearthError: DAMAGED_FILE: an execution is of a program or in an environment that there is not.
    """

    def asked(table: str, query: str, ids: Sequence[str]) -> list[Any]:
        return dataset.read(query, {"ids": list(ids), "low": min(ids), "high": max(ids)}, table) if ids else []

    runs = asked("executions", _RUNS.format(more="".join(f", {column}" for column in more)), names)
    environments, programs = (
        {row[key]: row for row in asked(table, query, sorted({run[key] for run in runs}))}
        for table, query, key in (
            ("environments", _ENVIRONMENTS, "environment_id"),
            ("programs", _PROGRAMS, "program_id"),
        )
    )
    found = {run["execution_id"]: run for run in runs}
    for run in (found[name] for name in names if name in found):
        with using(dataset.folder):  # it may name a program or an environment that there is not
            case = {**run, **programs[run["program_id"]], "environment": environments[run["environment_id"]]}
        yield case
