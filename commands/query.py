"""`query`: SQL over a published dataset."""

from collections.abc import Sequence
from datetime import date, datetime, time
from decimal import Decimal
from pathlib import Path
from typing import Any

from hearth.commands import output
from hearth.storage.names import numbered


def query(dataset: Path, sql: str, rows: int = 100, as_json: bool = False) -> None:
    """Query a published dataset in SQL.

    Tables: activities, descriptions, programs, steps, homes, home_nodes, home_edges, environments, executions, ticks,
    perturbations, repairs, splits, sketches, frames, videos, clips, demonstration_frames, vocabulary, rejects, ledger.
    Macros: program_text(program_id), graph_nodes(execution_id, tick), graph_edges(execution_id, tick),
    final_state(execution_id). View originals: the executions of original programs, a row each, without those in
    perturbed environments. View execution_kinds: whether an execution is original, perturbed or repaired. View
    start_relations: edges per relation at the start of all executions. The dataset is opened read-only. What `challenge
    build` writes has tasks, demonstrations, episodes, trajectories, posteriors, and the views goal_predicates and
    demonstration_steps.

    \b
    Examples:
      python cli.py query data_out "SELECT action, count(*) FROM steps GROUP BY action ORDER BY 2 DESC"
      python cli.py query data_out "SELECT count(*) AS originals, count(*) FILTER (executable) AS run FROM originals"
      python cli.py query data_out "DESCRIBE programs"
    """
    import sys

    from hearth.challenges.challenge_tables import ChallengeData
    from hearth.datasets.dataset import Dataset

    text = sys.stdin.read() if sql == "-" else sql
    challenge = ChallengeData.found(dataset)
    opened = Dataset.open(dataset, remembers=False) if challenge is None else challenge
    columns, found = opened.rows(text, rows + 1 if rows and not as_json else None)
    if as_json:
        names = _different(columns)
        output.emit([dict(zip(names, map(_json, row), strict=True)) for row in found])
        return
    more = bool(rows) and len(found) > rows
    output.table(columns, ([_cell(cell) for cell in row] for row in (found[:rows] if more else found)))
    if more:
        print(f"... more than {rows:,} rows; --rows 0 prints all")


def _different(columns: Sequence[str]) -> list[str]:
    """Names of columns; of several of one name, the later ones with a number: `a~2`."""
    found: list[str] = []
    for name in columns:
        found.append(numbered(name, {*found, *columns}) if name in found else name)
    return found


def _cell(value: Any) -> Any:
    """Text for a cell: one line, nested values as JSON."""
    if isinstance(value, list | dict):
        import orjson

        return orjson.dumps(_json(value)).decode()
    return value


def _json(value: Any) -> Any:
    """A value of DuckDB's as JSON has it; what JSON has no form for, numbers of more than 64 bits too, as text."""
    if isinstance(value, dict):
        return {str(key): _json(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_json(each) for each in value]
    if isinstance(value, Decimal):
        return float(value)
    plain = value is None or isinstance(value, str | float | datetime | date | time)
    return value if plain or (isinstance(value, int) and abs(value) < 2**63) else str(value)
