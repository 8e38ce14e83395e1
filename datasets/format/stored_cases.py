"""Executions read back from a dataset by their ids, with the programs and environments that they are of."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, TypedDict

from hearth.datasets.dataset import Dataset
from hearth.schemas.structs import BindingRow, DifferenceRow, StepRow


class StoredCaseRow(TypedDict):
    """An execution as far as running its program needs it."""

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


_RUNS = """SELECT execution_id, environment_id, program_id, home, rules, bindings{more} FROM executions
    SEMI JOIN (SELECT unnest($ids) AS execution_id) USING (execution_id) WHERE execution_id BETWEEN $low AND $high"""

_ENVIRONMENTS = """SELECT environment_id, added_nodes, removed_nodes, added, removed, set_states, cleared_states
    FROM environments SEMI JOIN (SELECT unnest($ids) AS environment_id) USING (environment_id)
    WHERE environment_id BETWEEN $low AND $high"""

_PROGRAMS = """SELECT program_id, activity_id, title, description, steps FROM programs
    SEMI JOIN (SELECT unnest($ids) AS program_id) USING (program_id) WHERE program_id BETWEEN $low AND $high"""


def stored_cases(dataset: Dataset, names: Sequence[str], more: Sequence[str] = ()) -> Iterator[Any]:
    """Executions as far as running their programs needs it, in the dataset's order.

    Three questions, each within its own range of ids: of a join, DuckDB would read whole tables, share after share.

    Args:
        dataset: where they are.
        names: their ids; neighbours in the dataset are read fastest.
        more: columns of `executions` that are wanted too.

    Returns:
        rows as `StoredCaseRow`, with those columns.
    """

    def asked(query: str, ids: Sequence[str]) -> list[Any]:
        bounds = {"ids": list(ids), "low": min(ids), "high": max(ids)}
        return dataset.read(query, bounds)

    runs = asked(_RUNS.format(more="".join(f", {column}" for column in more)), names)
    environments, programs = (
        {row[key]: row for row in asked(query, sorted({run[key] for run in runs}))}
        for query, key in ((_ENVIRONMENTS, "environment_id"), (_PROGRAMS, "program_id"))
    )
    for run in runs:
        yield {**run, **programs[run["program_id"]], "environment": environments[run["environment_id"]]}
