"""`report`: a dataset as static HTML."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from hearth.commands import output

Folder = Annotated[Path, typer.Argument(metavar="DATASET", help="A build's folder, or the dataset inside it.")]
Out = Annotated[Path, typer.Option("--out", "-o", metavar="DIR", help="A new folder, or an earlier report.")]

Workers = Annotated[int, typer.Option("--workers", "-j", metavar="N", min=0, help="Processes; 0: one a core.")]

_OUT = Path("report_out")


def report(dataset: Folder, out: Out = _OUT, workers: Workers = 0, as_json: output.Json = False) -> None:
    """Write a dataset as one folder of static HTML: open its index.html, no network or server is needed.

    Where records went, statistics with the queries that make them, homes as floor plans, and every program with its
    steps, preconditions, repairs, graphs before and after, and pictures.

    \b
    Example:
      python cli.py report data_out --out report_out
    """
    import os

    from hearth.commands.waiting import bar
    from hearth.pipelines.dataset import Dataset
    from hearth.report.write import write_report

    with bar("shares of programs told") as seen:
        programs = write_report(Dataset.open(dataset), out, workers or os.cpu_count() or 1, seen)
    if as_json:
        output.emit({"out": str(out), "programs": programs})
    else:
        print(f"{output.counted(programs, 'program')}; open {out / 'index.html'}")
