"""`query`: SQL over a published dataset."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from hearth.commands import output
from hearth.commands.time_limits import QUERY_WITHIN
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.terminal import shown_json

if TYPE_CHECKING:
    from hearth.datasets.dataset import Dataset


def query(
    dataset: Path,
    sql: str,
    rows: int = 100,
    csv: bool = False,
    tsv: bool = False,
    parquet: Path | None = None,
    out: Path | None = None,
    as_json: bool = False,
    within: float = QUERY_WITHIN,
) -> None:
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
      hearth query data_out "SELECT action, count(*) FROM steps GROUP BY action ORDER BY 2 DESC"
      hearth query data_out "SELECT count(*) AS originals, count(*) FILTER (executable) AS run FROM originals"
      hearth query data_out "SELECT * FROM originals" --out originals.csv
      hearth query data_out "DESCRIBE programs"
    """
    from hearth.challenges.challenge_dataset import ChallengeData
    from hearth.commands.bounded_process import bounded_memory, ended_within
    from hearth.datasets.dataset import Dataset
    from hearth.storage.duckdb_connections import memory_limit
    from hearth.storage.query_time_limit import checked_seconds

    if (csv and tsv) or (as_json and (csv or tsv)):
        raise typer.BadParameter("only one of --csv, --tsv and --json can be written")
    try:
        checked_seconds(within)
    except HearthError as error:
        output.report(error.diagnostics)
        raise typer.Exit(output.USAGE) from error
    text = _question(sql)
    challenge = ChallengeData.found(dataset)
    opened = Dataset.open(dataset, remembers=False) if challenge is None else challenge
    opened.within = within
    with bounded_memory(memory_limit()), ended_within(within):
        if _write(opened, text, (out, parquet), "," if csv else "\t" if tsv else ""):
            return
        if as_json:
            _document(opened, text)
        else:
            _table(opened, text, rows)


LARGEST_QUESTION = 1 << 20
"""Bytes of a question that comes from the standard input."""


def _question(sql: str) -> str:
    """Return the question in SQL; that of the standard input for `-`.

    Raises:
        HearthError: FILE_TOO_LARGE.
    """
    from hearth.storage.input_files import read_input

    # Bytes that are not text are refused with the question; the message names their place.
    return read_input(Path(sql), LARGEST_QUESTION).decode("utf-8", "surrogateescape") if sql == "-" else sql


def _document(dataset: Dataset, text: str) -> None:
    """Print an answer as JSON; a fault that comes after some rows goes to the standard error, for JSON has begun."""
    from hearth.datasets.query_output import document

    begun = False
    try:
        for piece in document(dataset, text):
            sys.stdout.write(shown_json(piece))
            begun = True
    except HearthError as error:
        if not begun:
            raise
        output.report(error.diagnostics)
        raise typer.Exit(output.BAD_INPUT) from error


def _table(dataset: Dataset, text: str, rows: int) -> None:
    """Print an answer as a table, with a last line where it has more rows than asked for."""
    columns, found = dataset.rows_as_text(text, rows + 1 if rows else None)
    more = bool(rows) and len(found) > rows
    output.table(columns, ([_cell(cell) for cell in row] for row in (found[:rows] if more else found)))
    if more:
        output.line(f"... more than {rows:,} rows; --rows 0 prints all")


def _write(dataset: Dataset, text: str, files: Sequence[Path | None], separator: str) -> bool:
    """Write the answer as it was asked for, if it was: into files, or as separated lines to the terminal."""
    from hearth.datasets.query_output import write_answer, write_separated

    out, parquet = files
    for file, form in ((parquet, ".parquet"), (out, {"": "", ",": ".csv", "\t": ".tsv"}[separator])):
        if file is not None:
            number = write_answer(dataset, text, file, form)
            output.note(f"{output.counted(number, 'row')} in {file}")
    if separator and out is None:
        write_separated(dataset, text, sys.stdout, separator)
    return bool(separator) or any(files)


def _cell(value: Any) -> Any:
    """Text for a cell: one line, nested values as JSON; whole numbers as they are, for many are ids."""
    from hearth.datasets.query_output import line_of

    return str(value) if isinstance(value, int) and not isinstance(value, bool) else line_of(value)
